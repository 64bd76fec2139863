// Gathers the light that arrives in a lit medium.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "fixtures/media.h"
#include "gathering/gather.h"

namespace brisance::testing {

constexpr double kPiExact = 3.14159265358979323846;

inline LightField field_of(const Lit& lit, const LightingSettings& settings) {
    LightField field{};
    field.pyramid = &lit.pyramid;
    field.intensity = &lit.intensity;
    field.grid = &lit.grid;
    field.weight = &lit.weight;
    field.alpha = settings.alpha;
    field.settings = settings;
    return field;
}

inline LightingSettings lighting(ShadowMethod shadows, float alpha = 2.0f) {
    LightingSettings settings;
    settings.shadows = shadows;
    settings.alpha = alpha;
    return settings;
}

// Fluence of all nodes, planar.
inline Gathered at_all_nodes(const Lit& lit, const LightingSettings& settings,
                             const std::optional<vec3>& eye = std::nullopt, bool moments = false,
                             float mean_cosine = 0.0f) {
    const std::vector<std::uint8_t> needed(lit.medium.lattice.node_count(), 1);
    std::vector<LevelCost> costs;
    Progress silent;
    return gather_at_nodes(field_of(lit, settings), {&needed, eye, moments, mean_cosine}, costs, silent);
}

// The same at the nodes for which `is_needed` returns true.
template <class IsNeeded>
Gathered at_nodes(const Lit& lit, const LightingSettings& settings, const IsNeeded& is_needed) {
    std::vector<std::uint8_t> needed(lit.medium.lattice.node_count());
    for (std::size_t i = 0; i < needed.size(); ++i)
        needed[i] = is_needed(lit.medium.lattice.first_node(i / BrickLattice::kNodes) +
                              BrickLattice::node_in_brick(static_cast<int>(i % BrickLattice::kNodes)));
    std::vector<LevelCost> costs;
    Progress silent;
    return gather_at_nodes(field_of(lit, settings), {&needed, std::nullopt, false, 0.0f}, costs, silent);
}

// Fluence of the first channel at points, one block per run of up to 64 points.
inline std::vector<float> at_points(const Lit& lit, const LightingSettings& settings, const std::vector<vec3>& points) {
    Receivers receivers;
    std::vector<std::size_t> receiver_of_point;
    for (std::size_t first = 0; first < points.size(); first += 64) {
        const std::vector<vec3> block(points.begin() + first, points.begin() + std::min(points.size(), first + 64));
        for (std::size_t i = 0; i < block.size(); ++i)
            receiver_of_point.push_back(receivers.size() + i);
        receivers.add_block(block, {});
    }
    std::vector<LevelCost> costs;
    Progress silent;
    const LightField field = field_of(lit, settings);
    const Gathered gathered = gather_at_points(field, bottom_level(field), receivers, 0.0f, costs, silent);
    std::vector<float> fluence;
    for (const std::size_t i : receiver_of_point)
        fluence.push_back(gathered.fluence[i]);
    return fluence;
}

inline ivec3 node_at(const Medium& medium, std::size_t i) {
    return medium.lattice.first_node(i / BrickLattice::kNodes) +
           BrickLattice::node_in_brick(static_cast<int>(i % BrickLattice::kNodes));
}

}  // namespace brisance::testing
