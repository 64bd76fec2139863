// Which grids of a file hold its velocity.
#pragma once

#include <string>
#include <vector>

#include "volume/mapping.h"

namespace brisance {

struct VelocityMapping {
    std::vector<GridChoice> grids;  // one of three channels, or three of one: x, y, z; empty: none
    std::string why_none;           // where there is none
    std::string describe() const;   // the names in quotes, or none
};

// By name where `roles` name none: velocity, vel, v and the like, or three scalars vel_x, vel_y, vel_z and the like.
// Throws Error BadData when the shot names a grid that is absent or is no velocity.
VelocityMapping map_velocity(const std::vector<GridInfo>& grids, const GridRoles& roles, const std::string& file);

// Whether that mapping takes this grid; false where it would throw.
bool plays_velocity(const std::vector<GridInfo>& grids, const GridRoles& roles, const GridInfo& grid);

}  // namespace brisance
