// What one frame will need, before it is rendered.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "shot/shot.h"

namespace brisance {

struct FrameForecast {
    std::optional<double> seconds;  // of wall time, from the file to the picture, without a certificate
    std::string why_no_seconds;     // one line; empty where they are known
    std::uint64_t memory_bytes = 0;
    std::vector<std::string> cells;  // of the ledger, that run
};

// Loads the frame and counts (forecast/costs.h, forecast/memory_need.h). `speed`: machine_speed(). Throws Error.
FrameForecast forecast_frame(const Shot& shot, const std::filesystem::path& volume, int frame, double speed,
                             Progress& progress);

}  // namespace brisance
