// The inner loop of gathering evaluates one light of the hierarchy for many receivers that share the interaction list.
#pragma once

#include <cstdint>
#include <span>

#include "lighting_grid/lighting_grid.h"
#include "medium/lattice/extinction_pyramid.h"
#include "receivers/receivers.h"
#include "shadows/shadow_maps.h"

namespace brisance {

// The lights of one level that a block evaluates, and their parameters.
struct FarLights {
    std::span<const std::uint32_t> list;  // into the arrays below
    const vec3* position;
    const Rgb* intensity;
    // Coefficients of degrees 1 and 2 of a directional intensity: 24 per light, [3 * m + c]; null: isotropic.
    const float* directional;
    const CosineLobe* lobes;  // of the lights; null: none has one

    float radius;            // r_l = alpha h_l [m]
    bool bottom;             // does not fade in; lights are balls of their voxel's volume, or discs beside surfaces
    bool voxels;             // level 0: lights fill their voxels evenly
    bool top;                // the top level does not fade out
    float ball;              // radius of that ball [m]
    const LightBall* balls;  // of the lights, whose shadows begin at their surface; null: all have `ball`

    enum class Shadow { Maps, Exact, None } shadow;
    const std::uint16_t* maps;  // of light list_base and the following ones
    std::uint32_t list_base;
    static constexpr std::uint32_t kNoMap = ~0u;
    const std::uint32_t* map_of;  // of each light, its number among `maps` or kNoMap; null: as above
    ShadowMapLayout layout;
    // Of each map the last distance alone, laid out as ends_of() says: transmittance to receivers outside of the box
    // `medium` (local [m]). They are small enough to stay in the caches, where maps are not. Null: maps are read.
    const std::uint16_t* ends;
    Box medium;
    const PackedExtinction* extinction;  // level 0, for exact shadows
    mat3 index_from_local;
    mat3 edges;        // of a voxel of this level [m], for surfaces beside the bottom one
    float step_nodes;  // of exact shadows

    bool has_map(std::uint32_t light) const { return !map_of || map_of[light] != kNoMap; }
    std::size_t number_of_map(std::uint32_t light) const { return map_of ? map_of[light] : light - list_base; }
    const std::uint16_t* map(std::uint32_t light) const { return maps + number_of_map(light) * layout.stride(); }
    bool are_outside(const Box& points) const {  // of the medium, all of them
        return glm::any(glm::lessThan(points.high, medium.low)) || glm::any(glm::greaterThan(points.low, medium.high));
    }
    const std::uint16_t* end(std::uint32_t light) const {
        return ends + number_of_map(light) * ends_of(layout).stride();
    }
};

struct FarOutput {
    std::size_t plane;  // values per channel
    float* fluence;
    float* scattered;  // null: not requested
    float* moments;    // null: not requested
    float mean_cosine;
    ReceiverKind kind = ReceiverKind::Medium;
};

// Adds the lights' contributions to the receivers of one block. Returns the number of light evaluations (lanes that the
// blend weight did not exclude for a whole group).
std::uint64_t gather_far(const FarLights& lights, const Receivers& receivers, const ReceiverBlock& block,
                         const FarOutput& output);

// Whether the distance from the light to some receiver of the block lies in the range in which the light's level is
// evaluated. Tests receivers one by one: boxes around far ones are wide.
bool may_reach(const FarLights& lights, std::uint32_t light, const Receivers& receivers, const ReceiverBlock& block);

// Name of the instruction set in use, for reports.
const char* gather_instruction_set();

}  // namespace brisance
