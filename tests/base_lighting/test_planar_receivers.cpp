// Light interpolated on planes, against the light itself.
#include "base_lighting/planar_receivers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fixtures/media.h"

namespace brisance {
namespace {

using namespace testing;

// A ball of radius 1 m around the origin, of voxels of 0.125 m.
Medium small_ball() {
    return make_medium(glowing_ball(8, 2.0f));
}

// A light of 1 W/sr at a point, in fire and half of it in smoke; only left of `edge`, beyond which it is hidden.
struct PointLight {
    vec3 at;
    float edge = std::numeric_limits<float>::infinity();
    mutable std::size_t gathered = 0;

    Rgb on(const SurfaceReceiver& r) const {
        const vec3 offset = at - r.local;
        const float square = glm::dot(offset, offset);
        const float cosine = std::max(0.0f, glm::dot(offset, r.normal)) / std::sqrt(square);
        return r.local.x < edge ? Rgb(cosine / square) * Rgb(1.0f, 0.5f, 0.2f) : Rgb(0.0f);
    }
    void gather(std::vector<SurfaceReceiver>& receivers) const {
        gathered += receivers.size();
        for (SurfaceReceiver& r : receivers) {
            r.fire[0] = on(r);
            r.smoke[1] = 0.5f * on(r);
        }
    }
    GatherReceivers gatherer() const {
        return [this](std::vector<SurfaceReceiver>& receivers) { gather(receivers); };
    }
};

// A square of `n` by `n` receivers, `apart` metres from each other.
std::vector<SurfaceReceiver> square(int n, float apart, const vec3& corner, const vec3& u, const vec3& v) {
    std::vector<SurfaceReceiver> receivers;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
            receivers.push_back({corner + (float(i) * u + float(j) * v) * apart, glm::normalize(glm::cross(u, v))});
    return receivers;
}

double worst_error(const PointLight& light, const std::vector<SurfaceReceiver>& receivers) {
    double worst = 0.0;
    for (const SurfaceReceiver& r : receivers) {
        const double fire = luminance(light.on(r));
        worst = std::max(
            {worst, std::abs(luminance(r.fire[0]) / fire - 1.0), std::abs(2.0 * luminance(r.smoke[1]) / fire - 1.0)});
    }
    return worst;
}

TEST(PlanarReceivers, AFloorIsLitByFewPointsAsByAll) {
    const Medium medium = small_ball();
    const PointLight light{{0.3f, -0.2f, 0.1f}};
    std::vector<SurfaceReceiver> floor = square(300, 0.03f, {-4.5f, -4.5f, -2.5f}, {1, 0, 0}, {0, 1, 0});
    PlanarLight(medium).light(floor, light.gatherer());
    EXPECT_LT(worst_error(light, floor), 0.02);
    EXPECT_LT(light.gathered, floor.size() / 20);
}

TEST(PlanarReceivers, AWallAcrossTheAxesToo) {
    const Medium medium = small_ball();
    const PointLight light{{0.0f, 0.0f, 0.0f}};
    const vec3 u = glm::normalize(vec3(1.0f, 0.7f, -0.3f)), v = glm::normalize(glm::cross(u, vec3(0.2f, 1.0f, 0.4f)));
    const vec3 normal = glm::normalize(glm::cross(u, v));
    std::vector<SurfaceReceiver> wall = square(300, 0.02f, -3.0f * (u + v) - 2.0f * normal, u, v);
    PlanarLight(medium).light(wall, light.gatherer());
    EXPECT_LT(worst_error(light, wall), 0.02);
    EXPECT_LT(light.gathered, wall.size() / 20);
}

// Between cells as within them: neighbours on a line across the light differ by no more than the light does.
TEST(PlanarReceivers, HaveNoSeams) {
    const Medium medium = small_ball();
    const PointLight light{{0.0f, 0.0f, 0.2f}};
    std::vector<SurfaceReceiver> line;
    for (int row = 0; row < 40; ++row)
        for (int i = 0; i < 2000; ++i)
            line.push_back({{-3.0f + 0.003f * float(i), 0.01f * float(row), -2.0f}, {0, 0, 1}});
    PlanarLight(medium).light(line, light.gatherer());
    for (std::size_t i = 1; i < 2000; ++i)
        EXPECT_NEAR(line[i].fire[0].x / light.on(line[i]).x, line[i - 1].fire[0].x / light.on(line[i - 1]).x, 0.005)
            << line[i].local.x;
}

// Curved surfaces have no plane to share.
TEST(PlanarReceivers, OnABallAreGatheredThemselves) {
    const Medium medium = small_ball();
    const PointLight light{{0.0f, 0.0f, 3.0f}};
    std::vector<SurfaceReceiver> dome;
    for (int i = 0; i < 500; ++i) {
        const float z = 0.5f + 0.5f * float(i) / 500.0f, azimuth = 2.4f * float(i), r = std::sqrt(1.0f - z * z);
        const vec3 normal(r * std::cos(azimuth), r * std::sin(azimuth), z);
        dome.push_back({normal, normal});
    }
    PlanarLight(medium).light(dome, light.gatherer());
    EXPECT_EQ(worst_error(light, dome), 0.0);
}

// An edge of the light is not smeared farther than a voxel.
TEST(PlanarReceivers, KeepAnEdgeOfTheLight) {
    const Medium medium = small_ball();
    const PointLight light{{0.0f, 0.0f, 0.5f}, 0.777f};
    std::vector<SurfaceReceiver> floor = square(400, 0.01f, {-2.0f, -2.0f, -1.5f}, {1, 0, 0}, {0, 1, 0});
    PlanarLight(medium).light(floor, light.gatherer());
    for (const SurfaceReceiver& r : floor) {
        if (std::abs(r.local.x - light.edge) < 0.125f)
            continue;
        EXPECT_NEAR(r.fire[0].x, light.on(r).x, 0.03f * light.on(r).x) << r.local.x;
    }
}

// The next frame of a growing cloud may have its local origin elsewhere; a floor that did not change must not flicker.
TEST(PlanarReceivers, AreTheSameWhereverTheLocalOriginLies) {
    const Medium medium = small_ball();
    Medium moved = medium;
    moved.reference_node += ivec3(24, -40, 16);
    const vec3 offset = medium.local_from_index * vec3(moved.reference_node - medium.reference_node);
    const PointLight light{{0.3f, -0.2f, 0.1f}}, moved_light{light.at - offset};
    std::vector<SurfaceReceiver> floor = square(200, 0.04f, {-4.0f, -4.0f, -2.5f}, {1, 0, 0}, {0, 1, 0});
    std::vector<SurfaceReceiver> moved_floor = floor;
    for (SurfaceReceiver& r : moved_floor)
        r.local -= offset;
    PlanarLight(medium).light(floor, light.gatherer());
    PlanarLight(moved).light(moved_floor, moved_light.gatherer());
    for (std::size_t i = 0; i < floor.size(); ++i)
        EXPECT_NEAR(moved_floor[i].fire[0].x, floor[i].fire[0].x, 1e-4f * floor[i].fire[0].x);
}

TEST(PlanarReceivers, FarAwayOrWithoutAPlaceAreGatheredThemselves) {
    const Medium medium = small_ball();
    const PointLight light{{0.0f, 0.0f, 0.5f}};
    std::vector<SurfaceReceiver> odd(12, {{1e30f, 0.0f, 0.0f}, {0, 0, 1}});
    odd.insert(odd.end(), 12, {{std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f}, {0, 0, 1}});
    PlanarLight(medium).light(odd, light.gatherer());
    EXPECT_EQ(light.gathered, odd.size());
}

// Rows of a picture and what mirrors show from them come in turns, on planes of their own.
TEST(PlanarReceivers, KeepWhatOtherCallsDoNotMeet) {
    const Medium medium = small_ball();
    const PointLight light{{0.0f, 0.0f, 0.5f}};
    const std::vector<SurfaceReceiver> floor = square(100, 0.06f, {-3.0f, -3.0f, -2.0f}, {1, 0, 0}, {0, 1, 0}),
                                       wall = square(100, 0.06f, {-3.0f, 2.5f, -2.0f}, {1, 0, 0}, {0, 0, 1});
    PlanarLight planes(medium);
    std::vector<SurfaceReceiver> once = floor, between = wall, again = floor;
    planes.light(once, light.gatherer());
    planes.light(between, light.gatherer());
    const std::size_t before = light.gathered;
    planes.light(again, light.gatherer());
    EXPECT_EQ(light.gathered, before);
    for (std::size_t i = 0; i < floor.size(); ++i)
        EXPECT_EQ(again[i].fire[0], once[i].fire[0]);
}

TEST(PlanarReceivers, NoneCostNothing) {
    const Medium medium = small_ball();
    std::vector<SurfaceReceiver> none;
    const PointLight light{{0.0f, 0.0f, 0.5f}};
    PlanarLight(medium).light(none, light.gatherer());
    EXPECT_EQ(light.gathered, 0u);
}

}  // namespace
}  // namespace brisance
