// The path tracer's pictures: layers that add up, halves that are independent, bits that depend on nothing but the
// shot.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "../volume/temp_folder.h"
#include "core/parallel.h"
#include "fixtures/media.h"
#include "forecast/plan.h"
#include "reference/trace_picture.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kWidth = 40, kHeight = 36;

Medium cloud(float strength = 1.0f) {
    Recipe r;
    r.box = cube(-9, 9);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3& n) { return 9.0f * testing::ball(n, dvec3(0.0), 8.0) * testing::noise(n >> 1, 1); };
    r.flame = [](const ivec3& n) { return std::max(0.0f, testing::noise(n >> 1, 2) - 0.5f); };
    r.settings.smoke.albedo = Rgb(0.9f, 0.8f, 0.6f);
    r.settings.smoke.mean_cosine = 0.4f;
    r.settings.fire.colour = Rgb(1.0f, 0.6f, 0.3f);
    r.settings.fire.strength = strength;
    return make_medium(r);
}

Shot shot_of(int samples) {
    Shot shot;
    shot.method = RenderMethod::Path;
    shot.tracing.samples = samples;
    shot.output.bounce_layers = true;
    shot.camera.eye = dvec3(1.0, -5.0, 0.7);
    shot.camera.vertical_fov_degrees = 25.0;
    shot.camera.width = kWidth;
    shot.camera.height = kHeight;
    shot.camera_given = true;
    return shot;
}

struct Render {
    TracedPicture picture;
    Statistics statistics;
    Listener messages;
    // The statistics of the stage that traces paths.
    const nlohmann::ordered_json& paths() const {
        const auto stage = std::find_if(statistics.stages.begin(), statistics.stages.end(),
                                        [](const StageCost& s) { return s.name == "path tracing"; });
        if (stage == statistics.stages.end())
            throw std::logic_error("no stage reports paths");
        return stage->detail;
    }
};

Render render(const Shot& shot, const Medium& medium, const Checkpoint& checkpoint = {}) {
    Render r;
    const Camera camera(shot.camera, medium);
    const CellSet needed = plan_cells(shot, medium).needed;
    r.picture = trace_picture({medium, camera, nullptr, shot.tracing, shot.scattering.bounces, needed, shot.output},
                              checkpoint, r.statistics, r.messages);
    return r;
}

const Render& a_render() {
    static const Render r = render(shot_of(16), cloud());
    return r;
}

// The colours of a layer, alpha left out.
std::vector<float> colour(const Image& image, const std::string& name) {
    const Layer& layer = image.layer(name);
    std::vector<float> out;
    for (std::size_t p = 0; p < layer.pixels.size(); p += layer.channels.size())
        out.insert(out.end(), &layer.pixels[p], &layer.pixels[p] + 3);
    return out;
}

void expect_sum(const Image& image, const std::vector<std::string>& parts, const std::string& whole) {
    const std::vector<float> expected = colour(image, whole);
    std::vector<double> sum(expected.size());
    for (const std::string& part : parts) {
        const std::vector<float> values = colour(image, part);
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += values[i];
    }
    for (std::size_t i = 0; i < sum.size(); ++i)
        ASSERT_NEAR(sum[i], expected[i], 1e-6 * expected[i]) << whole << ", number " << i;
}

std::vector<std::string> bounces(int first) {
    std::vector<std::string> names;
    for (int k = first; k + 1 < kPathOrders; ++k)
        names.push_back("bounce" + std::to_string(k));
    names.push_back("bounces_beyond" + std::to_string(kPathOrders - 2));
    return names;
}

bool same_bits(const Image& a, const Image& b) {
    if (a.layers.size() != b.layers.size())
        return false;
    for (std::size_t i = 0; i < a.layers.size(); ++i)
        if (a.layers[i].name != b.layers[i].name || a.layers[i].pixels != b.layers[i].pixels)
            return false;
    return true;
}

TEST(TracedPicture, CellsAddUpToTheBeauty) {
    const TracedPicture& p = a_render().picture;
    for (const Image* image : {&p.image, &p.halves[0], &p.halves[1]})
        expect_sum(*image, {"V", "MV", "MM"}, "");
}

TEST(TracedPicture, BouncesAddUpToTheirCells) {
    const TracedPicture& p = a_render().picture;
    for (const Image* image : {&p.image, &p.halves[0], &p.halves[1]}) {
        expect_sum(*image, {"bounce1"}, "MV");
        expect_sum(*image, bounces(2), "MM");
    }
}

TEST(TracedPicture, IsTheMeanOfItsHalves) {
    const TracedPicture& p = a_render().picture;
    for (const std::string name : {"", "V", "MV", "MM", "bounce1", "bounce5", "bounces_beyond8"}) {
        const std::vector<float> whole = colour(p.image, name), a = colour(p.halves[0], name),
                                 b = colour(p.halves[1], name);
        for (std::size_t i = 0; i < whole.size(); ++i)
            ASSERT_NEAR(whole[i], 0.5 * (double(a[i]) + b[i]), 1e-6 * whole[i]) << name;
    }
    EXPECT_EQ(p.samples_per_pixel, 16.0);
    EXPECT_FALSE(same_bits(p.halves[0], p.halves[1]));
}

