// Smoke above a floor of lights, which shine by Lambert's cosine: a disc of radiance L and radius R has the fluence
// 2 pi L (1 - h / sqrt(h^2 + R^2)) at the height h above its middle.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fixtures/media.h"
#include "gathering/gather.h"
#include "lighting_grid/point_grid.h"
#include "medium/sh.h"

namespace brisance {
namespace {

using namespace testing;

constexpr float kRadius = 6.0f, kRadiance = 2.0f, kStep = 0.05f;

// A disc at height z of lights with the harmonics that virtual lights have, and with or without their normals.
PointLights disc(bool normals, float z = 0.0f) {
    PointLights out;
    const vec3 up(0.0f, 0.0f, 1.0f);
    const auto basis = sh_basis(up);
    const int across = int(kRadius / kStep);
    for (int i = -across; i <= across; ++i)
        for (int j = -across; j <= across; ++j) {
            const vec3 p(kStep * float(i), kStep * float(j), z);
            if (std::hypot(p.x, p.y) > kRadius)
                continue;
            const float flux = kPi * kRadiance * kStep * kStep;
            out.position.push_back(p);
            out.intensity.emplace_back(flux / (4.0f * kPi));
            for (int m = 0; m < kShMoments; ++m)
                for (int c = 0; c < 3; ++c)
                    out.directional.push_back(flux * (m < 3 ? 2.0f / 3.0f : 0.25f) * basis[m]);
            if (normals)
                out.normal.push_back(up);
        }
    return out;
}

struct Errors {
    double worst, mean;
};

// Relative errors of the fluence over nodes around the middle whose height above the floor, which is
// `below` the lowest nodes, is from `from` to `to` [m].
Errors errors(bool normals, float below = 0.0f, float from = 0.15f, float to = 10.0f) {
    Recipe r;
    r.box = cube(0, 10);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = 1e-6f;
    const Medium medium = make_medium(r);
    const ExtinctionPyramid pyramid(medium, ExtinctionPyramid::kMaxLevels);
    const PointLights lights = disc(normals, -below);
    const LightingGrid grid = build_point_grid(medium, lights, 2.0f);
    const std::vector<float> no_weight(medium.lattice.node_count(), 0.0f);
    const LightField field{&pyramid, nullptr, nullptr, &grid, &no_weight, 2.0f, {}, nullptr, nullptr};
    const std::vector<std::uint8_t> needed(medium.lattice.node_count(), 1);
    std::vector<LevelCost> costs;
    Progress silent;
    const Gathered g = gather_at_nodes(field, {&needed, std::nullopt}, costs, silent);
    double worst = 0.0, sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < medium.lattice.node_count(); ++i) {
        const vec3 p = medium.local_of_node(medium.lattice.node(i));
        const double h = p.z + below;
        if (!(medium.extinction[i] > 0.0f) || h < from || h > to || std::max(p.x, p.y) > 0.55f)
            continue;
        const double truth = 2.0 * double(kPi) * double(kRadiance) * (1.0 - h / std::hypot(h, double(kRadius)));
        const double error = double(g.fluence[i]) / truth - 1.0;
        worst = std::max(worst, std::abs(error));
        sum += error;
        ++count;
    }
    return {worst, sum / count};
}

// Of light at grazing angles, from far parts of the floor, harmonics of degree 2 make too much.
TEST(FloorOfLights, SendsNoLightAlongItself) {
    const double by_cosine = errors(true).worst, by_harmonics = errors(false).worst;
    std::printf("off by %.3f, by harmonics alone %.3f\n", by_cosine, by_harmonics);
    EXPECT_LT(by_cosine, 0.04);
    EXPECT_GT(by_harmonics, 2.0 * by_cosine);
}

// Voxels are 0.1 m wide: smoke that lies on the floor, down to nodes that hardly stand out of it, and those in its
// plane, above which lights lie by less than a hundredth of a voxel.
TEST(FloorOfLights, IsAsBrightCloseToIt) {
    for (const float height : {-0.0007f, 0.0003f, 0.01f, 0.03f, 0.05f, 0.08f}) {
        for (const bool lowest : {true, false}) {
            const Errors e = errors(true, height, height - 1e-5f, lowest ? 0.1f : 10.0f);
            std::printf("%s nodes from %.4f m on: off by %.3f, mean %+.3f\n", lowest ? "lowest" : "all", double(height),
                        e.worst, e.mean);
            EXPECT_LT(e.worst, 0.15) << height;
            EXPECT_NEAR(e.mean, 0.0, 0.05) << height;
        }
    }
}

}  // namespace
}  // namespace brisance
