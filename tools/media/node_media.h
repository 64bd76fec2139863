// Media made from functions of the node, by the same code as those from files. Tests and the stability matrix render
// them.
#pragma once

#include <functional>
#include <string>

#include "medium/medium.h"

namespace brisance::media {

// A box of nodes, bounds included.
struct NodeBox {
    ivec3 low{0};
    ivec3 high{0};
};

NodeBox cube(int low, int high);

using NodeScalar = std::function<float(const ivec3&)>;
using NodeColour = std::function<Rgb(const ivec3&)>;

// Makes a grid as the reader of files does: blocks of 8^3 sorted by origin, with negative and NaN values counted in the
// census.
BlockGrid scalar_grid(const std::string& name, const dmat4& world_from_index, const NodeBox& box,
                      const NodeScalar& value);
BlockGrid colour_grid(const std::string& name, const dmat4& world_from_index, const NodeBox& box,
                      const NodeColour& value);

// world = linear * index + origin.
dmat4 transform(const dmat3& linear, const dvec3& origin);
dmat4 cubic(double spacing, const dvec3& origin = dvec3(0.0));

// The grids and settings of a medium. An empty function means that the grid is absent.
struct Recipe {
    NodeBox box;
    dmat4 world_from_index{1.0};
    NodeScalar density;
    NodeScalar flame;
    NodeScalar temperature;
    NodeColour colour;
    MediumSettings settings;
    bool half_voxel_shift = false;
};

MediumSettings black_smoke();  // extinction 1 per metre of density 1, no albedo, flame of strength 1
Medium make_medium(const Recipe& recipe);

// 1 inside a ball of `radius` nodes around `centre`, 0 outside, linear across one node at the surface.
float ball(const ivec3& node, const dvec3& centre, double radius);

// Smoke of `density` in a ball that emits as it absorbs, with source function 1: radiance 1 where it is opaque. The
// ball has radius 1 m and `nodes` nodes per radius.
Recipe glowing_ball(int nodes, float density);

// A pseudo-random number in [0, 1), a function of the node and `salt`.
float noise(const ivec3& node, int salt);

}  // namespace brisance::media
