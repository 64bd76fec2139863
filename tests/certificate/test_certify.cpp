// Certificates: their intervals hold the true errors as often as they state, for good pictures and bad ones.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "certificate/certify.h"
#include "core/parallel.h"
#include "fixtures/media.h"
#include "forecast/plan.h"
#include "reference/trace_picture.h"
#include "render/render_frame.h"

namespace brisance {
namespace {

constexpr int kSize = 24;
constexpr std::size_t kPixels = std::size_t(kSize) * kSize;
const std::vector<std::string> kCells = {"", "V", "MV", "MM"};

// Uneven smoke that burns in its middle, 24 nodes across.
Medium burning_ball() {
    testing::Recipe r;
    r.box = testing::cube(-12, 11);
    r.world_from_index = testing::cubic(0.1);
    r.density = [](const ivec3& n) { return testing::ball(n, dvec3(-0.5), 11.0) * (0.3f + testing::noise(n >> 1, 1)); };
    r.flame = [](const ivec3& n) { return testing::ball(n, dvec3(1.0, -1.0, 2.0), 7.0) * testing::noise(n, 2); };
    r.settings = testing::black_smoke();
    r.settings.smoke.extinction_per_metre = 2.0f;
    r.settings.smoke.albedo = Rgb(0.65f, 0.6f, 0.5f);
    r.settings.smoke.mean_cosine = 0.3f;
    r.settings.fire.colour = Rgb(1.0f, 0.5f, 0.2f);
    return testing::make_medium(r);
}

Shot shot_of_ball() {
    Shot shot;
    shot.method = RenderMethod::Path;
    shot.camera_given = true;
    shot.camera.eye = {0.5, -4.0, 1.0};
    shot.camera.width = shot.camera.height = kSize;
    shot.tracing.samples = 16;
    return shot;
}

// A picture of means over samples `begin` to `end` of every pixel.
Image path_picture(const PathTracer& tracer, const Camera& camera, std::uint64_t begin, std::uint64_t end,
                   std::uint64_t step = 1) {
    Image image{kSize, kSize, {}};
    for (const std::string& cell : kCells)
        image.layers.push_back({cell, {"R", "G", "B"}, true, std::vector<float>(3 * kPixels)});
    const std::uint64_t samples = (end - begin) / step;
    parallel_for(kPixels, [&](std::size_t p) {
        std::array<dvec3, 4> sum{};
        PathStatistics ignored;
        for (std::uint64_t s = begin; s < end; s += step) {
            const PathSum path = trace_sample(tracer, camera, p, s, ignored);
            for (int order = 0; order < kPathOrders; ++order)
                sum[1 + std::min(order, 2)] += dvec3(path[order]);
        }
        sum[0] = sum[1] + sum[2] + sum[3];
        for (int t = 0; t < 4; ++t)
            for (int c = 0; c < 3; ++c)
                image.layers[t].pixels[3 * p + c] = static_cast<float>(sum[t][c] / double(samples));
    });
    return image;
}

// Five per cent too bright, and light where none should be, from nothing at the left to a tenth of the mean at the
// right.
Image spoiled(Image image) {
    for (Layer& layer : image.layers) {
        double mean = 0.0;
        for (const float v : layer.pixels)
            mean += v / double(layer.pixels.size());
        for (std::size_t i = 0; i < layer.pixels.size(); ++i)
            layer.pixels[i] = static_cast<float>(1.05 * layer.pixels[i] + 0.1 * mean * double(i / 3 % kSize) / kSize);
    }
    return image;
}

struct TrueError {
    double square;            // relative
    double square_deviation;  // standard error of `square`: the truth is noisy too
    double mean;
};

// The errors of a picture, from two halves of the truth that are independent of it.
TrueError true_error(const Image& image, const Image& a, const Image& b, const std::string& cell) {
    const auto& i = image.layer(cell).pixels;
    const auto &ra = a.layer(cell).pixels, &rb = b.layer(cell).pixels;
    double square = 0.0, variance = 0.0, norm = 0.0, sum = 0.0, truth = 0.0;
    for (std::size_t k = 0; k < i.size(); ++k) {
        square += (double(i[k]) - ra[k]) * (double(i[k]) - rb[k]);
        // (I - A)(I - B) varies with A + B, which varies as A - B does.
        const double changed = (i[k] - 0.5 * (double(ra[k]) + rb[k])) * (double(ra[k]) - rb[k]);
        variance += 3.0 * changed * changed;  // the three channels of a sample are alike
        norm += double(ra[k]) * rb[k];
        sum += i[k];
        truth += 0.5 * (double(ra[k]) + rb[k]);
    }
    return {square / norm, std::sqrt(variance) / norm, sum / truth - 1.0};
}

// Two independent halves.
struct Truth {
    Image a, b;
};

class Certificates : public ::testing::Test {
protected:
    static constexpr int kCertificates = 240;

