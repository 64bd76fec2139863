// The spectrum of an error over time, as text and as JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "metrics/temporal_spectrum.h"

namespace brisance {

// One row for each layer: the error in each band, whose squares add up to that of the sequence.
std::string spectrum_table(const std::vector<std::pair<std::string, TemporalSpectrum>>& layers);

nlohmann::ordered_json to_json(const TemporalSpectrum& spectrum);

}  // namespace brisance
