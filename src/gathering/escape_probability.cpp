#include "gathering/escape_probability.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "medium/lattice/local_bounds.h"

namespace brisance {

namespace {

using Directions = std::array<vec3, PointDepths::kRays>;

Directions spiral() {
    Directions directions;
    constexpr float golden_angle = 2.3999632297f;
    for (int k = 0; k < PointDepths::kRays; ++k) {
        const float z = 1.0f - (2.0f * float(k) + 1.0f) / PointDepths::kRays, r = std::sqrt(1.0f - z * z);
        directions[k] = {r * std::cos(golden_angle * float(k)), r * std::sin(golden_angle * float(k)), z};
    }
    return directions;
}

}  // namespace

float mean_transmittance_outside(const Medium& medium, const PointDepths& depths, const vec3& from) {
    static const Directions directions = spiral();
    const float far = local_bounds(medium).diagonal();
    std::array<vec3, PointDepths::kRays> to;
    std::array<float, PointDepths::kRays> depth;
    for (int k = 0; k < PointDepths::kRays; ++k)
        to[k] = from + far * directions[k];
    depths.between(from, to.data(), depth.data());
    float sum = 0.0f;
    for (const float d : depth)
        sum += std::exp(-d) / PointDepths::kRays;
    return sum;
}

NodeWeights escape_likelihood(const Medium& medium, const PointDepths& depths, const std::vector<Rgb>& intensity,
                              NodeWeights* known) {
    constexpr float kUnknown = -1.0f;
    NodeWeights own;
    NodeWeights& all = known ? *known : own;
    all.resize(intensity.size(), kUnknown);
    NodeWeights likelihood(intensity.size(), 0.0f);
    parallel_for(
        intensity.size() / BrickLattice::kNodes,
        [&](std::size_t b) {
            for (int n = 0; n < BrickLattice::kNodes; ++n) {
                const std::size_t i = b * BrickLattice::kNodes + n;
                if (!(luminance(intensity[i]) > 0.0f))
                    continue;
                if (all[i] == kUnknown)
                    all[i] = mean_transmittance_outside(
                        medium, depths,
                        medium.local_of_node(medium.lattice.first_node(b) + BrickLattice::node_in_brick(n)));
                likelihood[i] = all[i];
            }
        },
        4);
    return likelihood;
}

NodeWeights escape_density(const std::vector<Rgb>& intensity, const NodeWeights& likelihood) {
    NodeWeights density;
    double all = 0.0, out = 0.0;
    for (std::size_t i = 0; i < intensity.size(); ++i) {
        density.push_back(std::max(0.0f, luminance(intensity[i])));
        all += density.back();
        out += double(density.back()) * likelihood[i];
    }
    constexpr float even = FootprintPicker::kLeastShare;
    for (std::size_t i = 0; i < density.size() && out > 0.0; ++i)
        density[i] *= even + (1.0f - even) * float(likelihood[i] * all / out);
    return density;
}

}  // namespace brisance
