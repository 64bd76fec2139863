// Ten million lights: a burning block of 216^3 voxels.
#include <cmath>

#include "stability/closed_forms.h"
#include "stability/scenes.h"

namespace brisance::stability {

namespace {

constexpr int kSide = 216;

// Fire without smoke, and in its middle a wisp of smoke, a cube of 6 voxels, that scatters what arrives.
media::Recipe block() {
    media::Recipe r;
    r.box = media::cube(-kSide / 2, kSide / 2 - 1);
    r.world_from_index = media::cubic(0.01);
    r.density = [](const ivec3& n) {
        return glm::all(glm::greaterThanEqual(n, ivec3(-3))) && glm::all(glm::lessThan(n, ivec3(3))) ? 1.0f : 0.0f;
    };
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = media::black_smoke();
    r.settings.smoke.extinction_per_metre = 0.01f;
    r.settings.smoke.albedo = Rgb(1.0f);
    r.settings.fire.convention = EmissionConvention::Direct;
    return r;
}

// Mean over the sphere of the distance from a cube's centre to its surface, for side 1: fluence at the centre of a
// uniformly emitting cube over 4 pi.
constexpr double kMeanDistance = 7.674134 / (4.0 * kExactPi);

Case scattered() {
    Case c;
    c.name = "lights/1e7-scattered";
    c.truth = "fluence 7.674 j h at the middle of a burning cube";
    c.tolerance = {0.02, 0.01, "the hierarchy's own error; the wisp's optical depth is 6e-4"};
    c.scene = [] {
        Scene scene = scene_of(block(), camera_at({0.0, -1000.0, 0.0}, dvec3(-0.005), 0.01, 4), 64);
        scene.shot.scattering.bounces = 1;
        return scene;
    };
    c.measure = [](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render& render) {
        const double depth = 0.01 * 6 * 0.01, length = kMeanDistance * kSide * 0.01;
        const double truth = one_minus_transmittance(depth) * length;
        return every_pixel_is(Rgb(static_cast<float>(truth)), "MV")(scene, frame, method, render);
    };
    return c;
}

}  // namespace

std::vector<Case> light_cases() {
    return {scattered()};
}

}  // namespace brisance::stability
