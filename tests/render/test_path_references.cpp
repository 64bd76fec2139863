// The path tracer against another renderer's unbiased pictures of real volumes, order by order. Both come as two
// independent halves, a and b here, A and B there, so that every difference can be distinguished from noise.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "reference_shot.h"

namespace brisance::test_path_references {
namespace {

// Camera rays per pixel: as many as make our noise smaller than the references', so that more would say no more.
constexpr int kSamples = 64, kSamplesOfEmber = 32;

using Pixels = std::vector<double>;

// Radiance of the first so many of V, MV, MM.
Pixels radiance(const Image& image, int cells) {
    const char* const names[] = {"V", "MV", "MM"};
    Pixels sum(std::size_t(image.width) * image.height);
    for (int k = 0; k < cells; ++k) {
        const Layer& layer = image.layer(names[k]);
        for (std::size_t p = 0; p < sum.size(); ++p)
            sum[p] += layer.pixels[p * layer.channels.size()];
    }
    return sum;
}

Pixels read_reference(const std::string& file) {
    const std::vector<float> y = testing::read_luminance(file);
    return Pixels(y.begin(), y.end());
}

// A sum over pixels that should be zero, and its standard error: pixels are independent.
struct Balance {
    double sum = 0.0, square = 0.0;
    void add(double v) {
        sum += v;
        square += v * v;
    }
    double error() const { return std::sqrt(square); }
};

struct Comparison {
    double mean = 0.0, mean_error = 0.0;  // of the picture over the reference, less one; of our noise alone
    Balance bias;                         // sum (a - A)(b - B): the squared difference of what both tend to
    Balance noise;                        // sum (m - R)^2, less what the halves predict
    double predicted = 0.0, norm = 0.0;   // that prediction; sum of A B
};

Comparison compare(const Pixels& a, const Pixels& b, const Pixels& ref_a, const Pixels& ref_b) {
    Comparison out;
    double sum = 0.0, ref_sum = 0.0, variance = 0.0;
    for (std::size_t p = 0; p < a.size(); ++p) {
        const double m = 0.5 * (a[p] + b[p]), r = 0.5 * (ref_a[p] + ref_b[p]);
        const double own = 0.25 * std::pow(a[p] - b[p], 2), theirs = 0.25 * std::pow(ref_a[p] - ref_b[p], 2);
        sum += m;
        ref_sum += r;
        variance += own;
        out.bias.add((a[p] - ref_a[p]) * (b[p] - ref_b[p]));
        out.noise.add(std::pow(m - r, 2) - own - theirs);
        out.predicted += own + theirs;
        out.norm += ref_a[p] * ref_b[p];
    }
    out.mean = sum / ref_sum - 1.0;
    out.mean_error = std::sqrt(variance) / ref_sum;
    return out;
}

void expect_same(const Comparison& c, const std::string& what) {
    // The references' means are known to 0.1 %; three standard errors of both, and 0.3 % at most.
    EXPECT_LT(std::abs(c.mean), 3.0 * std::hypot(c.mean_error, 1e-3)) << what;
    EXPECT_LT(std::abs(c.mean), 3e-3) << what;
    // What both tend to differs by no more than noise explains, four standard errors, and pixels spread as their halves
    // say: a chi-square test whose scale is measured, not assumed.
    EXPECT_LT(c.bias.sum, 4.0 * c.bias.error()) << what;
    EXPECT_LT(std::abs(c.noise.sum), 4.0 * c.noise.error()) << what;
    std::printf(
        "%s: mean %+.3f %% +- %.3f %%, bias %+.2f and noise %+.2f standard errors; (m - R)^2 is %.3f of "
        "predicted, bias below %.2f %%\n",
        what.c_str(), 100.0 * c.mean, 100.0 * c.mean_error, c.bias.sum / c.bias.error(), c.noise.sum / c.noise.error(),
        1.0 + c.noise.sum / c.predicted,
        100.0 * std::sqrt((std::max(c.bias.sum, 0.0) + 2.0 * c.bias.error()) / c.norm));
}

// The same with surfaces. Its paths are noisier: fewer of them, and a mean known to 0.5 %.
TEST(SurfacePathReferences, FloorAndWallAroundTheExplosion) {
    const char* data = std::getenv("BRISANCE_DATA");
    if (!data)
        GTEST_SKIP() << "BRISANCE_DATA is not set: no reference images";
    testing::ReferenceShot reference = testing::reference_shot(data, "ember_floor");
    reference.shot.method = RenderMethod::Path;
    reference.shot.tracing.samples = 32;
    Progress silent;
    const std::vector<Image> halves = render_frame(reference.shot, reference.volume, 0, silent).halves;
    ASSERT_EQ(halves.size(), 2u);
    const auto whole = [](const Image& image) {
        Pixels sum(std::size_t(image.width) * image.height);
        for (std::size_t p = 0; p < sum.size(); ++p)
            sum[p] = image.layer("").pixels[4 * p];
        return sum;
    };
    const Comparison c = compare(whole(halves[0]), whole(halves[1]), read_reference(reference.pictures + ".all.A.exr"),
                                 read_reference(reference.pictures + ".all.B.exr"));
    std::printf("ember_floor: mean %+.3f %% +- %.3f %%, bias %+.2f standard errors\n", 100.0 * c.mean,
                100.0 * c.mean_error, c.bias.sum / c.bias.error());
    EXPECT_LT(std::abs(c.mean), 3.0 * std::hypot(c.mean_error, 1e-3));
    EXPECT_LT(std::abs(c.mean), 5e-3);
    EXPECT_LT(c.bias.sum, 4.0 * c.bias.error());
}

class PathReferences : public ::testing::TestWithParam<const char*> {};

TEST_P(PathReferences, AreWhatThePathTracerTendsTo) {
    const char* data = std::getenv("BRISANCE_DATA");
    if (!data)
        GTEST_SKIP() << "BRISANCE_DATA is not set: no reference images";
    testing::ReferenceShot reference = testing::reference_shot(data, GetParam());
    reference.shot.method = RenderMethod::Path;
    reference.shot.tracing.samples = GetParam() == std::string("ember") ? kSamplesOfEmber : kSamples;
    Progress silent;
    const std::vector<Image> halves = render_frame(reference.shot, reference.volume, 0, silent).halves;
    ASSERT_EQ(halves.size(), 2u);
    const char* const orders[] = {"V", "V+MV", "all"};
    for (int k = 0; k < 3; ++k) {
        const std::string file = reference.pictures + "." + orders[k];
        expect_same(compare(radiance(halves[0], k + 1), radiance(halves[1], k + 1), read_reference(file + ".A.exr"),
                            read_reference(file + ".B.exr")),
                    GetParam() + std::string(" ") + orders[k]);
    }
}

INSTANTIATE_TEST_SUITE_P(OfAnotherRenderer, PathReferences, ::testing::Values("ember", "ember_core", "fireball"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace brisance::test_path_references
