// Light of lamps and suns at the nodes of smoke that is too thin to weaken it, against sums over all of them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "emitters/surroundings.h"
#include "fixtures/estimate.h"
#include "fixtures/media.h"
#include "medium_lighting/stages/emitter_light.h"

namespace brisance {
namespace {

using namespace testing;

// A cube of 9 nodes along each side, from -0.4 to 0.4.
Medium cube_of_few_nodes(float extinction) {
    Recipe r;
    r.box = cube(-4, 4);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = Rgb(0.5f);
    return make_medium(r);
}

struct Arriving {
    double node;      // largest relative error of a node
    double together;  // relative error of the sum over all nodes
};

// Of the fluence, where `expected` gives it at a point. `seen`: as gather_from_emitters() has it.
template <class Expected>
Arriving errors(const std::vector<LightSettings>& lights, float seen, const Expected& expected) {
    const Medium medium = cube_of_few_nodes(1e-6f);
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    std::vector<LightSettings> placed = lights;
    for (LightSettings& light : placed)
        light.position += scene.origin;
    const Surroundings surroundings(std::move(scene), placed);
    const ExtinctionPyramid pyramid(medium, 1);
    const std::vector<std::uint8_t> needed(medium.lattice.node_count(), 1);
    const Gathered g = gather_from_emitters(surroundings, pyramid, {&needed, std::nullopt}, {0, -5, 0}, seen);
    Arriving out{0.0, 0.0};
    double sum = 0.0, all = 0.0;
    for (std::size_t i = 0; i < medium.lattice.node_count(); ++i) {
        if (!(medium.extinction[i] > 0.0f))
            continue;
        const double truth = expected(dvec3(medium.local_of_node(medium.lattice.node(i))));
        out.node = std::max(out.node, std::abs(g.fluence[i] / truth - 1.0));
        sum += g.fluence[i];
        all += truth;
    }
    out.together = sum / all - 1.0;
    return out;
}

LightSettings sun(const dvec3& direction, float irradiance) {
    LightSettings light;
    light.kind = LightKind::Sun;
    light.direction = direction;
    light.angle_degrees = 0.0;
    light.power = Rgb(irradiance);
    return light;
}

LightSettings lamp(const dvec3& position, float intensity) {
    LightSettings light;
    light.position = position;
    light.power = Rgb(intensity);
    return light;
}

// Three lights that 32 samples do not divide into equally: no node may notice.
TEST(EmitterLight, SunsAndALampAreExactTogether) {
    const dvec3 at(0.3, 0.2, 3.0);
    const Arriving e = errors({sun({0, 0, -1}, 1.0f), sun({1, 0, 0}, 2.5f), lamp(at, 4.0f)}, 1.0f, [&](const dvec3& p) {
        const dvec3 offset = at - p;
        return 3.5 + 4.0 / glm::dot(offset, offset);
    });
    EXPECT_LT(e.node, 1e-4);
}

// Eight samples for three suns: the last of each counts in part.
TEST(EmitterLight, FewSamplesSeeAllOfASun) {
    const Arriving e = errors({sun({0, 0, -1}, 1.0f), sun({1, 0, 0}, 2.5f), sun({0, 1, 0}, 1.0f)}, 0.0f,
                              [](const dvec3&) { return 4.5; });
    EXPECT_LT(e.node, 1e-4);
}

// Three hundred lamps, of which a node asks 32: none may be left out by all nodes. The mean over 729 nodes of samples
// that vary by less than a half has a standard error below 0.4 %; 1.5 % is beyond three of them.
TEST(EmitterLight, ManyLampsAreNotBiased) {
    std::vector<LightSettings> lights;
    for (int i = 0; i < 300; ++i) {
        const double a = 0.1 * i;
        // One lamp in ten is bright.
        lights.push_back(lamp({2.0 * std::cos(a), 2.0 * std::sin(a), -1.5 + 0.01 * i}, i % 10 == 3 ? 20.0f : 1.0f));
    }
    const Arriving e = errors(lights, 1.0f, [&](const dvec3& p) {
        double sum = 0.0;
        for (const LightSettings& light : lights) {
            const dvec3 offset = light.position - p;
            sum += light.power.x / glm::dot(offset, offset);
        }
        return sum;
    });
    EXPECT_LT(std::abs(e.together), 0.015);
}

// All light of a lamp in smoke of 8 mean free paths is scattered or absorbed there: the integral of extinction times
// fluence is its power but for exp(-8). Voxels are 0.4 mean free paths wide, so that light falls to a fraction within
// them. Wherever the lamp is in its voxel, nodes find it within what a cube differs from a ball.
TEST(EmitterLight, ALampInSmokeLosesAllItsLightThere) {
    Recipe r;
    r.box = cube(-22, 22);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), 20.0); };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = 4.0f;
    const Medium medium = make_medium(r);
    const ExtinctionPyramid pyramid(medium, 1);
    const std::vector<std::uint8_t> needed(medium.lattice.node_count(), 1);
    for (const dvec3& offset :
         {dvec3(0.0), dvec3(0.03, 0.01, 0.02), dvec3(0.05, 0.0, 0.0), dvec3(0.049, 0.05, 0.051)}) {
        Scene scene;
        scene.origin = medium.world_of_local(vec3(0.0f));
        const LightSettings inside = lamp(scene.origin + offset, 3.0f);
        const Surroundings set(std::move(scene), {inside});
        const Gathered g = gather_from_emitters(set, pyramid, {&needed, std::nullopt}, {0, -5, 0}, 1.0f);
        double sum = 0.0;
        for (std::size_t i = 0; i < medium.lattice.node_count(); ++i) {
            sum += double(medium.extinction[i]) * g.fluence[i] * double(medium.voxel_volume);
            EXPECT_TRUE(std::isfinite(g.fluence[i]));
        }
        const double power = 4.0 * kPi64 * 3.0;
        std::printf("%.3f of the power\n", sum / power);
        EXPECT_NEAR(sum, power, 0.05 * power);
    }
}

}  // namespace
}  // namespace brisance
