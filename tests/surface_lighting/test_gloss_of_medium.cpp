// Light of smoke that rough surfaces reflect: found by their lobes and by lines toward the fire.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/media.h"
#include "surface_lighting/gloss_of_medium.h"

namespace brisance {
namespace {

using namespace testing;

// Thin smoke with a small fire in its middle.
Medium small_fire() {
    Recipe r;
    r.box = cube(-12, 12);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), 10.0); };
    r.flame = [](const ivec3& n) { return ball(n, dvec3(0.0), 1.5); };
    r.settings.smoke.extinction_per_metre = 0.5f;
    r.settings.smoke.albedo = Rgb(0.8f);
    r.settings.fire.convention = EmissionConvention::Direct;
    return make_medium(r);
}

// A floor of rough metal well below it.
SurfacePoint rough_metal() {
    SurfacePoint p;
    p.position = {3.0, 0.5, -4.0};
    p.geometric_normal = {0.0, 0.0, 1.0};
    p.frame = frame_around(p.geometric_normal);
    p.material.base_colour = Rgb(0.9f);
    p.material.metallic = 1.0f;
    p.material.roughness = 0.7f;
    return p;
}

struct Moments {
    double mean = 0.0, deviation = 0.0;  // of one estimate
};

// Of SM, with the smoke's light within a few voxels of the fire.
Moments reflected(const Medium& medium, bool lines, int count) {
    NodeSources sources;
    sources.single.resize(medium.lattice.node_count());
    for (std::size_t i = 0; i < sources.single.size(); ++i)
        sources.single[i] = Rgb(1.0f / (0.05f + glm::dot(medium.local_of_node(medium.lattice.node(i)),
                                                         medium.local_of_node(medium.lattice.node(i)))));
    const SourceField field(medium, sources);
    TracingSettings settings;
    settings.light_sampling = lines;
    const DirectLight direct(medium, settings, nullptr);
    const MediumAlongRay along(field, direct, 1, nullptr, 0.0f);
    const GlossOfMedium gloss(direct, along, false);
    const SurfacePoint point = rough_metal();
    const dvec3 toward_viewer = glm::normalize(dvec3(0.5, -0.3, 0.6));
    const GlossyLobes lobes(point, toward_viewer, 0);
    double sum = 0.0, squares = 0.0;
    for (int i = 0; i < count; ++i) {
        Rng rng(Stream::Surface, i), ray_rng(Stream::RayLightSurface, i);
        CellSum light;
        const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
        gloss.reflect(point, toward_viewer, lobes, {x, y, z}, ray_rng, light);
        const double value = luminance(light.at(Cell::SM));
        sum += value;
        squares += value * value;
    }
    const double mean = sum / count;
    return {mean, std::sqrt(squares / count - mean * mean)};
}

TEST(GlossOfMedium, LinesTowardTheFireChangeTheNoiseOfSmokeAndNotItsMean) {
    const Medium medium = small_fire();
    constexpr int kCount = 40000;
    const Moments with = reflected(medium, true, kCount), without = reflected(medium, false, kCount);
    ASSERT_GT(without.mean, 0.0);
    // Four standard errors.
    EXPECT_NEAR(with.mean, without.mean, 4.0 * std::hypot(with.deviation, without.deviation) / std::sqrt(kCount));
    EXPECT_LT(with.deviation, 0.5 * without.deviation);
}

}  // namespace
}  // namespace brisance
