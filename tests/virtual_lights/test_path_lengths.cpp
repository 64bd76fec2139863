// How many vertices a path has before virtual lights end it.
#include <gtest/gtest.h>

#include "room.h"

namespace brisance {
namespace {

using namespace testing;

// All is lit by a lamp without a size, and every ray meets a surface that holds light.
SceneSettings white_room() {
    SceneSettings scene;
    add_walls(scene, dvec3(-1.0), dvec3(1.0), lambert(Rgb(0.7f)));
    LightSettings lamp;
    lamp.position = dvec3(0.0, 0.5, 0.0);
    lamp.power = Rgb(10.0f);
    scene.lights.push_back(lamp);
    return scene;
}

int vertices_along(const Room& room, const VirtualLights& lights, const Ray& ray, std::uint64_t number) {
    const RaySegment segment = room.direct.segment_along(ray);
    Rng rng(Stream::Path, number);
    int vertices = 0;
    lights.shade(PathVertex(*segment.point, ray.direction), rng, {.vertices = &vertices});
    return vertices;
}

double mean_vertices(const Room& room, const VirtualLights& lights, double x, double y) {
    constexpr int kPaths = 2000;
    double sum = 0.0;
    for (int i = 0; i < kPaths; ++i)
        sum += vertices_along(room, lights, room.ray(x, y), static_cast<std::uint64_t>(i));
    return sum / kPaths;
}

VirtualLightSettings settings(bool extension) {
    VirtualLightSettings s = few_lights();
    s.count = 2000;
    s.path_extension = extension;
    // No gaps between the lights: paths would continue there.
    s.radius = LightRadius::Uniform;
    s.radius_factor = 2.5;
    return s;
}

TEST(PathLengths, WithoutExtensionEveryPathHasOneVertex) {
    const Room room(white_room());
    const VirtualLights lights = room.lights(settings(false));
    // Not through the middles of pixels: along diagonals they meet the room's edges, where two walls are one.
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            ASSERT_EQ(vertices_along(room, lights, room.ray(x + 0.51, y + 0.38), std::uint64_t(64 * y + x)), 1)
                << x << " " << y;
}

TEST(PathLengths, WithExtensionTheyAreLongerInCorners) {
    const Room room(white_room());
    const VirtualLights lights = room.lights(settings(true));
    const double middle = mean_vertices(room, lights, 32.0, 32.0);
    // The back wall is seen from 1.98 m: its corner 1 m to the left and below is 20.2 pixels away.
    const double corner = mean_vertices(room, lights, 32.0 - 19.8, 32.0 + 19.8);
    EXPECT_GE(middle, 1.0);
    EXPECT_LT(middle, 1.5);
    EXPECT_GT(corner, middle + 0.5);
}

TEST(PathLengths, CountingChangesNothing) {
    const Room room(white_room());
    const VirtualLights lights = room.lights(settings(true));
    const Ray ray = room.ray(12.0, 50.0);
    const RaySegment segment = room.direct.segment_along(ray);
    for (std::uint64_t i = 0; i < 20; ++i) {
        Rng counted(Stream::Path, i), plain(Stream::Path, i);
        int vertices = 0;
        const PathVertex vertex(*segment.point, ray.direction);
        EXPECT_EQ(lights.shade(vertex, counted, {.vertices = &vertices}), lights.shade(vertex, plain));
    }
}

}  // namespace
}  // namespace brisance
