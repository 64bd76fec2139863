#include "medium_lighting/levels/lighting_level.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "gathering/settings.h"
#include "medium/coarse_medium.h"
#include "medium/extinction_met.h"
#include "medium_lighting/levels/coarse_lighting.h"
#include "medium_lighting/surface_occluders.h"

namespace brisance {

namespace {

constexpr float kErrorOfVoxels = 0.05f;

// Of the square of the emission that a coarser lattice lacks, relative: about the part of the light of a node in fire
// that comes from the fire within its own voxel.
constexpr float kErrorOfEmission = 0.1f;

// Light on a coarser lattice may add this many times what the interpolation of its nodes may.
constexpr float kTimesInterpolation = 4.0f;

// Beyond this many times what is allowed, the next coarser lattice does not count.
constexpr float kNearlyAllowed = 1.5f;

// The errors above do not see how light changes around a small fire in thin smoke: voxels twice as wide changed MV by
// 2 % where the fire had 18 voxels across, and four times as wide by 11 %. Wider ones are not chosen.
constexpr int kWidest = 1;

// Errors of light on ever coarser lattices.
class LatticeErrors {
public:
    explicit LatticeErrors(const Medium& medium)
        : medium_(medium), depth_(medium.spacing * float(extinction_met(medium.extinction))) {
        if (medium.emits())
            emission_ = emission_luminance(medium);
    }

    // Relative, of the picture, on voxels 2^level wide.
    float of(int level) const {
        const float voxels = error_of_voxels(std::exp2(float(level)) * depth_) - error_of_voxels(depth_);
        return std::hypot(voxels, unresolved_emission(level));
    }

private:
    // By the emission (root mean square) that an interpolant through the lattice's means lacks.
    float unresolved_emission(int level) const {
        if (emission_.empty())
            return 0.0f;
        const BrickLattice& nodes = medium_.lattice;
        BrickLattice lattice = nodes;
        std::vector<float> means = emission_;
        average_down(lattice, means, 1, level);
        const CoarseSampler sampler{lattice, level};
        std::vector<double> off(nodes.brick_count()), all(nodes.brick_count());
        parallel_for(
            nodes.brick_count(),
            [&](std::size_t b) {
                for (int k = 0; k < BrickLattice::kNodes; ++k) {
                    const float value = emission_[b * BrickLattice::kNodes + k];
                    if (!(value > 0.0f))
                        continue;
                    float found = 0.0f;
                    sampler.at(nodes.first_node(b) + BrickLattice::node_in_brick(k),
                               [&](std::size_t i, float w) { found += w * means[i]; });
                    off[b] += double(value - found) * (value - found);
                    all[b] += double(value) * value;
                }
            },
            16);
        double off_sum = 0.0, sum = 0.0;
        for (std::size_t b = 0; b < all.size(); ++b) {
            off_sum += off[b];
            sum += all[b];
        }
        return sum > 0.0 ? kErrorOfEmission * float(off_sum / sum) : 0.0f;
    }

    const Medium& medium_;
    float depth_;
    std::vector<float> emission_;  // luminance per node; empty: none
};

bool stays_on_its_lattice(const MediumLightingInput& input) {
    return input.surroundings && input.surroundings->has_surfaces() &&
           surfaces_reach_into(input.surroundings->scene(), input.medium);
}

}  // namespace

float error_of_voxels(float depth) {
    return kErrorOfVoxels * depth * depth;
}

LightingLevel lighting_level(const MediumLightingInput& input) {
    const LightingLevel level = lighting_level(input.medium, input.lighting);
    const bool coarse = level.level > 0 || level.share_of_coarser > 0.0f;
    return coarse && stays_on_its_lattice(input) ? LightingLevel{} : level;
}

LightingLevel lighting_level(const Medium& medium, const LightingSettings& settings) {
    if (settings.lattice_level >= 0 || settings.interpolation >= 0.0f)
        return {std::max(0, settings.lattice_level)};
    const std::vector<float>& extinction = medium.extinction;
    const auto voxels = std::count_if(extinction.begin(), extinction.end(), [](float e) { return e > 0.0f; });
    const float allowed = kTimesInterpolation * tolerated_interpolation(settings, std::size_t(voxels));
    if (!(allowed > 0.0f))
        return {};
    const LatticeErrors errors(medium);
    LightingLevel out;
    for (float next = errors.of(1);; next = errors.of(out.level + 1)) {
        out.error_of_coarser = next;
        if (next > allowed) {
            out.share_of_coarser = 1.0f - glm::smoothstep(1.0f, kNearlyAllowed, next / allowed);
            return out;
        }
        out.error = next;
        if (++out.level == kWidest)
            return out;
    }
}

}  // namespace brisance
