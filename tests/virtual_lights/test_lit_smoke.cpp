// Paths between surfaces that see smoke which is lit already.
#include <gtest/gtest.h>

#include <cmath>

#include "room.h"

namespace brisance {
namespace {

using namespace testing;

// Opaque smoke, alike everywhere.
class Fog : public LitSmoke {
public:
    Light along(const Ray&, double, Rng&) const override {
        ++seen;
        return {Rgb(3.0f, 2.0f, 1.0f), Rgb(2.0f), 0.0f};
    }
    mutable int seen = 0;
};

constexpr float kAlbedo = 0.6f;

// A matt panel is within these walls. The lamp is there so that anything shines at all.
SceneSettings hall(const QuickMaterial& walls) {
    SceneSettings scene;
    add_walls(scene, dvec3(-1.0), dvec3(1.0), walls);
    LightSettings lamp;
    lamp.position = dvec3(0.0, 0.5, 0.0);
    lamp.power = Rgb(1e-9f);
    scene.lights.push_back(lamp);
    return scene;
}

SceneSettings hall_of_mirrors() {
    QuickMaterial mirror = lambert(Rgb(1.0f));
    mirror.metallic = 1.0f;
    mirror.roughness = 0.0f;
    return hall(mirror);
}

VirtualLightSettings none() {
    VirtualLightSettings s;
    s.photons = 0;
    return s;
}

struct Panel {
    SurfacePoint point;
    dvec3 arriving{0.0, -1.0, 0.0};
};

Panel panel() {
    Panel p;
    p.point.position = dvec3(0.0, -0.2, 0.0);
    p.point.geometric_normal = dvec3(0.0, 1.0, 0.0);
    p.point.frame = frame_around(dvec3(0.0, 1.0, 0.0));
    p.point.material.base_colour = Rgb(kAlbedo);
    p.point.material.specular = 0.0f;
    p.point.material.metallic = 0.0f;
    p.point.material.roughness = 1.0f;
    return p;
}

// Every path goes from the panel to a mirror, which sees fog: the panel reflects the fog's light.
TEST(LitSmoke, IsWhatASecondSurfaceSees) {
    const Room room(hall_of_mirrors());
    const VirtualLights lights = room.lights(none());
    const Panel p = panel();
    const PathVertex vertex(p.point, p.arriving);
    const Fog fog;
    Rng rng(Stream::Path, 5);
    for (int i = 0; i < 100; ++i) {
        const Rgb seen = lights.shade(vertex, rng, {.smoke = &fog});
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(seen[c], kAlbedo * (5.0f - float(c)), 0.01f);
    }
    EXPECT_EQ(fog.seen, 100);
}

// Of 4000 paths a quarter walks: 1000 with a standard deviation of 27.
TEST(LitSmoke, IsLeftToWalksInPart) {
    const Room room(hall_of_mirrors());
    const VirtualLights lights = room.lights(none());
    const Panel p = panel();
    const PathVertex vertex(p.point, p.arriving);
    const Fog fog;
    Rng rng(Stream::Path, 6);
    for (int i = 0; i < 4000; ++i)
        lights.shade(vertex, rng, {.smoke = &fog, .walks = 0.25f});
    EXPECT_NEAR(fog.seen, 3000, 5 * 27);
    const int before = fog.seen;
    for (int i = 0; i < 100; ++i)
        lights.shade(vertex, rng, {.smoke = &fog, .walks = 1.0f});
    EXPECT_EQ(fog.seen, before);
}

// The first ray is the receiver's, which others have lit by the smoke; black walls send no second one.
TEST(LitSmoke, OfTheReceiverItselfIsNotAskedFor) {
    const Room room(hall(lambert(Rgb(0.0f))));
    const VirtualLights lights = room.lights(none());
    const Panel p = panel();
    const Fog fog;
    Rng rng(Stream::Path, 7);
    for (int i = 0; i < 100; ++i)
        EXPECT_LT(lights.shade(PathVertex(p.point, p.arriving), rng, {.smoke = &fog}).y, 1e-6f);
    EXPECT_EQ(fog.seen, 0);
}

// A ball that shines alike everywhere and hides nothing, beside the middle of a burning one.
class Ball : public LitSmoke {
public:
    explicit Ball(const Room& room) : centre_(kCentre - room.origin) {}
    Light along(const Ray& ray, double end, Rng&) const override {
        const dvec3 offset = centre_ - ray.origin;
        const double middle = glm::dot(offset, ray.direction), across2 = glm::dot(offset, offset) - middle * middle;
        const bool met = middle > 0.0 && middle < end && across2 < kRadius * kRadius;
        return {Rgb(0.0f), Rgb(met ? 1.0f : 0.0f), 1.0f};
    }

    static constexpr dvec3 kFire{0.0, 0.4, 0.0}, kCentre{0.2, 0.4, 0.0};  // [m]
    static constexpr double kRadius = 0.1;

private:
    dvec3 centre_;  // local [m]
};

// Lines toward the fire and the paths' own segments find the same light, and are weighted against each other. The panel
// is lit by walls that see the ball, which fills a four-hundredth of their sphere: few segments meet it.
TEST(LitSmoke, IsFoundByLinesTowardTheFireToo) {
    const Room room(hall(lambert(Rgb(0.5f))), smoke_ball(Ball::kFire, 0.5f, Rgb(0.5f), 1.0f));
    const Ball ball(room);
    Panel p = panel();
    p.point.position -= room.origin;
    const PathVertex vertex(p.point, p.arriving);
    const auto seen = [&](bool lines) {
        TracingSettings tracing;
        tracing.light_sampling = lines;
        const DirectLight direct(room.medium, tracing, &room.surroundings);
        const VirtualLights lights(direct, room.camera(), none());
        return estimate(2, lines ? 64 : 512, [&](const dvec3&, Rng& rng, double* out) {
            out[0] = lights.shade(vertex, rng, {.smoke = &ball}).y;
            out[1] = out[0] * out[0];
        });
    };
    const Estimate with = seen(true), without = seen(false);
    EXPECT_GT(without.mean[0], 0.0);
    EXPECT_NEAR(with.mean[0], without.mean[0], kSigmas * std::hypot(with.error[0], without.error[0]));
    EXPECT_LT(with.mean[1], 0.3 * without.mean[1]) << "second moments of one path";
}

}  // namespace
}  // namespace brisance