    // Paths that neither the truth nor a certificate has.
    Image picture(int samples_per_pixel) const {
        constexpr std::uint64_t first = 1 << 20;
        return path_picture(tracer_, camera_, first, first + samples_per_pixel);
    }

    CertifiedScene scene() const {
        return {medium_, camera_, nullptr, shot_.tracing, shot_.scattering.bounces, plan_.emission || plan_.emitters};
    }

    Certificate certificate(const Image& image, int seed, int samples = 4096) const {
        Progress silent;
        return certify(image, scene(), {true, samples, seed}, silent);
    }

    std::vector<Certificate> certificates(const Image& image, int first_seed) const {
        std::vector<Certificate> all;
        all.reserve(kCertificates);
        for (int seed = 0; seed < kCertificates; ++seed)
            all.push_back(certificate(image, first_seed + seed));
        return all;
    }

    Truth traced_truth() const {
        constexpr std::uint64_t samples = 512;  // per pixel, in each half
        return {path_picture(tracer_, camera_, 0, 2 * samples, 2), path_picture(tracer_, camera_, 1, 2 * samples, 2)};
    }

    static std::vector<TrueError> true_errors(const Image& image, const Truth& truth) {
        std::vector<TrueError> all;
        all.reserve(kCells.size());
        for (const std::string& cell : kCells)
            all.push_back(true_error(image, truth.a, truth.b, cell));
        return all;
    }

