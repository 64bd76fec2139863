// The spectrum of errors over time as a page with a plot.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "metrics/temporal_spectrum.h"

namespace brisance {

// HTML that needs nothing else. `title` is text, not HTML. At least one layer.
std::string spectrum_page(const std::string& title,
                          const std::vector<std::pair<std::string, TemporalSpectrum>>& layers);

}  // namespace brisance
