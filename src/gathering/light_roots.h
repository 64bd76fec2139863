// What is interpolated in the place of light between nodes.
//
// Light falls almost exponentially in smoke. Of fluence and scattered light the eighth root is therefore interpolated,
// a mean close to the geometric one, and of moments their ratio to the fluence.
#pragma once

#include <span>

#include "receivers/receivers.h"

namespace brisance {

// Planes of fluence and scattered light; those of moments follow. `nodes`: receivers.
std::size_t planes_of_light(const Gathered& light, std::size_t nodes);

// Turns light at nodes into what is interpolated.
void take_roots(Gathered& light, std::size_t nodes);

// Turns what was interpolated at one node, a value per plane, into light. `lights`: planes_of_light().
void raise_roots(std::span<float> values, std::size_t lights);

}  // namespace brisance
