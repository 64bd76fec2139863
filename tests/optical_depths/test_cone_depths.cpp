// Depths along cones: rays where they have no width, and the same mean however wide they are.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/rng.h"
#include "fixtures/media.h"
#include "optical_depths/cone_depths.h"

namespace brisance {
namespace {

using namespace testing;

// Lumps of smoke, eight nodes wide and smooth from node to node, in a cube on a sheared and turned lattice.
Medium lumps() {
    Recipe r;
    r.box = cube(-40, 40);
    r.world_from_index = transform(some_linear_map(), dvec3(0.0));
    r.density = [](const ivec3& n) {
        const vec3 wave = glm::cos(vec3(n) * 0.8f);
        return 1.0f + 0.9f * wave.x * wave.y * wave.z;
    };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = 0.3f;
    return make_medium(r);
}

vec3 at_index(const Medium& medium, const vec3& index) {
    return medium.local_from_index * (index - vec3(medium.reference_node));
}

vec3 random_index(Rng& rng, float low, float high) {
    const float x = rng.next(), y = rng.next(), z = rng.next();
    return low + (high - low) * vec3(x, y, z);
}

std::array<ConeDepths::Segment, ConeDepths::kCones> random_segments(const Medium& medium, Rng& rng) {
    std::array<ConeDepths::Segment, ConeDepths::kCones> segments;
    for (auto& s : segments)
        s = {at_index(medium, random_index(rng, -50.0f, 50.0f)), at_index(medium, random_index(rng, -90.0f, 90.0f))};
    return segments;
}

TEST(ConeDepths, WithoutWidthAreTheDepthsOfRays) {
    const Medium medium = lumps();
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const ConeDepths cones(pyramid);
    Rng rng(Stream::EscapeRay, 1);
    for (int i = 0; i < 50; ++i) {
        const auto segments = random_segments(medium, rng);
        std::array<float, ConeDepths::kCones> depth{};
        cones.along(segments, ConeDepths::kCones, 0.0f, depth);
        for (int k = 0; k < ConeDepths::kCones; ++k) {
            const float ray = pyramid.optical_depth(segments[k].from, segments[k].to);
            EXPECT_NEAR(depth[k], ray, 0.01f * ray + 0.02f) << i << ' ' << k;
        }
    }
}

// Coarser levels keep the integral of the extinction, so the mean over many directions does not depend on the width. A
// cone as wide as the smoke loses what they spread past its borders.
TEST(ConeDepths, OfAnyWidthHaveTheSameMean) {
    const Medium medium = lumps();
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const ConeDepths cones(pyramid);
    for (const float widening : {0.05f, 0.1f, 0.2f}) {
        Rng rng(Stream::EscapeRay, 2);
        double rays = 0.0, wide = 0.0;
        for (int i = 0; i < 200; ++i) {
            const auto segments = random_segments(medium, rng);
            std::array<float, ConeDepths::kCones> depth{};
            cones.along(segments, ConeDepths::kCones, 0.0f, depth);
            for (const float d : depth)
                rays += d;
            cones.along(segments, ConeDepths::kCones, widening, depth);
            for (const float d : depth)
                wide += d;
        }
        EXPECT_NEAR(wide / rays, 1.0, 0.01) << widening;
    }
}

TEST(ConeDepths, BesideTheMediumAreZero) {
    const Medium medium = lumps();
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const ConeDepths cones(pyramid);
    std::array<ConeDepths::Segment, ConeDepths::kCones> segments;
    segments[0] = {at_index(medium, vec3(200, 0, 0)), at_index(medium, vec3(300, 0, 0))};   // behind it
    segments[1] = {at_index(medium, vec3(200, 0, 0)), at_index(medium, vec3(200, 90, 0))};  // past it
    segments[2] = {at_index(medium, vec3(0.0f)), at_index(medium, vec3(0.0f))};             // of no length
    segments[3] = {at_index(medium, vec3(0.0f)), at_index(medium, vec3(0, 0, 1e5f))};       // out of it, and far away
    std::array<float, ConeDepths::kCones> depth;
    depth.fill(-1.0f);
    cones.along(segments, 4, 0.1f, depth);
    EXPECT_EQ(depth[0], 0.0f);
    EXPECT_EQ(depth[1], 0.0f);
    EXPECT_EQ(depth[2], 0.0f);
    const float ray = pyramid.optical_depth(segments[3].from, at_index(medium, vec3(0, 0, 100)));
    EXPECT_NEAR(depth[3], ray, 0.03f * ray);
    EXPECT_EQ(depth[4], -1.0f);  // not asked for
}

}  // namespace
}  // namespace brisance
