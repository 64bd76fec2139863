// The lattice's own near field: lines through voxels, and the light of a node on itself.
#include <gtest/gtest.h>

#include <random>

#include "fixtures/plane_occluder.h"
#include "gathering/gather_fixture.h"
#include "near_field/near_field.h"

namespace brisance {
namespace {

using namespace testing;

// What a punctured cubic lattice of 1/d^2 lacks of its integral, times h^2.
constexpr double kCubicLattice = 8.9136;
// A third of what one of 1/d lacks, times h.
constexpr double kCubicFlux = 2.8373 / 3.0;

TEST(NearField, SelfLightWithoutExtinctionIsTheLatticeConstant) {
    for (const float h : {1.0f, 0.01f, 30.0f}) {
        const NearField field(mat3(h), 2.0f * h, true);
        EXPECT_NEAR(field.self_kernels(0.0f).light * h * h, kCubicLattice, 0.01);
        EXPECT_NEAR(field.self_kernels(1e-7f / h).light * h * h, kCubicLattice, 0.01);
        EXPECT_NEAR(field.self_kernels(0.0f).flux * h, kCubicFlux, 0.005);
    }
}

TEST(NearField, SelfLightInDenseSmokeIsAllThatIsEmitted) {
    for (const float h : {1.0f, 0.05f}) {
        const NearField field(mat3(h), 2.0f * h, true);
        for (const double tau : {30.0, 1e2, 1e4, 1e6, 1e9}) {
            const double all = 4.0 * kPiExact / (tau / h * h * h * h);
            EXPECT_NEAR(field.self_kernels(float(tau / h)).light / all, 1.0, 2e-3) << "optical thickness " << tau;
        }
    }
}

// kappa(s) + sum over o != 0 of exp(-s |o|) / |o|^2 = 4 pi / (s V): absorbed equals emitted, at every thickness.
TEST(NearField, SelfLightClosesTheBalanceOfUniformSmoke) {
    const NearField field(mat3(1.0f), 2.0f, true);
    for (const double s : {0.4, 0.7, 1.0, 1.7, 3.0, 8.0}) {
        double lattice = 0.0, flux = 0.0;
        const int reach = static_cast<int>(35.0 / s);
        for (int x = -reach; x <= reach; ++x)
            for (int y = -reach; y <= reach; ++y)
                for (int z = -reach; z <= reach; ++z) {
                    const double d2 = double(x) * x + double(y) * y + double(z) * z;
                    if (d2 == 0.0 || d2 > double(reach) * reach)
                        continue;
                    lattice += std::exp(-s * std::sqrt(d2)) / d2;
                    flux += std::exp(-s * std::sqrt(d2)) / (3.0 * std::sqrt(d2));
                }
        EXPECT_NEAR((field.self_kernels(float(s)).light + lattice) / (4.0 * kPiExact / s), 1.0, 3e-3) << "s h = " << s;
        // Light of slope 1 sends its flux through every node: (1/3V) integral exp(-s r) / r dV.
        EXPECT_NEAR((field.self_kernels(float(s)).flux + flux) / (4.0 * kPiExact / (3.0 * s * s)), 1.0, 3e-3)
            << "s h = " << s;
    }
}

TEST(NearField, SelfLightNeverTurnsNegativeNorGrowsWithExtinction) {
    for (const mat3& lattice :
         {mat3(1.0f), mat3(some_linear_map()), mat3(vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 6))}) {
        const NearField field(lattice, 2.0f * std::cbrt(std::abs(glm::determinant(lattice))), true);
        float before = 1e30f;
        for (float s = 1e-4f; s < 1e5f; s *= 1.2f) {
            const float kappa = field.self_kernels(s).light;
            ASSERT_GE(kappa, 0.0f) << s;
            ASSERT_LE(kappa, before * 1.0001f) << s;
            before = kappa;
        }
    }
}

TEST(NearField, TapsIntegrateTheInterpolatedFieldExactly) {
    const mat3 lattice(some_linear_map());
    const float h = std::cbrt(std::abs(glm::determinant(lattice)));
    const NearField field(lattice, 2.0f * h, true);
    Recipe r;
    r.box = cube(-16, 15);
    r.world_from_index = transform(some_linear_map(), dvec3(0.0));
    r.density = [](const ivec3& n) { return noise(n, 9); };
    r.settings = black_smoke();
    const Medium medium = make_medium(r);
    const ExtinctionPyramid pyramid(medium, 1);
    for (const NearField::Separation& s : field.stencil()) {
        double depth = 0.0;
        for (const NearField::Tap& tap : s.taps)
            depth += double(tap.length) * medium.extinction[medium.lattice.find_node(tap.node)];
        double marched = 0.0;
        const int steps = 1000;
        const vec3 from = medium.local_of_node(ivec3(0)), to = medium.local_of_node(s.node);
        for (int k = 0; k < steps; ++k)
            marched += pyramid.extinction_at(glm::mix(from, to, (k + 0.5f) / steps));
        marched *= glm::length(to - from) / steps;
        ASSERT_NEAR(depth / marched, 1.0, 2e-4);
        ASSERT_LT(glm::length(s.direction + glm::normalize(to - from)), 1e-5f) << "from the light to the receiver";
    }
}

TEST(NearField, TheStencilReachesAsFarAsTheBlendAndNoFarther) {
    for (const float alpha : {1.0f, 2.0f, 3.0f}) {
        const NearField field(mat3(0.5f), alpha * 0.5f, false);
        std::size_t expected = 0;
        for (int x = -6; x <= 6; ++x)
            for (int y = -6; y <= 6; ++y)
                for (int z = -6; z <= 6; ++z) {
                    const float d = std::sqrt(float(x * x + y * y + z * z));
                    expected += d > 0.0f && d < 2.0f * alpha;
                }
        EXPECT_EQ(field.separations(), expected);
        for (const NearField::Separation& s : field.stencil()) {
            const float d = 0.5f * glm::length(vec3(s.node));
            const float blend = std::min(1.0f, 2.0f - d / (alpha * 0.5f));
            EXPECT_NEAR(s.kernel, blend / (d * d), 1e-5f);
            EXPECT_TRUE(s.taps.empty());
        }
    }
}

// A lattice of 24 nodes along each axis that shines on one side of a plane.
struct LitOnOneSide {
    LitOnOneSide(const mat3& linear, const PlaneOccluder& plane, bool directional) {
        Recipe r;
        r.box = cube(-12, 11);
        r.world_from_index = dmat4(dmat3(linear));
        r.density = [](const ivec3&) { return 1.0f; };
        medium = make_medium(r);
        std::mt19937 random(5);
        std::uniform_real_distribution<float> number(0.5f, 1.5f);
        intensity.resize(medium.lattice.node_count(), Rgb(0.0f));
        light.resize(directional ? 24 * intensity.size() : 0, 0.0f);
        for (std::size_t i = 0; i < intensity.size(); ++i) {
            lit.push_back(plane.side(medium.local_of_node(medium.lattice.node(i))) > 0.0f);
            if (!lit.back())
                continue;
            intensity[i] = Rgb(number(random));
            for (std::size_t k = 0; directional && k < 24; ++k)
                light[24 * i + k] = 0.3f * (number(random) - 1.0f);
        }
    }
    Gathered gather(const NearField& field, const Occluders* occluders) const {
        Gathered out;
        out.resize(intensity.size(), false, !light.empty());
        field.gather({&medium.lattice, &medium.extinction, &intensity, light.empty() ? nullptr : &light, std::nullopt,
                      medium.reference_node, 0.0f, nullptr, occluders},
                     out);
        return out;
    }
    Medium medium;
    std::vector<Rgb> intensity;
    std::vector<float> light;  // directional
    std::vector<bool> lit;
};

// What a plane takes away is the sum over the separations that cross it, however it and the lattice lie.
TEST(NearField, PlanesTakeAwayWhatIsBehindThem) {
    for (const mat3& linear : {mat3(0.1f), mat3(some_linear_map())})
        for (const vec3& normal : {vec3(1, 0, 0), vec3(0, -1, 0), vec3(0, 0, 1), vec3(0.3f, -0.5f, 0.7f)}) {
            const PlaneOccluder plane(normal, 0.37f * std::cbrt(std::abs(glm::determinant(linear))));
            const LitOnOneSide scene(linear, plane, false);
            const NearField field(scene.medium.local_from_index, 2.0f * scene.medium.spacing, false);
            const Gathered parted = scene.gather(field, &plane), whole = scene.gather(field, nullptr);
            const BrickLattice& lattice = scene.medium.lattice;
            std::size_t dark = 0;
            for (std::size_t i = 0; i < lattice.node_count(); ++i) {
                double behind = 0.0;
                for (const NearField::Separation& s : field.stencil())
                    if (const std::int64_t k = lattice.find_node(lattice.node(i) + s.node); k >= 0)
                        behind += scene.lit[i] != scene.lit[std::size_t(k)]
                                      ? double(s.kernel) * scene.intensity[std::size_t(k)].x
                                      : 0.0;
                ASSERT_NEAR(whole.fluence[i] - parted.fluence[i], behind, 1e-4 * whole.fluence[i] + 1e-6);
                dark += behind > 0.0;
            }
            EXPECT_GT(dark, std::size_t{500});
        }
}

// Nor does the light that a node has from the change of light across it know the other side.
TEST(NearField, NothingChangesAcrossAPlane) {
    const PlaneOccluder plane({0.3f, -0.5f, 0.7f}, 0.037f);
    const LitOnOneSide scene(mat3(0.1f), plane, true);
    const NearField field(scene.medium.local_from_index, 2.0f * scene.medium.spacing, true);
    const Gathered parted = scene.gather(field, &plane);
    for (std::size_t i = 0; i < scene.lit.size(); ++i)
        if (!scene.lit[i]) {
            ASSERT_EQ(parted.fluence[i], 0.0f);
            for (std::size_t k = 0; k < 24; ++k)
                ASSERT_EQ(parted.moments[k * scene.lit.size() + i], 0.0f);
        }
}

}  // namespace
}  // namespace brisance
