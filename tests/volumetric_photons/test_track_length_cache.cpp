// Light deposited along particle tracks: what nodes hold of it, toward the eye and in any direction.
#include "volumetric_photons/track_length_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/parallel.h"
#include "fixtures/media.h"
#include "medium/phase.h"

namespace brisance {
namespace {

using namespace testing;

constexpr float kG = 0.7f;

// Black but for what scatters; 21 nodes along each side from -1 to 1.
Medium thin_cube(float extinction = 1e-4f) {
    Recipe r;
    r.box = cube(-10, 10);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = Rgb(0.5f);
    r.settings.smoke.mean_cosine = kG;
    return make_medium(r);
}

dvec3 node_at(const Medium& medium, const vec3& local) {
    return dvec3(medium.index_from_local * local) + dvec3(medium.reference_node);
}

struct Track {
    Ray ray;
    Rgb power;
};

// Parallel tracks all over the cube, as from a sun: radiance is irradiance times the phase function everywhere.
std::vector<Track> sunlight(const dvec3& direction, double irradiance, int side_count) {
    std::vector<Track> tracks;
    Rng rng(Stream::Points, 4);
    const dvec3 side = glm::normalize(glm::cross(direction, dvec3(0.3, 0.9, 0.1))), up = glm::cross(direction, side);
    constexpr double kHalf = 2.0;
    const double step = 2.0 * kHalf / side_count;
    const Rgb power(float(irradiance * step * step));
    for (int i = 0; i < side_count * side_count; ++i) {
        const int row = i / side_count, column = i % side_count;
        const double x = (row + rng.next_double()) * step - kHalf;
        const double y = (column + rng.next_double()) * step - kHalf;
        tracks.push_back({{x * side + y * up - 4.0 * direction, direction}, power});
    }
    return tracks;
}

TrackLengthCache deposited(const Medium& medium, const dvec3& eye, const std::vector<Track>& tracks, bool others,
                           std::uint64_t seed, bool backward = false, float filter_radius = 0.0f) {
    double power = 0.0;
    for (const Track& w : tracks)
        power += w.power.x;
    TrackLengthCache light(medium, eye, power, others);
    parallel_for(tracks.size(), [&](std::size_t k) {
        const std::size_t i = backward ? tracks.size() - 1 - k : k;
        Rng rng(Stream::StoredTrack, i, seed);
        light.add(tracks[i].ray, 1e30, tracks[i].power, rng);
    });
    light.finish(filter_radius);
    return light;
}

TEST(TrackLengthCache, SunlightScattersAlikeEverywhere) {
    const Medium medium = thin_cube();
    const dvec3 direction = glm::normalize(dvec3(0.4, 0.2, -1.0)), eye(0.5, -6.0, 1.0);
    const TrackLengthCache light = deposited(medium, eye, sunlight(direction, 3.0, 800), false, 1);
    // Between nodes, in the corners of the cube and on its skin as well.
    for (const vec3 position :
         {vec3(0.0f), vec3(0.33f, -0.41f, 0.27f), vec3(0.98f, 0.97f, -0.96f), vec3(-1.0f, 0.2f, 0.1f)}) {
        const dvec3 toward = glm::normalize(eye - dvec3(position));
        const double expected = 3.0 * henyey_greenstein(float(glm::dot(direction, toward)), kG);
        EXPECT_NEAR(light.toward_eye(node_at(medium, position)).x / expected, 1.0, 0.05) << position.x;
    }
}

TEST(TrackLengthCache, SmokeDimsIt) {
    const Medium medium = thin_cube(0.8f);
    const dvec3 direction(0.0, 0.0, -1.0), eye(0.0, -6.0, 0.0);
    const TrackLengthCache light = deposited(medium, eye, sunlight(direction, 1.0, 500), false, 1);
    const auto at = [&](float z) { return double(light.toward_eye(node_at(medium, {0.05f, 0.05f, z})).x); };
    const auto phase = [&](float z) {
        return double(henyey_greenstein(float(glm::dot(direction, glm::normalize(eye - dvec3(0.05, 0.05, z)))), kG));
    };
    EXPECT_NEAR(at(-0.65f) / phase(-0.65f) / (at(0.75f) / phase(0.75f)), std::exp(-0.8 * 1.4), 0.04);
}

// The few tracks that a node keeps represent all of them: the mean of many draws is the same radiance toward the eye.
TEST(TrackLengthCache, KeptTracksRepresentAll) {
    const Medium medium = thin_cube();
    const dvec3 eye(0.5, -6.0, 1.0);
    std::vector<Track> tracks;
    Rng rng(Stream::Points, 9);
    for (int i = 0; i < 3000; ++i) {  // of very different powers, from and to anywhere
        const dvec3 from = 3.0 * (2.0 * dvec3(rng.next_double(), rng.next_double(), rng.next_double()) - 1.0);
        const dvec3 to = 0.9 * (2.0 * dvec3(rng.next_double(), rng.next_double(), rng.next_double()) - 1.0);
        tracks.push_back({{from, glm::normalize(to - from)}, Rgb(std::pow(rng.next(), 4.0f))});
    }
    constexpr int kSets = 300;
    const vec3 position(0.0f);  // a node: nothing is drawn between nodes
    const dvec3 node = node_at(medium, position);
    const double expected = deposited(medium, eye, tracks, false, 0).toward_eye(node).x;
    const vec3 toward(glm::normalize(eye - dvec3(position)));
    double sum = 0.0, square = 0.0;
    for (int set = 0; set < kSets; ++set) {
        const double v = deposited(medium, eye, tracks, true, std::uint64_t(set) + 1).toward(toward, node, 0.0f).x;
        sum += v / kSets;
        square += v * v / kSets;
    }
    const double error = std::sqrt((square - sum * sum) / (kSets - 1));
    std::printf("kept %.5g +- %.2g, all %.5g\n", sum, error, expected);
    EXPECT_NEAR(sum, expected, 3.0 * error);
    EXPECT_LT(error, 0.05 * expected);
    EXPECT_GT(error, 0.0);  // it has drawn
}

TEST(TrackLengthCache, ComesOutTheSameInAnyOrder) {
    const Medium medium = thin_cube();
    const dvec3 eye(0.5, -6.0, 1.0);
    const std::vector<Track> tracks = sunlight(glm::normalize(dvec3(0.4, 0.2, -1.0)), 3.0, 150);
    const TrackLengthCache a = deposited(medium, eye, tracks, true, 1),
                           b = deposited(medium, eye, tracks, true, 1, true);
    Rng rng(Stream::Points, 1);
    for (int i = 0; i < 200; ++i) {
        const vec3 position = 2.0f * vec3(rng.next(), rng.next(), rng.next()) - 1.0f;
        const dvec3 node = node_at(medium, position);
        EXPECT_EQ(a.toward_eye(node), b.toward_eye(node));
        EXPECT_EQ(a.toward({0, 0, 1}, node, 0.4f), b.toward({0, 0, 1}, node, 0.4f));
    }
}

TEST(TrackLengthCache, FarAwayThereIsNone) {
    const Medium medium = thin_cube();
    const TrackLengthCache light = deposited(medium, {0, -6, 0}, sunlight({0, 0, -1}, 1.0, 10), true, 1);
    EXPECT_EQ(light.toward_eye({1e6, 0, 0}), Rgb(0.0f));
    EXPECT_EQ(light.toward({0, 0, 1}, {1e6, 0, 0}, 0.5f), Rgb(0.0f));
}

// Root mean square of the relative error at points all over the cube, its corners included.
double relative_error(const TrackLengthCache& light, const Medium& medium, double expected) {
    double square = 0.0;
    int count = 0;
    for (float x = -1.0f; x <= 1.0f; x += 0.125f)
        for (float y = -1.0f; y <= 1.0f; y += 0.125f)
            for (float z = -1.0f; z <= 1.0f; z += 0.125f, ++count)
                square += std::pow(light.toward_eye(node_at(medium, {x, y, z})).x / expected - 1.0, 2);
    return std::sqrt(square / count);
}

// Seen from so far away that all nodes scatter alike, sunlight is constant. A filter keeps it, up to the skin, and
// takes away the noise of few tracks: a Gaussian of two nodes averages about (4 pi)^(3/2) 2^3 = 350 of them.
TEST(TrackLengthCache, FilteredSunlightHasLessNoiseAndTheSameMean) {
    const Medium medium = thin_cube();
    const dvec3 direction = glm::normalize(dvec3(0.4, 0.2, -1.0)), eye(50.0, -6000.0, 100.0);
    const double expected = 3.0 * henyey_greenstein(float(glm::dot(direction, glm::normalize(eye))), kG);
    const auto error = [&](int side_count, float filter_radius) {
        const TrackLengthCache light =
            deposited(medium, eye, sunlight(direction, 3.0, side_count), false, 1, false, filter_radius);
        return relative_error(light, medium, expected);
    };
    EXPECT_LT(error(800, 2.0f), 0.005);
    const double noisy = error(60, 0.0f), filtered = error(60, 2.0f);
    std::printf("few tracks: %.4f, filtered %.4f\n", noisy, filtered);
    EXPECT_GT(noisy, 0.1) << "there must be noise";
    EXPECT_LT(filtered, 0.35 * noisy);
}

TEST(TrackLengthCache, AFilterSpreadsLightAndKeepsAllOfIt) {
    const Medium medium = thin_cube();
    const dvec3 eye(50.0, -6000.0, 100.0);
    // One short track in the middle.
    const std::vector<Track> tracks = {{{dvec3(0.02, 0.01, -0.03), dvec3(0.0, 0.0, 1.0)}, Rgb(1.0f)}};
    const auto sum = [&](float filter_radius) {
        TrackLengthCache light(medium, eye, 1.0, false);
        Rng rng(Stream::StoredTrack, 0, 1);
        light.add(tracks[0].ray, 0.05, tracks[0].power, rng);
        light.finish(filter_radius);
        double all = 0.0, most = 0.0;
        for (int x = -9; x <= 9; ++x)
            for (int y = -9; y <= 9; ++y)
                for (int z = -9; z <= 9; ++z) {
                    const double v = light.toward_eye(dvec3(x, y, z)).x;
                    all += v;
                    most = std::max(most, v);
                }
        return std::pair(all, most);
    };
    const auto [all, most] = sum(0.0f);
    const auto [spread, less] = sum(1.5f);
    EXPECT_NEAR(spread / all, 1.0, 1e-3);
    EXPECT_LT(less, 0.2 * most);
}

}  // namespace
}  // namespace brisance