    Shot shot_ = shot_of_ball();
    Medium medium_ = burning_ball();
    Plan plan_ = plan_cells(shot_, medium_);
    Camera camera_{shot_.camera, medium_};
    PathTracer tracer_{medium_, shot_.tracing, shot_.scattering.bounces};
};

// Checks how often intervals hold the truth, and the mean of the estimates.
struct Coverage {
    int error = 0, below = 0, mean = 0, bound_only = 0;
    double square = 0.0, square_of_square = 0.0;
};

std::vector<Coverage> coverage_of(const std::vector<Certificate>& certificates, const std::vector<TrueError>& truth) {
    std::vector<Coverage> all(kCells.size());
    for (const Certificate& c : certificates)
        for (std::size_t t = 0; t < kCells.size(); ++t) {
            const CertifiedError& e = c.errors.at(t);
            const double error = std::sqrt(truth[t].square);
            const bool below = error <= e.error_interval.high;
            all[t].below += below;
            all[t].error += below && error >= e.error_interval.low;
            all[t].mean += truth[t].mean >= e.mean_interval.low && truth[t].mean <= e.mean_interval.high;
            all[t].bound_only += e.error_interval.low == 0.0;
            all[t].square += e.square / double(certificates.size());
            all[t].square_of_square += e.square * e.square / double(certificates.size());
        }
    return all;
}

// 240 intervals of true rate 95 % hold 216 or more with probability 0.9995.
constexpr double kRate = 0.9;

void expect_coverage(const std::vector<Certificate>& certificates, const std::vector<TrueError>& truth) {
    const double n = double(certificates.size());
    const std::vector<Coverage> coverage = coverage_of(certificates, truth);
    for (std::size_t t = 0; t < kCells.size(); ++t) {
        const Coverage& c = coverage[t];
        const std::string cell = kCells[t].empty() ? "picture" : kCells[t];
        EXPECT_GE(c.error / n, kRate) << cell;
        EXPECT_GE(c.below / n, kRate) << cell;
        EXPECT_GE(c.mean / n, kRate) << cell;
        // Intervals hold as often as they say while the estimates' bias is small beside the spread of one.
        const double spread = std::sqrt(c.square_of_square - c.square * c.square);
        EXPECT_NEAR(c.square, truth[t].square, 0.5 * spread + 4.0 * truth[t].square_deviation) << cell << ": biased";
        std::printf(
            "%-8s error %.3f %%: held %.1f %%, below the upper end %.1f %%, only bounded %.0f %%; mean %+.3f %%: "
            "held %.1f %%; square %.3e, truth %.3e +- %.1e, spread of one %.1e\n",
            cell.c_str(), 100.0 * std::sqrt(truth[t].square), 100.0 * c.error / n, 100.0 * c.below / n,
            100.0 * c.bound_only / n, 100.0 * truth[t].mean, 100.0 * c.mean / n, c.square, truth[t].square,
            truth[t].square_deviation, spread);
    }
}

// About a good picture and about a bad one. Both are compared with one truth, which takes half of the time.
TEST_F(Certificates, HoldTheTruthAsOftenAsTheySay) {
    const Image good = picture(512), bad = spoiled(good);
    const Truth truth = traced_truth();
    const std::vector<Certificate> of_bad = certificates(bad, 0), of_good = certificates(good, 1000);
    expect_coverage(of_bad, true_errors(bad, truth));
    expect_coverage(of_good, true_errors(good, truth));
    for (const Certificate& c : of_bad)
        EXPECT_GT(c.errors.front().error_interval.low, 0.0) << "an error of 6 % is distinguished from none";
    for (const Certificate& c : of_good)
        EXPECT_LT(c.errors.front().error_interval.high, 0.06) << "a good picture is known to be one";
}

// A hundredth of the pixels, which should be black, are as bright as the mean of the picture. Only pixels drawn
// uniformly can detect them.
TEST_F(Certificates, FindLightWhereNoneShouldBe) {
    Image image = picture(32);
    double mean = 0.0;
    for (const float v : image.layers[0].pixels)
        mean += v / double(3 * kPixels);
    for (std::size_t i = 0; i < 18; ++i)
        for (const std::size_t layer : {0, 1})
            image.layers[layer].pixels[i] += 30.0f * static_cast<float>(mean);
    for (int seed = 0; seed < 5; ++seed)
        EXPECT_GT(certificate(image, seed).errors.front().error_interval.low, 0.1);
}

TEST_F(Certificates, AreTheSameForAnyNumberOfThreadsAndOthersForOtherSeeds) {
    const Image image = picture(4);
    std::vector<std::string> texts;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        texts.push_back(certificate(image, 7).to_json().dump());
    }
    EXPECT_EQ(texts[0], texts[1]);
    EXPECT_EQ(texts[0], texts[2]);
    EXPECT_NE(texts[0], certificate(image, 8).to_json().dump());
}

TEST_F(Certificates, CostWhatTheySay) {
    const Image image = picture(1);
    for (const int samples : {1024, 4096, 20000}) {
        const Certificate c = certificate(image, 1, samples);
        EXPECT_EQ(c.samples, c.pixels * c.samples_per_pixel);
        EXPECT_LE(c.samples, std::uint64_t(samples));
        EXPECT_GT(c.samples, std::uint64_t(samples) * 9 / 10);
        EXPECT_GE(c.samples_per_pixel, 2u);
    }
}

TEST_F(Certificates, LeaveOutPixelsThatAreNotFiniteAndSaySo) {
    const Image whole = picture(16);
    Image image = whole;
    image.layers[0].pixels[3 * 300] = std::numeric_limits<float>::quiet_NaN();
    image.layers[2].pixels[3 * 301 + 1] = std::numeric_limits<float>::infinity();
    testing::Listener listener;
    const Certificate c = certify(image, scene(), {true, 4096, 1}, listener);
    EXPECT_EQ(c.not_finite_pixels, 2u);
    ASSERT_FALSE(listener.warnings.empty());
    EXPECT_NE(listener.warnings.front().second.find("2 pixels are not finite"), std::string::npos);
    const Certificate unharmed = certificate(whole, 1);
    for (std::size_t t = 0; t < kCells.size(); ++t) {
        const CertifiedError& e = c.errors.at(t);
        EXPECT_NEAR(e.error, unharmed.errors.at(t).error, 0.05) << e.cell;
        EXPECT_TRUE(std::isfinite(e.mean_interval.low) && std::isfinite(e.mean_interval.high));
    }
    for (Layer& layer : image.layers)
        std::fill(layer.pixels.begin(), layer.pixels.end(), std::numeric_limits<float>::quiet_NaN());
    const Certificate none = certify(image, scene(), {true, 4096, 1}, listener);
    EXPECT_EQ(none.not_finite_pixels, kPixels);
    EXPECT_EQ(none.errors.front().error_interval.high, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(none.to_json()["picture"]["error_interval"][1].is_null() ||
                std::isinf(none.to_json()["picture"]["error_interval"][1].get<double>()));
}

// With a filter other than that of the picture, the estimated error would exceed the noise.
TEST_F(Certificates, MeanThePicturesOwnPixelFilter) {
    const auto camera = [&](PixelFilter filter, float width) {
        CameraSettings settings = shot_.camera;
        settings.filter = filter;
        settings.filter_width_pixels = width;
        return Camera(settings, medium_);
    };
    const Camera gaussian = camera(PixelFilter::Gaussian, 6.0f);
    const std::vector<Camera> others = {camera(PixelFilter::Box, 6.0f), camera(PixelFilter::Gaussian, 1.0f)};
    camera_ = gaussian;
    const Image image = picture(512);
    const CertifiedError right = certificate(image, 3, 16384).errors.front();
    EXPECT_LT(right.error, 0.04);
    EXPECT_LT(std::abs(right.mean), right.mean_interval.high - right.mean_interval.low);
    for (const Camera& other : others) {
        camera_ = other;
        EXPECT_GT(certificate(image, 3, 16384).errors.front().error_interval.low, 0.06);
    }
}

TEST_F(Certificates, SayNothingOfCellsThatThePictureHasNoLayersOf) {
    Image image = picture(4);
    image.layers.resize(1);
    const Certificate c = certificate(image, 1);
    ASSERT_EQ(c.errors.size(), 1u);
    EXPECT_EQ(c.errors.front().cell, "");
}

TEST_F(Certificates, OfBlackSmokeNeedNoLight) {
    testing::Recipe r;
    r.box = testing::cube(-4, 4);
    r.density = [](const ivec3&) { return 1.0f; };
    const Medium medium = testing::make_medium(r);
    Shot shot = shot_;
    shot.certify = {true, 1024, 0};
    shot.medium.fire.model = FireModel::None;
    Progress silent;
    const RenderedFrame frame = render_medium(shot, medium, silent);
    EXPECT_EQ(frame.statistics.certificate["picture"]["error"], 0.0);
    EXPECT_EQ(frame.statistics.certificate["picture"]["error_interval"][1], 0.0);
}

TEST_F(Certificates, GoWithTheFrameOfEitherMethod) {
    Shot shot = shot_;
    shot.certify = {true, 4096, 0};
    for (const RenderMethod method : {RenderMethod::Path, RenderMethod::LightingGrid}) {
        shot.method = method;
        testing::Listener listener;
        const RenderedFrame frame = render_medium(shot, medium_, listener);
        const nlohmann::ordered_json json = frame.statistics.to_json()["certificate"];
        EXPECT_EQ(frame.metadata.text.at("brisance/certificate"), json.dump());
        EXPECT_EQ(json["cells"].size(), 3u);
        EXPECT_LT(json["picture"]["error"], 0.2);
        ASSERT_FALSE(listener.notices.empty());
        EXPECT_TRUE(listener.notices.back().starts_with("certificate: error "));
    }
    shot.certify.enabled = false;
    Progress silent;
    EXPECT_FALSE(render_medium(shot, medium_, silent).statistics.to_json().contains("certificate"));
}

}  // namespace
}  // namespace brisance
