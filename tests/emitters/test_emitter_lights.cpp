// Emitters as single lights, those at infinity among them: together they send what Emitters sends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "emitters/emitter_lights.h"
#include "emitters/surroundings.h"
#include "fixtures/estimate.h"
#include "fixtures/sets.h"

namespace brisance {
namespace {

using namespace testing;

constexpr double kFar = 5.0;

// 16 by 8 texels: a dim sky above dark ground, and one bright texel.
Texture sky_picture() {
    Texture picture;
    picture.width = 16;
    picture.height = 8;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) {
            const bool bright = x == 5 && y == 2;
            const float v = bright ? 40.0f : y < 4 ? 0.1f + 0.02f * float(x) : 0.0f;
            picture.floats.insert(picture.floats.end(), {v, 0.7f * v, 0.5f * v, 1.0f});
        }
    return picture;
}

LightSettings environment(float radiance) {
    LightSettings light;
    light.kind = LightKind::Environment;
    light.power = Rgb(radiance);
    return light;
}

void expect_partition(const SkyParts& sky) {
    double solid_angle = 0.0;
    Rng rng(Stream::Points, 3);
    for (const SkyPart& part : sky.parts()) {
        solid_angle += sky.solid_angle(part);
        EXPECT_GT(part.irradiance, 0.0);
        for (int i = 0; i < 50; ++i) {
            const double u = rng.next_double();
            const dvec3 d = sky.sample(part, u, rng.next_double());
            EXPECT_NEAR(glm::length(d), 1.0, 1e-12);
            EXPECT_GE(glm::dot(d, part.toward), std::cos(part.spread) - 1e-12);
        }
    }
    EXPECT_NEAR(solid_angle, 4.0 * kPi64, 1e-9);
}

TEST(SkyParts, CoverTheSphereOnceAndLieInTheirCones) {
    const Environment plain(environment(2.0f), nullptr);
    const Texture picture = sky_picture();
    const Environment pictured(environment(1.0f), &picture);
    for (const std::size_t most : {1, 2, 7, 64, 1000}) {
        const SkyParts even(plain, most), uneven(pictured, most);
        EXPECT_EQ(even.parts().size(), most);
        EXPECT_EQ(uneven.parts().size(), std::min<std::size_t>(most, 16 * 8));
        expect_partition(even);
        expect_partition(uneven);
    }
}

TEST(SkyParts, OfABlackSkyAreNone) {
    EXPECT_TRUE(SkyParts(Environment(environment(0.0f), nullptr), 16).parts().empty());
}

// The bright texel is a part of its own long before the dim ones are.
TEST(SkyParts, AreSmallWhereTheSkyIsBright) {
    const Texture picture = sky_picture();
    const Environment sky(environment(1.0f), &picture);
    const SkyParts parts(sky, 16);
    bool alone = false;
    for (const SkyPart& p : parts.parts())
        alone = alone || (p.left == 5 && p.right == 6 && p.top == 2 && p.bottom == 3);
    EXPECT_TRUE(alone);
}

Scene lit_triangles() {
    Scene scene;
    add_quad(scene, {-1, -1, 3}, {0, 2, 0}, {2, 0, 0}, emitting(Rgb(0.5f, 0.4f, 0.2f)));
    return scene;
}

std::vector<LightSettings> lamps() {
    LightSettings lamp, point_sun, sun;
    lamp.position = {1, 1, 2};
    point_sun.kind = sun.kind = LightKind::Sun;
    point_sun.direction = {0.2, 0.1, -1.0};
    sun.direction = {-0.5, 0.3, -0.6};
    sun.angle_degrees = 4.0;
    return {lamp, point_sun, sun, environment(0.3f)};
}

// Irradiance on a plane that faces up, red: the mean over the sum of all lights, each sampled once, is that of one
// light chosen by Emitters::sample().
TEST(EmitterLights, TogetherSendWhatEmittersSend) {
    const Surroundings set(lit_triangles(), lamps());
    const EmitterLights lights(set.emitters(), kFar);
    EXPECT_EQ(lights.size(), lights.bounds().size());
    EXPECT_EQ(lights.size(), 2u + 1u + 2u + 256u);
    const LitPoint point{{0.2, 0.1, 0.0}, {0, 0, 1}, LitPoint::Kind::Surface};
    const auto received = [&](const std::optional<EmitterSample>& s) {
        return s && s->direction.z > 0.0 ? s->weight.x * s->direction.z : 0.0;
    };
    const Estimate one = estimate_to(
        0.003, 1, [&](const dvec3&, Rng& rng, double* out) { out[0] = received(set.emitters().sample(point, rng)); });
    const Estimate all = estimate_to(0.003, 1, [&](const dvec3&, Rng& rng, double* out) {
        out[0] = 0.0;
        for (std::size_t i = 0; i < lights.size(); ++i)
            out[0] += received(lights.sample(i, point, rng));
    });
    EXPECT_NEAR(all.mean[0], one.mean[0], 4.0 * std::hypot(all.error[0], one.error[0]));
}

// Samples carry the density that other techniques weight rays by BSDF against.
TEST(EmitterLights, HaveTheDensityOfEmitters) {
    const Surroundings set(lit_triangles(), lamps());
    const EmitterLights lights(set.emitters(), kFar);
    const LitPoint point{{0.2, 0.1, 0.0}, {0, 0, 1}, LitPoint::Kind::Surface};
    Rng rng(Stream::Points, 5);
    int deltas = 0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const auto s = lights.sample(i, point, rng);
        ASSERT_TRUE(s) << i;
        if (s->pdf == 0.0) {
            ++deltas;
            continue;
        }
        double expected = 0.0;
        if (std::isinf(s->distance)) {
            expected = set.emitters().pdf_of_background(s->direction);
        } else {
            const auto hit = set.intersector().first_hit({point.position, s->direction});
            ASSERT_TRUE(hit);
            expected = set.emitters().pdf_of_hit(point, *hit, s->direction, s->distance);
        }
        EXPECT_NEAR(s->pdf, expected, 1e-5 * expected) << i;
    }
    EXPECT_EQ(deltas, 2) << "the lamp and the sun that is a point";
}

