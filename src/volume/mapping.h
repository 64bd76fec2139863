// Maps the grids of a file to their roles by name, by preset, or automatically. The choice is always printed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "volume/settings.h"
#include "volume/vdb_file.h"

namespace brisance {

struct GridChoice {
    std::string name;
    int index = 0;
    std::string reason;             // "named by the shot", "preset embergen", "automatic: name matches 'density'"
    std::string shot_name() const;  // as a shot names it: "name" or "name[index]"
};

struct GridMapping {
    std::optional<GridChoice> density;
    std::optional<GridChoice> temperature;
    std::optional<GridChoice> flame;
    std::optional<GridChoice> colour;
    std::vector<GridChoice> colour_parts;  // three grids of one channel each, instead of `colour`; or none
    std::vector<std::string> notes;        // ambiguities and grids left unused, one line each
    std::string describe() const;          // one line: density <- "density", flame <- "flames", ...
};

// Throws Error BadData when no grid can serve as density, flame or temperature (the message lists every grid and why
// not), or when the shot names a grid that is absent (the message names those that are there) or unusable.
GridMapping map_grids(const std::vector<GridInfo>& grids, const VolumeSettings& settings, const std::string& file);

// The grid that a shot calls `text`, "name" or "name[index]"; null: there is none.
const GridInfo* find_named_grid(const std::vector<GridInfo>& grids, const std::string& text);

}  // namespace brisance
