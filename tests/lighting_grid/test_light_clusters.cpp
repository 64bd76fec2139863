// Lamps in the place of a fire: however few, they have its power, its first and its second moment.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "fixtures/media.h"
#include "lighting_grid/light_clusters.h"

namespace brisance {
namespace {

using namespace testing;

Recipe coloured_sparks() {
    Recipe r;
    r.box = cube(-20, 21);
    r.world_from_index = transform(some_linear_map(), {0.0, 0.0, 0.0});
    r.density = [](const ivec3& n) { return noise(n, 1); };
    r.flame = [](const ivec3& n) { return noise(n, 2) > 0.97f ? noise(n, 3) : 0.0f; };
    r.colour = [](const ivec3& n) { return Rgb(noise(n, 5), n.x > 3 ? 1.0f : 0.0f, 0.01f); };
    r.settings = black_smoke();
    r.settings.colour_role = ColourRole::Emission;
    return r;
}

struct Fire {
    explicit Fire(const Recipe& recipe) : medium(make_medium(recipe)), intensity(voxel_lights(medium)) {}
    Medium medium;
    std::vector<Rgb> intensity;
    std::size_t voxels() const {
        return std::size_t(
            std::count_if(intensity.begin(), intensity.end(), [](const Rgb& i) { return luminance(i) > 0.0f; }));
    }
};

// Sums of luminance, of it times position, and of it times the squared distance to the origin.
struct Moments {
    double power = 0.0, second = 0.0;
    dvec3 first{0.0};
    void add(const Rgb& intensity, const vec3& position, double variance) {
        const double y = luminance(intensity);
        const dvec3 p(position);
        power += y;
        first += y * p;
        second += y * (glm::dot(p, p) + variance);
    }
};

// Of uniform balls the variance is 3/5 of the squared radius; what a voxel itself adds is no part of the second moment.
double voxel_square(const Medium& medium) {
    return std::pow(3.0 * medium.voxel_volume / (4.0 * 3.14159265358979), 2.0 / 3.0);
}

Moments of_lamps(const GridLevel& lamps, const Medium& medium) {
    Moments m;
    for (std::size_t i = 0; i < lamps.size(); ++i)
        m.add(lamps.intensity[i], lamps.position[i],
              0.6 * (double(lamps.ball[i].radius) * lamps.ball[i].radius - voxel_square(medium)));
    return m;
}

Moments of_voxels(const Fire& fire) {
    Moments m;
    for (std::size_t i = 0; i < fire.intensity.size(); ++i)
        m.add(fire.intensity[i], fire.medium.local_of_node(fire.medium.lattice.node(i)), 0.0);
    return m;
}

// Mean squared distance of the power from its lamps [m^2]: what k-means minimises.
double spread(const GridLevel& lamps, const Medium& medium) {
    double sum = 0.0, power = 0.0;
    for (std::size_t i = 0; i < lamps.size(); ++i) {
        const double y = luminance(lamps.intensity[i]);
        sum += y * 0.6 * (double(lamps.ball[i].radius) * lamps.ball[i].radius - voxel_square(medium));
        power += y;
    }
    return sum / power;
}

TEST(LightClusters, HaveThePowerAndTheMomentsOfTheFire) {
    const Fire fire(coloured_sparks());
    ASSERT_GT(fire.voxels(), 1000u);
    const Moments all = of_voxels(fire);
    const dvec3 colours = total(fire.intensity);
    for (const int count : {1, 2, 7, 64, 500}) {
        const GridLevel lamps = cluster_lights(fire.medium, fire.intensity, count);
        EXPECT_EQ(lamps.size(), std::size_t(count));
        const Moments m = of_lamps(lamps, fire.medium);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(total(lamps.intensity)[c] / colours[c], 1.0, 1e-6) << count;
        EXPECT_LT(glm::length(m.first - all.first) / all.power, 1e-6 * std::sqrt(all.second / all.power)) << count;
        EXPECT_NEAR(m.second / all.second, 1.0, 1e-5) << count;
    }
}

TEST(LightClusters, LieCloserToTheirVoxelsTheMoreThereAre) {
    const Fire fire(coloured_sparks());
    const double one = spread(cluster_lights(fire.medium, fire.intensity, 1), fire.medium);
    double before = one;
    for (const int count : {4, 16, 64, 256}) {
        const double now = spread(cluster_lights(fire.medium, fire.intensity, count), fire.medium);
        // A fire that fills a volume: cells of N lamps are as wide as N^(-1/3) of it, within a factor.
        EXPECT_LT(now, 1.5 * one * std::pow(count, -2.0 / 3.0)) << count;
        EXPECT_LT(now, before) << count;
        before = now;
    }
}

TEST(LightClusters, AreTheVoxelsThemselvesWhereThereAreEnough) {
    Recipe few = coloured_sparks();
    few.box = cube(-9, 10);
    const Fire fire(few);
    ASSERT_GT(fire.voxels(), 100u);
    const GridLevel lamps = cluster_lights(fire.medium, fire.intensity, 100000);
    ASSERT_EQ(lamps.size(), fire.voxels());
    const float voxel = std::sqrt(float(voxel_square(fire.medium)));
    for (std::size_t i = 0; i < lamps.size(); ++i) {
        const vec3 node = fire.medium.index_from_local * lamps.position[i] + vec3(fire.medium.reference_node);
        const std::int64_t k = fire.medium.lattice.find_node(ivec3(glm::round(node)));
        ASSERT_GE(k, 0);
        ASSERT_LT(glm::length(node - glm::round(node)), 1e-4f);
        ASSERT_EQ(lamps.intensity[i], fire.intensity[k]);
        ASSERT_NEAR(lamps.ball[i].radius / voxel, 1.0f, 1e-3f);
    }
}

TEST(LightClusters, FindFiresThatLieApart) {
    Recipe r;
    r.box = cube(-40, 40);
    r.world_from_index = cubic(0.1);
    r.settings = black_smoke();
    const std::vector<dvec3> fires = {{-30, -30, 0}, {30, -20, 5}, {0, 30, -30}};
    r.density = [=](const ivec3& n) {
        float sum = 0.0f;
        for (const dvec3& fire : fires)
            sum += ball(n, fire, 5.0);
        return sum;
    };
    r.flame = r.density;
    const Fire fire(r);
    const GridLevel lamps = cluster_lights(fire.medium, fire.intensity, 3);
    ASSERT_EQ(lamps.size(), 3u);
    for (const dvec3& centre : fires) {
        const vec3 at = fire.medium.local_of_node(ivec3(centre));
        float nearest = 1e30f;
        for (const vec3& p : lamps.position)
            nearest = std::min(nearest, glm::length(p - at));
        EXPECT_LT(nearest, 1e-3f);
    }
    for (const LightBall& b : lamps.ball)
        EXPECT_NEAR(b.radius, 0.5f, 0.05f) << "the fires are balls of this radius";
}

TEST(LightClusters, AreTheSameOnAnyNumberOfThreads) {
    const Fire fire(coloured_sparks());
    std::vector<GridLevel> found;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        found.push_back(cluster_lights(fire.medium, fire.intensity, 40));
    }
    for (std::size_t k = 1; k < found.size(); ++k) {
        EXPECT_EQ(found[k].position, found[0].position);
        EXPECT_EQ(found[k].intensity, found[0].intensity);
        for (std::size_t i = 0; i < found[0].size(); ++i)
            EXPECT_EQ(found[k].ball[i].radius, found[0].ball[i].radius);
    }
}

// Of the light that starts in a ball and the smoke within it, what does not leave collides there: `inside` times the
// mean of 1 / r^2 over pairs of points of the ball, 9 / (4 a^2), times its extinction and volume.
TEST(LightClusters, LoseNoLightInTheirOwnSmoke) {
    for (const float extinction : {1e-6f, 0.01f, 0.3f, 3.0f, 100.0f}) {
        Recipe r;
        r.box = cube(-20, 20);
        r.world_from_index = cubic(0.1);
        r.density = [](const ivec3&) { return 1.0f; };
        r.flame = [](const ivec3& n) { return ball(n, dvec3(0.0), 8.0); };
        r.settings = black_smoke();
        r.settings.smoke.extinction_per_metre = extinction;
        r.settings.fire.convention = EmissionConvention::Direct;
        const Fire fire(r);
        const LightBall lamp = cluster_lights(fire.medium, fire.intensity, 1).ball.at(0);
        const double depth = double(extinction) * lamp.radius;
        EXPECT_NEAR(lamp.escape + 0.75 * depth * lamp.inside, 1.0, 1e-4) << extinction;
        // Limits: everything leaves thin balls; the skin of thick ones, of a mean free path, sends a fourth outward.
        if (depth < 1e-3) {
            EXPECT_NEAR(lamp.escape, 1.0, 1e-3);
        }
        if (depth > 50.0) {
            EXPECT_NEAR(lamp.escape * depth, 0.75, 0.01);
        }
    }
}

TEST(LightClusters, OfNoFireAreNone) {
    const Fire fire(coloured_sparks());
    EXPECT_EQ(cluster_lights(fire.medium, std::vector<Rgb>(fire.intensity.size(), Rgb(0.0f)), 4).size(), 0u);
}

}  // namespace
}  // namespace brisance
