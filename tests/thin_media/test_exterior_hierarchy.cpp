// The light that surfaces outside of the smoke receive from the lighting grid, against the sum over all its voxels with
// marched transmittance.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "camera/camera.h"
#include "fixtures/media.h"
#include "gathering/escape_probability.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/lattice/local_bounds.h"
#include "render/many_lights.h"
#include "scattering/balance.h"

namespace brisance {
namespace {

using namespace testing;

// Fire in ragged smoke, of which a few hundredths escape.
Medium burst() {
    Recipe recipe;
    recipe.box = cube(-26, 26);
    recipe.world_from_index = cubic(0.05);
    recipe.density = [](const ivec3& n) {
        const ivec3 lump = n >> 2;
        return ball(n, dvec3(0.0), 24.0) * (noise(lump, 1) < 0.75f ? 0.3f + noise(n, 2) : 0.0f);
    };
    recipe.flame = [](const ivec3& n) { return ball(n, dvec3(0.0), 22.0) * noise(n >> 1, 3); };
    recipe.settings = black_smoke();
    recipe.settings.smoke.extinction_per_metre = 25.0f;
    return make_medium(recipe);
}

double brute_force(const Medium& medium, const PointDepths& depths, const std::vector<Rgb>& intensity,
                   const SurfaceReceiver& at) {
    std::array<vec3, PointDepths::kRays> to;
    std::array<float, PointDepths::kRays> depth, light;
    int n = 0;
    double sum = 0.0;
    const auto add = [&] {
        std::fill(to.begin() + n, to.end(), to[0]);
        depths.between(at.local, to.data(), depth.data());
        for (int k = 0; k < n; ++k) {
            const vec3 offset = to[k] - at.local;
            const double square = glm::dot(offset, offset), cosine = glm::dot(offset, at.normal) / std::sqrt(square);
            sum += std::max(0.0, cosine) * light[k] * std::exp(-double(depth[k])) / square;
        }
        n = 0;
    };
    for (std::size_t i = 0; i < intensity.size(); ++i) {
        if (intensity[i] == Rgb(0.0f))
            continue;
        to[n] = medium.local_of_node(medium.lattice.first_node(i / BrickLattice::kNodes) +
                                     BrickLattice::node_in_brick(int(i % BrickLattice::kNodes)));
        light[n] = luminance(intensity[i]);
        if (++n == PointDepths::kRays)
            add();
    }
    if (n > 0)
        add();
    return sum / std::numbers::pi;
}

// Points on a sphere around the smoke that face it.
std::vector<SurfaceReceiver> around(const vec3& middle, float radius, int count) {
    std::vector<SurfaceReceiver> points;
    for (int k = 0; k < count; ++k) {
        const float z = 1.0f - (2.0f * float(k) + 1.0f) / float(count), r = std::sqrt(1.0f - z * z);
        const vec3 d(r * std::cos(2.4f * float(k)), r * std::sin(2.4f * float(k)), z);
        points.push_back({middle + radius * d, -d, {}, {}});
    }
    return points;
}

class OutsideLights : public ::testing::Test {
protected:
    struct Errors {
        double root_mean_square, mean;
    };
    Errors errors(float radius) {
        std::vector<SurfaceReceiver> points = around(local_bounds(medium).middle(), radius, 64);
        lighting.at_surfaces(points);
        double error = 0.0, truth = 0.0, square = 0.0, sum = 0.0;
        for (const SurfaceReceiver& p : points) {
            const double true_value = brute_force(medium, depths, intensity, p),
                         value = luminance(p.fire[0] + p.fire[1]);
            error += (value - true_value) * (value - true_value);
            square += true_value * true_value;
            sum += value;
            truth += true_value;
        }
        std::printf("radius %.1f m: error %.2f %%, mean %+.2f %%\n", radius, 100.0 * std::sqrt(error / square),
                    100.0 * (sum / truth - 1.0));
        return {std::sqrt(error / square), sum / truth - 1.0};
    }

    static Shot with_fine_shadows() {
        Shot shot;
        shot.lighting.error = 0.01f;
        return shot;
    }

    static Plan plan_of_sets() {
        Plan plan;
        plan.emission = plan.surfaces = true;
        plan.needed.set(Cell::SV, true);
        return plan;
    }

    const Medium medium = burst();
    const ExtinctionPyramid pyramid{medium, ExtinctionPyramid::kMaxLevels};
    const PointDepths depths{pyramid, 0};
    const std::vector<Rgb> intensity = voxel_lights(medium);
    const Shot shot = with_fine_shadows();
    const Plan plan = plan_of_sets();
    Statistics statistics;
    Progress silent;
    const Camera camera{framed_camera(medium, shot.camera), medium};
    const DrawInput input{shot, plan, medium, nullptr, camera};
    const MediumLighting lighting{medium_lighting_input(input, plan, medium), statistics, silent};
};

TEST_F(OutsideLights, LittleEscapes) {
    const NodeWeights likelihood = escape_likelihood(medium, depths, intensity);
    const EscapeEstimate e = estimate_escape(pyramid, intensity, {}, likelihood, 100000);
    const double share = luminance(Rgb(e.power / total(intensity)));
    EXPECT_GT(share, 0.01);
    EXPECT_LT(share, 0.1);
}

// What is remembered of one light serves another: fire first, then all nodes.
TEST_F(OutsideLights, EscapeIsRememberedFromLightToLight) {
    const std::vector<Rgb> everywhere(intensity.size(), Rgb(1.0f));
    NodeWeights known;
    EXPECT_EQ(escape_likelihood(medium, depths, intensity, &known), escape_likelihood(medium, depths, intensity));
    EXPECT_EQ(escape_likelihood(medium, depths, everywhere, &known), escape_likelihood(medium, depths, everywhere));
}

// Smoke that differs from voxel to voxel is the hardest there is.
TEST_F(OutsideLights, SumUpToWhatAllVoxelsSend) {
    for (const float radius : {1.6f, 3.0f, 50.0f}) {
        const Errors e = errors(radius);
        EXPECT_LT(e.root_mean_square, 0.03) << radius;
        EXPECT_LT(std::abs(e.mean), 0.01) << radius;
    }
}

}  // namespace
}  // namespace brisance
