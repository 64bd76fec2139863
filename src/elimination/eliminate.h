// Weighted sample elimination reduces many random points to few that keep their distance from each other (blue noise).
//
// [1] C. Yuksel, Sample Elimination for Generating Poisson Disk Sample Sets, Computer Graphics Forum 34(2), 2015.
// [2] T. Li, W. Wang, D. Lin, C. Yuksel, Virtual Blue Noise Lighting, HPG 2022: radii from the candidates' density.
//
// Differences from both: elimination runs in parallel, yet keeps exactly the points that the one-by-one algorithm would
// keep (greedy.h), so that no cell border can show. Differences from [1]: ratios beyond stage_ratio are reached in
// stages, each with matching distances, so that no point has too many neighbours. Differences from [2]: weights are
// limited as in [1], which keeps survivors further apart (nearest neighbours at 0.81 d_max instead of 0.72 on average).
// Coincident points count once: all but the first of them are removed before any other point. Weights are integers, so
// results are the same to the bit for any number of threads.
//
// Time grows with the number of candidates within d_max of each, so uniform radii need candidates whose density varies
// by two orders of magnitude at most.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec.h"

namespace brisance {

enum class EliminationRadius {
    Adaptive,  // from the local density of candidates, which survivors keep
    Uniform    // one for all, from the measure of the domain: survivors spread evenly
};

struct EliminationSettings {
    int dimension = 2;  // of what the points lie on: 2 surfaces, 3 volumes
    EliminationRadius radius = EliminationRadius::Adaptive;
    int neighbours = 128;       // Adaptive: k, from whose distance density is taken; few make distances uneven
    double measure = 0.0;       // Uniform: area [m^2] or volume [m^3] of the domain
    double stage_ratio = 32.0;  // greatest ratio of points before a stage to those after; infinity: one stage as in [1]
    bool one_by_one = false;    // the textbook's sequential algorithm: the same survivors, slowly
};

struct Survivors {
    std::vector<std::uint32_t> index;  // into the points given, ascending
    std::vector<float> distance;       // d_max = 2 r_max of each [m]: what it would keep from others in closest packing
};

// Returns exactly min(target, points) survivors. `ids`, one per point or none, replace indices as the tie-breaker
// between equals; with them, survivors do not depend on the order of the points. Points without another candidate at
// different coordinates get an adaptive distance of 0.
// Throws Error: a position that is not finite, ids of another number, settings out of range.
Survivors eliminate(std::span<const vec3> points, std::size_t target, const EliminationSettings& settings,
                    std::span<const std::uint64_t> ids = {});

}  // namespace brisance
