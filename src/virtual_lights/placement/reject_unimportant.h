// Which deposits matter to the camera: those where many of its paths arrive.
#pragma once

#include <vector>

#include "virtual_lights/placement/deposit.h"

namespace brisance {

// About `target` of the deposits, each kept by its own random number: with a probability in proportion to the density
// of the camera's deposits around it, and never less than one in a hundred. All, where there are fewer.
//
// F. Simon, J. Hanika, C. Dachsbacher, Rich-VPLs for Improving the Versatility of Many-Light Methods, Computer Graphics
// Forum 34(2), 2015.
std::vector<Deposit> reject_unimportant(const std::vector<Deposit>& deposits, const std::vector<Deposit>& from_camera,
                                        std::size_t target, std::uint32_t seed);

}  // namespace brisance
