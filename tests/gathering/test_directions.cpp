// Directions of arriving light, for anisotropic phase functions.
#include <gtest/gtest.h>

#include "gather_fixture.h"
#include "medium/phase.h"
#include "medium/sh.h"

namespace brisance {
namespace {

using namespace testing;

const ivec3 kLamp(3, -2, 5);

Recipe thin_block() {
    Recipe r;
    r.box = cube(-14, 14);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = 1e-20f;
    return r;
}

const vec3 kEye(0.37f, -0.21f, 0.53f);  // among the nodes: they see it in all directions

TEST(Directions, IsotropicScatteringSendsTheSameEverywhere) {
    Recipe r = thin_block();
    r.settings.smoke.extinction_per_metre = 0.8f;
    r.flame = [](const ivec3& n) { return noise(n, 3); };
    const Lit lit(make_medium(r));
    const Gathered g = at_all_nodes(lit, lighting(ShadowMethod::Maps, 1.0f), kEye);
    ASSERT_EQ(g.scattered.size(), g.fluence.size());
    for (std::size_t i = 0; i < g.fluence.size(); ++i)
        ASSERT_NEAR(4.0 * kPiExact * g.scattered[i] / g.fluence[i], 1.0, 1e-4);
}

TEST(Directions, OneLightScattersByItsAngle) {
    const auto lit = single_light(make_medium(thin_block()), kLamp);
    for (const float g : {0.6f, -0.4f, 0.9f}) {
        const Gathered got = at_all_nodes(*lit, lighting(ShadowMethod::None), kEye, false, g);
        for (std::size_t i = 0; i < lit->intensity.size(); ++i) {
            const vec3 p = lit->medium.local_of_node(node_at(lit->medium, i));
            const vec3 offset = p - lit->medium.local_of_node(kLamp);
            if (offset == vec3(0.0f))
                continue;
            const float phase = henyey_greenstein(glm::dot(glm::normalize(offset), direction_toward(kEye, p)), g);
            ASSERT_NEAR(got.scattered[i] / got.fluence[i] / phase, 1.0f, 2e-3f) << "g = " << g;
        }
    }
}

TEST(Directions, MomentsOfOneLightAreItsFluenceTimesTheHarmonics) {
    const auto lit = single_light(make_medium(thin_block()), kLamp);
    const Gathered got = at_all_nodes(*lit, lighting(ShadowMethod::None), std::nullopt, true);
    const std::size_t nodes = lit->medium.lattice.node_count();
    for (std::size_t i = 0; i < nodes; ++i) {
        const vec3 offset = lit->medium.local_of_node(node_at(lit->medium, i)) - lit->medium.local_of_node(kLamp);
        if (offset == vec3(0.0f))
            continue;
        const auto basis = sh_basis(glm::normalize(offset));
        for (int m = 0; m < kShMoments; ++m)
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(got.moments[(3 * m + c) * nodes + i] / got.fluence[c * nodes + i], basis[m], 2e-4f);
    }
}

TEST(Directions, HarmonicsAreOrthonormal) {
    double product[kShMoments][kShMoments] = {};
    const int n = 64;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < 2 * n; ++j) {
            const double theta = kPiExact * (i + 0.5) / n, angle = kPiExact * (j + 0.5) / n;
            const auto basis =
                sh_basis(vec3(std::sin(theta) * std::cos(angle), std::sin(theta) * std::sin(angle), std::cos(theta)));
            const double area = std::sin(theta) * kPiExact / n * kPiExact / n;
            for (int a = 0; a < kShMoments; ++a)
                for (int b = 0; b < kShMoments; ++b)
                    product[a][b] += area * basis[a] * basis[b];
        }
    for (int a = 0; a < kShMoments; ++a)
        for (int b = 0; b < kShMoments; ++b)
            EXPECT_NEAR(product[a][b], a == b ? 1.0 : 0.0, 2e-3);
}

// The addition theorem with the scattering's own weights rebuilds a phase function of degree two.
TEST(Directions, PhaseFactorsAreTheMomentsOfHenyeyAndGreenstein) {
    const float g = 0.5f;
    double degree[2] = {0.0, 0.0};
    const int n = 20000;
    for (int i = 0; i < n; ++i) {
        const double c = -1.0 + 2.0 * (i + 0.5) / n;
        const double p = henyey_greenstein(float(c), g) * 2.0 * kPiExact * 2.0 / n;
        degree[0] += p * c;
        degree[1] += p * (1.5 * c * c - 0.5);
    }
    EXPECT_NEAR(degree[0], sh_phase_factor(0, g), 1e-4);
    EXPECT_NEAR(degree[1], sh_phase_factor(7, g), 1e-4);
}

TEST(Directions, ADirectionalLightShinesAsItsHarmonicsSay) {
    const auto lit = single_light(make_medium(thin_block()), kLamp);
    std::vector<float> directional(lit->intensity.size() * 24, 0.0f);
    const std::size_t lamp = lit->medium.lattice.find_node(kLamp);
    for (int m = 0; m < kShMoments; ++m)
        for (int c = 0; c < 3; ++c)
            directional[lamp * 24 + 3 * m + c] = 0.1f * float(m - 3) + 0.05f * float(c);
    set_intensity(lit->grid, lit->medium.lattice, lit->intensity, &directional);
    LightField field = field_of(*lit, lighting(ShadowMethod::None));
    field.directional = &directional;
    const std::vector<std::uint8_t> needed(lit->intensity.size(), 1);
    std::vector<LevelCost> costs;
    Progress silent;
    const Gathered got = gather_at_nodes(field, {&needed, std::nullopt, false, 0.0f}, costs, silent);
    const std::size_t nodes = lit->intensity.size();
    for (std::size_t i = 0; i < nodes; ++i) {
        const vec3 offset = lit->medium.local_of_node(node_at(lit->medium, i)) - lit->medium.local_of_node(kLamp);
        if (offset == vec3(0.0f))
            continue;
        const auto basis = sh_basis(glm::normalize(offset));
        for (int c = 0; c < 3; ++c) {
            float expected = 1.0f;
            for (int m = 0; m < kShMoments; ++m)
                expected += directional[lamp * 24 + 3 * m + c] * basis[m];
            ASSERT_NEAR(got.fluence[c * nodes + i] * glm::dot(offset, offset), expected, 5e-4f);
        }
    }
}

}  // namespace
}  // namespace brisance
