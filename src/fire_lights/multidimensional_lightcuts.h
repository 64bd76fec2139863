// Multidimensional lightcuts: one cut through pairs of points on a camera ray and lights of the fire.
//
// B. Walter, A. Arbree, K. Bala, D. Greenberg, Multidimensional Lightcuts, SIGGRAPH 2006.
//
// The points of a ray are the leaves of a tree, as the lights are of theirs. A node of the cut is a pair of one node of
// each. Both have a representative, drawn in proportion to weight or intensity, and the pair contributes what these two
// exchange, times the ratios of weights and of intensities. It errs by at most W I M / d^2, with the largest phase
// function M over all directions from the box of the points to that of the lights and the least distance d between the
// boxes (visibility counts as 1, and smoke as dense as where it is thinnest at the points, see single_points.h). The
// pair that may err most is divided in the tree whose box is larger, until no pair may err by more than
// settings.lightcuts_error of the sum, or there are settings.lightcuts_most.
//
// Departs from the paper: the points are those of one ray, not of all rays of a pixel, as rays are integrated one by
// one; they are put in a tree by their order, without clustering; a point of a surface is alone, so that its cut is one
// through the lights; and the tree that is divided is chosen by size alone.
#pragma once

#include "fire_lights/fire_lights.h"
#include "fire_lights/gather_points.h"
#include "fire_lights/settings.h"
#include "transport/lightcuts.h"

namespace brisance {

class MultidimensionalLightcuts : public FireGatherer {
public:
    MultidimensionalLightcuts(const FireLights& lights, const FireLightSettings& settings);
    Rgb at(std::span<const GatherPoint> points, Rng& rng) const override;
    std::uint64_t bytes() const override { return cut_.bytes(); }

private:
    const FireLights& lights_;
    Lightcut cut_;
};

}  // namespace brisance
