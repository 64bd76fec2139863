// Pictures of real volumes against another renderer's unbiased ones. Each reference comes as two independent halves A
// and B: sum (m - A)(m - B) / sum A B estimates the squared relative error of m free of the references' own noise.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "reference_shot.h"

namespace brisance::test_references {
namespace {

constexpr float kFineShadows = 0.01f;  // lighting.error: half the default

struct Difference {
    double error, mean;  // relative
};

Difference difference(const Image& image, const std::vector<std::string>& cells, const std::string& reference) {
    const std::vector<float> a = testing::read_luminance(reference + ".A.exr"),
                             b = testing::read_luminance(reference + ".B.exr");
    double square = 0.0, norm = 0.0, sum = 0.0, reference_sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        double m = 0.0;
        for (const std::string& cell : cells)
            m += image.layer(cell).pixels[3 * i];
        square += (m - a[i]) * (m - b[i]);
        norm += double(a[i]) * b[i];
        sum += m;
        reference_sum += 0.5 * (a[i] + b[i]);
    }
    return {std::sqrt(std::max(square, 0.0) / norm), sum / reference_sum - 1.0};
}

void print(const std::string& what, const Difference& d) {
    std::printf("%s: error %.3f %%, mean %+.3f %%\n", what.c_str(), 100.0 * d.error, 100.0 * d.mean);
}

// The fire lights a floor and a wall, they light the smoke, and each other: all cells but those of lamps.
TEST(SurfaceReferences, FloorAndWallAroundTheExplosion) {
    const char* data = std::getenv("BRISANCE_DATA");
    if (!data)
        GTEST_SKIP() << "BRISANCE_DATA is not set: no reference images";
    testing::ReferenceShot reference = testing::reference_shot(data, "ember_floor");
    reference.shot.camera.samples_per_axis = 2;
    const auto measured = [&](const char* what) {
        Progress silent;
        const Image image = render_frame(reference.shot, reference.volume, 0, silent).image;
        const Difference d = difference(image, {"V", "MV", "MM", "MS", "SV", "SM", "SS"}, reference.pictures + ".all");
        print(what, d);
        return d;
    };
    // The mean of a corrected picture has the noise of its samples.
    const Difference corrected = measured("ember_floor all, corrected");
    EXPECT_LT(corrected.error, 0.02);
    EXPECT_LT(std::abs(corrected.mean), 0.01);
    reference.shot.correction.samples = 0;
    const Difference by_lights = measured("ember_floor all");
    EXPECT_LT(by_lights.error, 0.03);
    EXPECT_LT(std::abs(by_lights.mean), 0.005);
}

class References : public ::testing::TestWithParam<const char*> {};

// Bounds are about a fifth above what was measured.
TEST_P(References, AreMetWithFineShadows) {
    const char* data = std::getenv("BRISANCE_DATA");
    if (!data)
        GTEST_SKIP() << "BRISANCE_DATA is not set: no reference images";
    testing::ReferenceShot reference = testing::reference_shot(data, GetParam());
    reference.shot.lighting.error = kFineShadows;
    reference.shot.correction.samples = 0;
    Progress silent;
    const Image image = render_frame(reference.shot, reference.volume, 0, silent).image;
    const auto expect = [&](const std::vector<std::string>& cells, const std::string& order, double error,
                            double mean) {
        const Difference d = difference(image, cells, reference.pictures + "." + order);
        EXPECT_LT(d.error, error) << order;
        EXPECT_LT(std::abs(d.mean), mean) << order;
        RecordProperty(order + "_error_percent", std::to_string(100.0 * d.error));
        RecordProperty(order + "_mean_percent", std::to_string(100.0 * d.mean));
        std::printf("%s %s: error %.3f %%, mean %+.3f %%\n", GetParam(), order.c_str(), 100.0 * d.error,
                    100.0 * d.mean);
    };
    expect({"V"}, "V", 0.010, 0.003);
    expect({"V", "MV"}, "V+MV", 0.009, 0.008);
    expect({"V", "MV", "MM"}, "all", 0.020, 0.006);
}

struct ReferenceBounds {
    const char* name;
    double error, mean;  // relative, about a fifth above what was measured
};

class InterpolatedReferences : public ::testing::TestWithParam<ReferenceBounds> {};

// Interpolation has an eighth of the error at most, beside the 2 % by shadows and what the hierarchy has of its own.
TEST_P(InterpolatedReferences, AreMetWithInterpolation) {
    const char* data = std::getenv("BRISANCE_DATA");
    if (!data)
        GTEST_SKIP() << "BRISANCE_DATA is not set: no reference images";
    testing::ReferenceShot reference = testing::reference_shot(data, GetParam().name);
    reference.shot.lighting.interpolation = -1.0f;  // auto
    Progress silent;
    const Image image = render_frame(reference.shot, reference.volume, 0, silent).image;
    const Difference d = difference(image, {"V", "MV", "MM"}, reference.pictures + ".all");
    print(GetParam().name, d);
    EXPECT_LT(d.error, GetParam().error);
    EXPECT_LT(std::abs(d.mean), GetParam().mean);
}

INSTANTIATE_TEST_SUITE_P(OfAnotherRenderer, InterpolatedReferences,
                         ::testing::Values(ReferenceBounds{"ember", 0.010, 0.005},
                                           ReferenceBounds{"ember_core", 0.035, 0.0155},
                                           ReferenceBounds{"fireball", 0.025, 0.01}),
                         [](const auto& info) { return std::string(info.param.name); });
INSTANTIATE_TEST_SUITE_P(OfAnotherRenderer, References, ::testing::Values("ember", "ember_core", "fireball"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace brisance::test_references
