// Surveys of simple shapes, without files.
#pragma once

#include <functional>

#include "first_look/look.h"

namespace brisance {

// A grid of 64^3 voxels of `metres` with the value of a function of the position from the middle, in half widths.
inline BlockGrid shape_grid(const std::function<double(const dvec3&)>& value, double metres = 0.1) {
    constexpr int blocks = 8, side = BlockGrid::kBlock;
    BlockGrid grid;
    grid.info.world_from_index = dmat4(dmat3(metres));
    grid.info.usable = true;
    for (int i = 0; i < blocks * blocks * blocks; ++i) {
        const ivec3 origin = side * ivec3(i / (blocks * blocks), i / blocks % blocks, i % blocks);
        grid.block_origin.push_back(origin);
        for (int v = 0; v < side * side * side; ++v) {
            const ivec3 index = origin + ivec3(v / (side * side), v / side % side, v % side);
            grid.values.push_back(static_cast<float>(value((dvec3(index) - 31.5) / 32.0)));
        }
    }
    return grid;
}

inline BlockGrid ball_grid(double value, double radius = 0.5, double metres = 0.1) {
    return shape_grid([&](const dvec3& p) { return glm::length(p) < radius ? value : 0.0; }, metres);
}

inline GridChoice named(const char* name) {
    return {name, 0, "automatic"};
}

// A survey of one frame; null grids are not in the file.
inline SequenceSurvey survey_of(const BlockGrid* density, const BlockGrid* flame = nullptr,
                                const BlockGrid* temperature = nullptr) {
    SequenceSurvey survey;
    survey.name = "a.vdb";
    survey.frames = {1};
    if (density)
        survey.mapping.density = named("density");
    if (flame)
        survey.mapping.flame = named("flame");
    if (temperature)
        survey.mapping.temperature = named("temperature");
    survey.seen.push_back(survey_frame(1, density, flame, temperature));
    return survey;
}

inline Json value_of(const Look& look, const std::string& key) {
    const LookDecision* const decision = look.find(key);
    return decision ? decision->value : Json();
}

}  // namespace brisance
