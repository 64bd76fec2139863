// Light at points of surfaces, estimated from the particles that land around them.
#include "volumetric_photons/photon_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/rng.h"

namespace brisance {
namespace {

constexpr float kColour = 0.6f;

SurfaceMaterial plain() {
    SurfaceMaterial m;
    m.base_colour = Rgb(kColour);
    m.specular = 0.0f;
    return m;
}

SurfacePoint on_floor(const dvec3& position) {
    SurfacePoint p;
    p.position = position;
    p.geometric_normal = {0, 0, 1};
    p.frame = frame_around({0, 0, 1});
    p.material = plain();
    return p;
}

// On the square from -1 to 1: that many particles of 1 W together.
std::vector<SurfacePhoton> on_square(int count, float height, const vec3& normal, std::uint64_t seed) {
    std::vector<SurfacePhoton> photons;
    Rng rng(Stream::Points, seed);
    for (int i = 0; i < count; ++i) {
        const float x = 2.0f * rng.next() - 1.0f, y = 2.0f * rng.next() - 1.0f;
        const vec3 direction = glm::normalize(vec3(rng.next() - 0.5f, rng.next() - 0.5f, -1.0f));
        photons.push_back({{x, y, height}, normal, normal.z > 0.0f ? direction : -direction, Rgb(1.0f / count)});
    }
    return photons;
}

Rgb seen(const PhotonMap& photons, const dvec3& position, int neighbours) {
    const SurfacePoint p = on_floor(position);
    return photons.scattered(p, Bsdf(p.material, p.frame), glm::normalize(dvec3(0.3, 0.1, 1.0)), neighbours);
}

// An irradiance of a quarter watt per square metre. One of n neighbours is the last whose distance counts: relative
// standard deviation 1 / sqrt(n - 1) of each, and 400 places apart are about independent.
TEST(PhotonMap, TellAnEvenIrradiance) {
    constexpr int kNeighbours = 50;
    const PhotonMap photons(on_square(200000, 0.0f, {0, 0, 1}, 1));
    double sum = 0.0, square = 0.0;
    int places = 0;
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j, ++places) {
            const double v = seen(photons, {-0.76 + 0.08 * i, -0.76 + 0.08 * j, 0.0}, kNeighbours).x;
            sum += v;
            square += v * v;
        }
    const double mean = sum / places, deviation = std::sqrt(square / places - mean * mean);
    const double expected = 0.25 * kColour / std::numbers::pi;
    EXPECT_NEAR(mean, expected, 3.0 * deviation / std::sqrt(places));
    EXPECT_NEAR(deviation / expected, 1.0 / std::sqrt(kNeighbours - 1.0), 0.25 / std::sqrt(kNeighbours - 1.0));
}

TEST(PhotonMap, OnOtherSidesAndInOtherPlanesDoNotCount) {
    std::vector<SurfacePhoton> all = on_square(5000, 0.0f, {0, 0, 1}, 1);
    const double alone = seen(PhotonMap(all), dvec3(0.0), 20).x;
    for (const SurfacePhoton& l : on_square(50000, 0.0f, {0, 0, -1}, 2))  // the floor's other side
        all.push_back(l);
    for (const SurfacePhoton& l : on_square(50000, 0.5f, {0, 0, 1}, 3))  // a table's top above it
        all.push_back(l);
    EXPECT_EQ(seen(PhotonMap(all), dvec3(0.0), 20).x, alone);
}

TEST(PhotonMap, FewOrNone) {
    EXPECT_EQ(seen(PhotonMap({}), dvec3(0.0), 20), Rgb(0.0f));
    EXPECT_EQ(seen(PhotonMap(on_square(1, 0.0f, {0, 0, 1}, 1)), dvec3(0.0), 20), Rgb(0.0f));
    const Rgb two = seen(PhotonMap(on_square(2, 0.0f, {0, 0, 1}, 1)), dvec3(0.0), 20);
    EXPECT_TRUE(std::isfinite(two.x) && two.x > 0.0f);
    // Some on one spot: an infinite density is no density.
    std::vector<SurfacePhoton> spot(30, SurfacePhoton{{0, 0, 0}, {0, 0, 1}, {0, 0, -1}, Rgb(1.0f)});
    EXPECT_EQ(seen(PhotonMap(spot), dvec3(0.0), 20), Rgb(0.0f));
}

}  // namespace
}  // namespace brisance
