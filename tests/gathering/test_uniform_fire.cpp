// Deep inside uniform smoke every point sees its own temperature, however thick a voxel is.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <glm/gtc/matrix_transform.hpp>

#include "fixtures/plane_occluder.h"
#include "gather_fixture.h"

namespace brisance {
namespace {

using namespace testing;

// A cube of (2 half)^3 nodes, source function 1.
constexpr double kEdge = 0.1;  // of voxels along x and y [m]

Lit uniform_fire(double depth_of_voxel, int half, double edge_along_z = kEdge) {
    Recipe r;
    r.box = cube(-half, half - 1);
    r.world_from_index = glm::scale(dmat4(1.0), {kEdge, kEdge, edge_along_z});
    r.density = r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = static_cast<float>(depth_of_voxel / kEdge);
    return Lit(make_medium(r));
}

float at_node(const Lit& lit, const Gathered& g, const ivec3& node) {
    return g.fluence[lit.medium.lattice.find_node(node)];
}

TEST(UniformFire, AbsorbsWhatItEmitsAtAnyThickness) {
    for (const double tau : {0.5, 1.0, 2.0, 5.0, 10.0, 1e2, 1e4, 1e6}) {
        // At least eight mean free paths from the walls.
        const Lit lit = uniform_fire(tau, tau < 1.0 ? 20 : 12);
        const Gathered g = at_all_nodes(lit, lighting(ShadowMethod::Maps));
        for (const ivec3& node : {ivec3(0), ivec3(3, -4, 1), ivec3(-3, 2, 3)})
            EXPECT_NEAR(at_node(lit, g, node) / (4.0 * kPiExact), 1.0, 0.03) << "optical thickness " << tau;
    }
}

TEST(UniformFire, ThinFireIsTransparentToItself) {
    for (const double tau : {1e-6, 1e-4}) {
        const Lit lit = uniform_fire(tau, 12);
        const Gathered clear = at_all_nodes(lit, lighting(ShadowMethod::None));
        std::vector<vec3> points;
        for (const ivec3& node : {ivec3(0), ivec3(3, -4, 1), ivec3(-12, 11, 0)})
            points.push_back(lit.medium.local_of_node(node));
        const std::vector<float> through_smoke = at_points(lit, lighting(ShadowMethod::Maps), points),
                                 through_nothing = at_points(lit, lighting(ShadowMethod::None), points);
        for (std::size_t i = 0; i < points.size(); ++i)
            EXPECT_NEAR(through_smoke[i] / through_nothing[i], 1.0, 30.0 * tau + 2e-4);
        // A cube of side a shines on its centre with 7.674134 j a.
        const double j = tau / 0.1, side = 2.4;
        EXPECT_NEAR(at_node(lit, clear, ivec3(0)) / (7.674134 * j * side), 1.0, 0.03);
    }
}

// Integral over a cuboid in front of the middle of one of its faces of cos / r^2, per square metre of its cross section
// 2 a times 2 b, from the solid angle of each layer: 4 atan(a b / (z sqrt(a^2 + b^2 + z^2))).
double irradiance_of(double a, double b, double height) {
    constexpr int kLayers = 4000;
    double sum = 0.0;
    for (int k = 0; k < kLayers; ++k) {
        const double z = (k + 0.5) / kLayers * height;
        sum += 4.0 * std::atan(a * b / (z * std::sqrt(a * a + b * b + z * z))) * height / kLayers;
    }
    return sum;
}

// A surface that cuts a thin fire is lit by the part in front of it, wherever it lies within a voxel and whichever way
// it faces. Voxels are lights, so what single points see depends on their place beside them.
struct Off {
    double means = 0.0, points = 0.0;
};

Off off_from_surfaces_within(double edge_along_z) {
    constexpr int kHalf = 12;
    constexpr double kTau = 1e-5;
    const Lit lit = uniform_fire(kTau, kHalf, edge_along_z);
    const LightField field = field_of(lit, lighting(ShadowMethod::None));
    const vec3 first = lit.medium.local_of_node(ivec3(0)), step = lit.medium.local_of_node(ivec3(1)) - first;
    Off off;
    for (const int axis : {0, 1, 2})
        for (const float side : {1.0f, -1.0f})
            for (double place = 0.0; place < 1.01; place += 0.125) {
                const int across = (axis + 1) % 3, other = (axis + 2) % 3;
                std::vector<vec3> points, normals;
                for (int k = 0; k < 16; ++k) {
                    vec3 at = first - 0.5f * step, normal(0.0f);  // from the middle of the fire
                    at[axis] += side * float(place) * step[axis];
                    at[across] += 0.25f * (float(k % 4) - 1.5f) * step[across];
                    at[other] += 0.25f * (float(k / 4) - 1.5f) * step[other];
                    normal[axis] = side;
                    points.push_back(at);
                    normals.push_back(normal);
                }
                Receivers receivers;
                receivers.add_block(points, normals);
                std::vector<LevelCost> costs;
                Progress silent;
                const Gathered g =
                    gather_at_points(field, bottom_level(field), receivers, 0.0f, costs, silent, ReceiverKind::Surface);
                const double truth = kTau / kEdge *
                                     irradiance_of(kHalf * double(step[across]), kHalf * double(step[other]),
                                                   (kHalf - place) * double(step[axis])) /
                                     kPiExact;
                double mean = 0.0;
                for (int k = 0; k < 16; ++k) {
                    const double error = double(g.scattered[std::size_t(k)]) / truth - 1.0;
                    off.points = std::max(off.points, std::abs(error));
                    mean += error / 16;
                }
                off.means = std::max(off.means, std::abs(mean));
            }
    std::printf("edges 1:1:%g: means are off by %.4f at most, points by %.4f\n", edge_along_z / kEdge, off.means,
                off.points);
    return off;
}

TEST(UniformFire, SurfacesInItSeeThePartInFrontOfThem) {
    for (const double edge_along_z : {kEdge, 1.5 * kEdge}) {
        const Off off = off_from_surfaces_within(edge_along_z);
        EXPECT_LT(off.means, 0.06);
        EXPECT_LT(off.points, 0.08);
    }
}

// In front of a plane, x mean free paths away, fluence is 4 pi (1 - E2(x) / 2): what is missing is what lies behind it.
// Walls at the border of bricks and within one, across each axis.
TEST(UniformFire, AWallHidesWhatIsBehindIt) {
    double worst = 0.0;
    for (const double tau : {1.0, 2.0}) {
        const Lit lit = uniform_fire(tau, 16);
        for (const int axis : {0, 1, 2})
            for (const int before : {0, 3}) {  // the first node in front
                ivec3 node(0);
                node[axis] = before;
                const PlaneOccluder wall = plane_across(axis, lit.medium.local_of_node(node)[axis] - 0.05f);
                LightField field = field_of(lit, lighting(ShadowMethod::Maps));
                field.occluders = &wall;
                const std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 1);
                std::vector<LevelCost> costs;
                Progress silent;
                const Gathered g = gather_at_nodes(field, {&needed, std::nullopt, false, 0.0f}, costs, silent);
                for (const int step : {-3, -2, -1, 0, 1, 2}) {
                    node[axis] = before + step;
                    const double depth = tau * (step < 0 ? -step - 0.5 : step + 0.5),
                                 e2 = std::exp(-depth) + depth * std::expint(-depth), truth = 1.0 - 0.5 * e2,
                                 found = at_node(lit, g, node) / (4.0 * kPiExact);
                    worst = std::max(worst, std::abs(found / truth - 1.0));
                    EXPECT_NEAR(found / truth, 1.0, 0.05) << "node " << step << ", axis " << axis << ", " << before;
                }
            }
    }
    std::printf("off by %.3f at most\n", worst);
}

TEST(UniformFire, TheFaceSeesHalfOfIt) {
    const Lit lit = uniform_fire(1.0, 12);
    const Gathered g = at_all_nodes(lit, lighting(ShadowMethod::Maps));
    // The field ends one node outside: at the last full node a little more than half a sphere is filled.
    const double face = at_node(lit, g, {0, 0, 11}) / (4.0 * kPiExact);
    EXPECT_GT(face, 0.5);
    EXPECT_LT(face, 0.85);
    EXPECT_LT(at_node(lit, g, {0, 0, 12}) / (4.0 * kPiExact), 0.5);
}

TEST(UniformFire, NowhereSeesMoreThanItsTemperature) {
    for (const double tau : {0.1, 1.0}) {
        const Lit lit = uniform_fire(tau, 12);
        const Gathered g = at_all_nodes(lit, lighting(ShadowMethod::Maps));
        for (std::size_t i = 0; i < g.fluence.size() / 3; ++i)
            if (lit.medium.extinction[i] > 0.0f) {
                ASSERT_LT(g.fluence[i] / (4.0 * kPiExact), 1.05) << "optical thickness " << tau;
            }
    }
}

}  // namespace
}  // namespace brisance
