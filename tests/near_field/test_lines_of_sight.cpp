// Nodes of a lattice that see each other past surfaces.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>

#include "fixtures/plane_occluder.h"
#include "gathering/gather_fixture.h"
#include "near_field/lines_of_sight.h"

namespace brisance {
namespace {

using namespace testing;

std::vector<ivec3> separations_within(int reach) {
    std::vector<ivec3> out;
    for (int x = -reach; x <= reach; ++x)
        for (int y = -reach; y <= reach; ++y)
            for (int z = -reach; z <= reach; ++z)
                if (x * x + y * y + z * z <= reach * reach)
                    out.emplace_back(x, y, z);
    return out;
}

constexpr int kReach = 4;

// Calls f with each node of a brick, each separation and whether the node sees so far.
template <class F>
void for_each_line(const Occluders& occluders, const mat3& lattice, const ivec3& first, const F& f) {
    const std::vector<ivec3> separations = separations_within(kReach);
    const LinesOfSight::Stencil stencil(separations);
    std::vector<std::uint8_t> seen;
    const bool cut = LinesOfSight(occluders, lattice, ivec3(3)).look(stencil, first, seen);
    for (int row = 0; row < 64; ++row)
        for (std::size_t s = 0; s < separations.size(); ++s)
            for (int z = 0; z < 8; ++z)
                f(first + ivec3(row / 8, row % 8, z), separations[s],
                  !cut || (seen[std::size_t(row) * separations.size() + s] >> z & 1) != 0);
}

TEST(LinesOfSight, EndAtPlanesHoweverTheyLie) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> number(-1.0f, 1.0f);
    for (const mat3& lattice : {mat3(0.5f), mat3(some_linear_map())})
        for (int k = 0; k < 20; ++k) {
            const ivec3 first(8, -16, 0);
            const auto at = [&](const ivec3& node) { return lattice * vec3(node - 3); };
            const vec3 normal(number(random), number(random), number(random));
            const vec3 in_plane = at(first + ivec3(3, 4, 5)) + 0.3f * number(random) * lattice[0];
            const PlaneOccluder plane(normal, glm::dot(glm::normalize(normal), in_plane));
            int hidden = 0;
            for_each_line(plane, lattice, first, [&](const ivec3& node, const ivec3& o, bool sees) {
                const float a = plane.side(at(node)), b = plane.side(at(node + o));
                if (std::min(std::abs(a), std::abs(b)) < 1e-4f)
                    return;  // rounding decides
                ASSERT_EQ(sees, (a > 0.0f) == (b > 0.0f)) << "plane " << k;
                hidden += !sees;
            });
            EXPECT_GT(hidden, 0);
        }
}

// A wall that ends at z = 1.5: where either end looks over its rim a path leads around it, and every line that passes
// over it is one of these.
TEST(LinesOfSight, LeadAroundTheRimsOfWalls) {
    constexpr float kRim = 1.5f;
    const PlaneOccluder wall({1, 0, 0}, 0.5f, kRim);
    int over = 0, around = 0, hidden = 0;
    for_each_line(wall, mat3(1.0f), ivec3(0), [&](const ivec3& node, const ivec3& o, bool sees) {
        const vec3 from(node - 3), to(node + o - 3);
        const bool crosses = (from.x > 0.5f) != (to.x > 0.5f);
        ASSERT_EQ(sees, !crosses || std::max(from.z, to.z) > kRim);
        if (!crosses)
            return;
        const bool passes = glm::mix(from.z, to.z, (0.5f - from.x) / (to.x - from.x)) > kRim;
        hidden += !sees;
        over += sees && passes;
        around += sees && !passes;
        ASSERT_TRUE(sees || !passes);
    });
    EXPECT_GT(hidden, 1000);
    EXPECT_LT(around, over);
}

// From whichever brick a pair of nodes is seen, and from whichever end.
TEST(LinesOfSight, AreTheSameFromBothEnds) {
    const PlaneOccluder wall({0.8f, 0.5f, 0.3f}, 3.7f, 1.2f);
    const std::vector<ivec3> separations = separations_within(kReach);
    const LinesOfSight::Stencil stencil(separations);
    std::map<std::array<int, 6>, bool> sees;
    for (const ivec3& first : {ivec3(0), ivec3(8, 0, 0), ivec3(0, 8, 0), ivec3(3, 5, -2)})
        for_each_line(wall, mat3(1.0f), first, [&](const ivec3& a, const ivec3& o, bool is) {
            const ivec3 b = a + o;
            for (const auto& key : {std::array{a.x, a.y, a.z, b.x, b.y, b.z}, std::array{b.x, b.y, b.z, a.x, a.y, a.z}})
                ASSERT_EQ(sees.try_emplace(key, is).first->second, is);
        });
    EXPECT_GT(std::ranges::count_if(sees, [](const auto& s) { return !s.second; }), 1000);
}

TEST(LinesOfSight, CostNothingInTheOpen) {
    const std::vector<ivec3> separations = separations_within(kReach);
    const LinesOfSight::Stencil stencil(separations);
    const mat3 lattice(1.0f);
    struct Counted : PlaneOccluder {
        using PlaneOccluder::PlaneOccluder;
        float first_hit(const vec3& from, const vec3& direction, float far) const override {
            ++lines;
            return PlaneOccluder::first_hit(from, direction, far);
        }
        mutable int lines = 0;
    };
    std::vector<std::uint8_t> seen;
    const Counted far({0, 0, 1}, 40.0f), near({0, 0, 1}, 3.5f);
    EXPECT_FALSE(LinesOfSight(far, lattice, ivec3(0)).look(stencil, ivec3(0), seen));
    EXPECT_TRUE(seen.empty());
    EXPECT_EQ(far.lines, 0);
    EXPECT_TRUE(LinesOfSight(near, lattice, ivec3(0)).look(stencil, ivec3(0), seen));
    EXPECT_LT(near.lines, 16 * 16 * 16 * 3 / 2) << "edges far from the plane";
}

}  // namespace
}  // namespace brisance