// Filtered, scattered light is nearer to the truth; every layer has the same light, and the picture still is the mean
// of its halves.
TEST(TracedPicture, FilteredHasLessNoiseAndTheSameLight) {
    const Medium medium = cloud();
    Shot shot = shot_of(4);
    const Image noisy = render(shot, medium).picture.image;
    shot.tracing.denoising_radius = 4;
    const TracedPicture filtered = render(shot, medium).picture;
    Shot long_shot = shot_of(256);
    long_shot.tracing.seed = 1;
    const Image truth = render(long_shot, medium).picture.image;
    const auto error = [&](const Image& image, const std::string& name) {
        const std::vector<float> found = colour(image, name), expected = colour(truth, name);
        double square = 0.0, norm = 0.0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            square += std::pow(double(found[i]) - expected[i], 2);
            norm += double(expected[i]) * expected[i];
        }
        return std::sqrt(square / norm);
    };
    for (const std::string name : {"", "V", "MV", "MM"})
        std::printf("%s: %.4f, filtered %.4f\n", name.c_str(), error(noisy, name), error(filtered.image, name));
    EXPECT_LT(error(filtered.image, "MV"), 0.9 * error(noisy, "MV"));
    EXPECT_LT(error(filtered.image, "MM"), 0.8 * error(noisy, "MM"));
    EXPECT_LT(error(filtered.image, ""), error(noisy, ""));
    for (const std::string name : {"", "V", "MV", "MM", "bounce3"}) {
        const std::vector<float> before = colour(noisy, name), after = colour(filtered.image, name);
        const double sum = std::accumulate(before.begin(), before.end(), 0.0);
        EXPECT_NEAR(std::accumulate(after.begin(), after.end(), 0.0) / sum, 1.0, 1e-5) << name;
        const std::vector<float> a = colour(filtered.halves[0], name), b = colour(filtered.halves[1], name);
        for (std::size_t i = 0; i < after.size(); ++i)
            ASSERT_NEAR(after[i], 0.5 * (double(a[i]) + b[i]), 1e-5 * (after[i] + 1e-3)) << name;
    }
}

TEST(TracedPicture, DoesNotKnowHowManyThreadsThereAre) {
    const Medium medium = cloud();
    const Shot shot = shot_of(4);
    std::vector<Render> found;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        found.push_back(render(shot, medium));
    }
    for (std::size_t k = 1; k < found.size(); ++k) {
        EXPECT_TRUE(same_bits(found[k].picture.image, found[0].picture.image));
        for (int half = 0; half < 2; ++half)
            EXPECT_TRUE(same_bits(found[k].picture.halves[half], found[0].picture.halves[half]));
    }
}

// Stopped and taken up again from its checkpoint, a render ends with the same bits.
TEST(TracedPicture, GoesOnWhereItStopped) {
    const TempFolder folder;
    const Medium medium = cloud();
    const Checkpoint checkpoint{folder / "state", "a key"};
    render(shot_of(4), medium, checkpoint);
    const Render on = render(shot_of(10), medium, checkpoint), once = render(shot_of(10), medium);
    EXPECT_EQ(on.messages.notices.size(), 1u);
    EXPECT_TRUE(same_bits(on.picture.image, once.picture.image));
    EXPECT_TRUE(same_bits(on.picture.halves[0], once.picture.halves[0]));
    EXPECT_TRUE(same_bits(on.picture.halves[1], once.picture.halves[1]));
    // Nothing left to do: the picture is developed from the checkpoint alone.
    EXPECT_TRUE(same_bits(render(shot_of(10), medium, checkpoint).picture.image, once.picture.image));
}

TEST(TracedPicture, RefusesTheCheckpointOfAnotherShot) {
    const TempFolder folder;
    const Medium medium = cloud();
    render(shot_of(2), medium, {folder / "state", "a key"});
    const Failure failure = failure_of([&] { render(shot_of(4), medium, {folder / "state", "another key"}); });
    EXPECT_EQ(failure.code, ExitCode::BadData);
    EXPECT_TRUE(contains(failure.message, "another shot")) << failure.message;
    write_bytes(folder / "state", "garbage");
    EXPECT_EQ(failure_of([&] { render(shot_of(4), medium, {folder / "state", "a key"}); }).code, ExitCode::BadData);
}

// What is known of a pixel's error: from the spread of its paths, and from its halves. Both are summed over the
// picture; stratification makes the second smaller, and the sums are known to about a tenth.
TEST(TracedPicture, VarianceIsThatOfTheHalvesOrMore) {
    const TracedPicture& p = a_render().picture;
    const std::vector<float> variance = colour(p.image, "variance"), a = colour(p.halves[0], ""),
                             b = colour(p.halves[1], "");
    for (int channel = 0; channel < 3; ++channel) {
        double by_paths = 0.0, by_halves = 0.0, square = 0.0;
        for (std::size_t i = channel; i < variance.size(); i += 3) {
            const double difference = 0.25 * std::pow(double(a[i]) - b[i], 2);
            by_paths += variance[i];
            by_halves += difference;
            square += difference * difference;
        }
        EXPECT_LT(by_halves, by_paths + 4.0 * std::sqrt(square));
        EXPECT_GT(by_halves, 0.02 * by_paths);
    }
}

