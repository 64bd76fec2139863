// Refusals by the table of compensations (choices.h).
#pragma once

#include <functional>
#include <string>

#include "virtual_lights/choices.h"

namespace brisance {

const CompensationChoice& choice_of(BoundCompensation value);

// The names of those for which it holds: "none, exact".
std::string compensations_that(const std::function<bool(const CompensationChoice&)>& holds);

// Why the compensation does not go with the kind of light, with what would do; empty where it does.
std::string compensation_complaint(const VirtualLightSettings& settings);

// Why the compensation does not go with a bound on contributions, with what would do; empty where it does.
std::string contribution_complaint(const VirtualLightSettings& settings);

// Why the compensation does not go with reuse among pixels, with what would do; empty where it does.
std::string pixels_complaint(const VirtualLightSettings& settings);

}  // namespace brisance