std::vector<std::uint32_t> leaves_below(const LightTree& tree, std::uint32_t node) {
    if (tree.is_leaf(node))
        return {node};
    std::vector<std::uint32_t> out = leaves_below(tree, tree.left(node));
    const std::vector<std::uint32_t> right = leaves_below(tree, tree.right(node));
    out.insert(out.end(), right.begin(), right.end());
    return out;
}

// Nothing that a light sends to a point exceeds the bounds of any node above it. Lights at infinity and others meet in
// the root alone.
TEST(EmitterLights, AreBoundedByTheNodesAboveThem) {
    const Surroundings set(lit_triangles(), lamps());
    const EmitterLights lights(set.emitters(), kFar);
    const LightTree tree(lights.bounds());
    const dvec3 point(0.4, -0.3, 0.5);
    for (std::uint32_t node = 0; node < tree.node_count(); ++node) {
        const LightsInView all = tree.lights(node).seen_from(point);
        std::size_t far = 0;
        const std::vector<std::uint32_t> leaves = leaves_below(tree, node);
        for (const std::uint32_t leaf : leaves) {
            far += lights.bounds()[tree.light(leaf)].distance > 0.0 ? 1 : 0;
            const LightsInView one = tree.lights(leaf).seen_from(point);
            EXPECT_GE(all.intensity, one.intensity * (1.0 - 1e-9));
            EXPECT_LE(all.nearest2, one.nearest2 * (1.0 + 1e-9));
            EXPECT_GE(all.farthest2, one.farthest2 * (1.0 - 1e-9));
            if (!(all.cos_around > -1.0))
                continue;
            const double between = std::acos(std::clamp(glm::dot(one.direction, all.direction), -1.0, 1.0));
            EXPECT_LE(between + std::acos(one.cos_around), std::acos(all.cos_around) + 1e-6);
        }
        if (node > 0) {
            EXPECT_TRUE(far == 0 || far == leaves.size()) << node;
        }
    }
}

// From one light at infinity comes its irradiance, whatever distance it counts as.
TEST(EmitterLights, AtInfinitySendTheirIrradianceWhateverTheDistance) {
    LightSettings sun;
    sun.kind = LightKind::Sun;
    sun.power = Rgb(2.5f);
    const Surroundings set(Scene{}, {sun});
    for (const double distance : {0.1, 1.0, 1e4}) {
        const EmitterLights lights(set.emitters(), distance);
        const LightCone cone(lights.bounds()[0]);
        const LightsInView view = cone.seen_from({1, 2, 3});
        EXPECT_NEAR(view.intensity / view.nearest2, 2.5, 1e-5);
        EXPECT_NEAR(cone.importance({{1, 2, 3}, {0, 0, 1}, LitPoint::Kind::Surface}), 2.5, 1e-5);
        EXPECT_NEAR(cone.importance({{1, 2, 3}, {0, 0, -1}, LitPoint::Kind::Surface}), 0.0, 1e-9);
    }
}

}  // namespace
}  // namespace brisance