// The brightest fire that a shot may ask for: squares of its light are beyond single precision.
TEST(TracedPicture, TheVarianceOfTheBrightestFireIsANumber) {
    const Render r = render(shot_of(2), cloud(1e20f));
    float brightest = 0.0f;
    for (const Layer& layer : r.picture.image.layers)
        for (const float value : layer.pixels) {
            ASSERT_TRUE(std::isfinite(value)) << layer.name;
            brightest = layer.name.empty() ? std::max(brightest, value) : brightest;
        }
    EXPECT_GT(brightest, 1e15f);
    for (const float value : colour(r.picture.image, "variance"))
        EXPECT_GE(value, 0.0f);
}

// Sum over the picture, all channels, and its standard error by the spread of paths.
std::pair<double, double> whole(const Image& image) {
    double sum = 0.0, variance = 0.0;
    for (const float v : colour(image, ""))
        sum += v;
    // Channels of a pixel go up and down together, pixels do not.
    const std::vector<float> v = colour(image, "variance");
    for (std::size_t i = 0; i < v.size(); i += 3)
        variance += std::pow(std::sqrt(v[i]) + std::sqrt(v[i + 1]) + std::sqrt(v[i + 2]), 2);
    return {sum, std::sqrt(variance)};
}

TEST(TracedPicture, OfAnotherSeedHasOtherNoiseAndTheSameMean) {
    Shot shot = shot_of(16);
    shot.tracing.seed = 1;
    const Image other = render(shot, cloud()).picture.image;
    const Image& first = a_render().picture.image;
    const std::vector<float> a = colour(first, ""), b = colour(other, "");
    std::size_t same = 0, lit = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        lit += a[i] > 0.0f;
        same += a[i] > 0.0f && a[i] == b[i];
    }
    EXPECT_LT(same, lit / 100);
    const auto [sum_a, error_a] = whole(first);
    const auto [sum_b, error_b] = whole(other);
    EXPECT_LE(std::abs(sum_a - sum_b), 4.0 * std::hypot(error_a, error_b));
    EXPECT_LT(error_a, 0.01 * sum_a) << "not sampled enough";
}

TEST(TracedPicture, MorePathsAreLessNoise) {
    const Medium medium = cloud();
    const auto error = [&](int samples) {
        const Render r = render(shot_of(samples), medium);
        return r.paths().at("relative_standard_error").get<double>();
    };
    const double ratio = error(4) / error(64);
    EXPECT_GT(ratio, 3.2);
    EXPECT_LT(ratio, 6.0);
}

TEST(TracedPicture, StopsAtTheErrorAskedFor) {
    Shot shot = shot_of(0);
    shot.tracing.error = 0.05;
    const Render r = render(shot, cloud());
    const double error = r.paths().at("relative_standard_error").get<double>();
    EXPECT_LE(error, 0.05);
    EXPECT_GT(error, 0.03);
}

TEST(TracedPicture, SmokeThatScattersNothingHasNoScatteredLayers) {
    Medium medium = cloud();
    medium.albedo = Rgb(0.0f);
    const Image image = render(shot_of(2), medium).picture.image;
    for (const Layer& layer : image.layers)
        EXPECT_TRUE(layer.name != "MV" && layer.name != "MM" && layer.name != "bounce1") << layer.name;
    EXPECT_EQ(colour(image, ""), colour(image, "V"));
}

// One node of the cloud shines like that: its paths are counted, reported and left out; the others make the picture.
void expect_left_out(float brightness) {
    Medium medium = cloud();
    medium.source.at(medium.lattice.find_node(ivec3(1, 2, -3))) = Rgb(brightness);
    const Render r = render(shot_of(2), medium);
    const auto bad = r.paths().at("not_finite_paths").get<std::uint64_t>();
    EXPECT_GT(bad, 0u);
    EXPECT_LT(bad, std::uint64_t(kWidth) * kHeight);
    ASSERT_EQ(r.messages.warnings.size(), 1u);
    EXPECT_EQ(r.messages.warnings[0].first, "not-finite");
    const std::vector<float> beauty = colour(r.picture.image, "");
    EXPECT_TRUE(std::all_of(beauty.begin(), beauty.end(), [](float v) { return std::isfinite(v); }));
    EXPECT_GT(*std::max_element(beauty.begin(), beauty.end()), 0.0f);
}

TEST(TracedPicture, PathsThatOverflowAreCountedAndLeftOut) {
    expect_left_out(3e38f);
}

TEST(TracedPicture, PathsThatMeetEndlessBrightnessAreCountedAndLeftOut) {
    expect_left_out(std::numeric_limits<float>::infinity());
    expect_left_out(std::numeric_limits<float>::quiet_NaN());
}

}  // namespace
}  // namespace brisance
