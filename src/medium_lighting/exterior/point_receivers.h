// Points outside of the lattice as receivers for a gather.
#pragma once

#include <cstdint>
#include <vector>

#include "medium/medium.h"
#include "receivers/receivers.h"

namespace brisance {

struct ReceiverPoint {
    vec3 local;   // [m]
    vec3 toward;  // unit: the normal of a surface, or the direction toward the viewer
};

// The points sorted into blocks of neighbours, as required by gathers. `order` becomes the point of each receiver;
// blocks are padded with their last point.
Receivers point_receivers(const Medium& medium, const std::vector<ReceiverPoint>& points,
                          std::vector<std::uint32_t>& order);

}  // namespace brisance
