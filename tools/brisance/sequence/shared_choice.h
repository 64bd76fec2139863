// What all frames of a sequence share, decided by the files on disk, whichever frames are rendered.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "render/choice/choose_method.h"
#include "render/choice/time_budget.h"
#include "render/render_frame.h"
#include "sequence/result_cache.h"
#include "shot/shot.h"

namespace brisance {

// What was chosen for all frames, before the first.
struct SharedChoice {
    std::optional<TimedSettings> timed;
    std::optional<MethodForecast> method;
    std::optional<float> exposure_stops;  // of PNGs; absent where one frame chooses for itself, or the shot states it

    // Adds the cost of choosing to the statistics of the first frame.
    void note(bool first, RenderedFrame& frame) const;
};

// Replaces `shot` by one with the chosen settings.
SharedChoice choose_for_all(Shot& shot, Progress& progress);

// The same with the exposure of PNGs. `cache`: takes the choice over from another process, or leaves it there; null:
// none. Where a clock or a forecast decides, or something had to be warned of, nothing is kept.
SharedChoice choose_all(Shot& shot, ResultCache* cache, Progress& progress);

// Of sequences with output.exposure_stops "auto" and more than one frame on disk: the exposure of a small picture of
// the largest file that is not black. Nothing else, and nothing where no frame can be read.
std::optional<float> exposure_for_all(const Shot& shot, Progress& progress);

// The files by which something is chosen for all frames.
std::vector<std::filesystem::path> deciding_files(const Shot& shot);

std::string exposure_notice(float stops, const std::string& chosen_from);

}  // namespace brisance
