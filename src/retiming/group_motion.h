// The motion of a group of fields.
#pragma once

#include "retiming/field_group.h"
#include "retiming/motion.h"

namespace brisance {

// Of the first and the second frame.
using VelocityPair = std::array<const CentredVelocity*, 2>;

Motion motion_of(const FieldGroup& group, const VelocityPair& velocity, const VelocitySettings& settings, int frames);

// Throws Error BadData, beginning with `where`, when the smoke would move several times its width.
void check_speed(const FieldGroup& group, const VelocityPair& velocity, const VelocitySettings& settings, int frames,
                 const std::string& where);

// How far a motion brings each node [nodes], for all nodes of the bricks that `wanted` marks, or of all bricks where it
// is empty.
std::vector<vec3> moved_nodes(const BrickLattice& lattice, const std::vector<std::uint8_t>& wanted,
                              const Motion& motion, double from, double to);

}  // namespace brisance
