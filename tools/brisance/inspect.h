// `brisance inspect`: the grids of a .vdb file, the roles they would play, and a shot to begin with.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "first_look/look.h"
#include "inspect_velocity.h"
#include "volume/mapping.h"
#include "volume/vdb_file.h"

namespace brisance {

struct InspectedGrid {
    GridInfo info;
    GridCensus census;    // with a histogram
    std::string problem;  // why its voxels cannot be read; empty when they can
};

struct Inspection {
    std::filesystem::path file;  // absolute
    std::uint64_t file_bytes = 0;
    std::vector<InspectedGrid> grids;
    std::optional<GridMapping> mapping;
    std::string why_no_mapping;                 // set when there is none
    std::string volumes;                        // what the look is for: the file, or the pattern of its sequence
    std::optional<Look> look;                   // set where there is a mapping
    std::string pattern;                        // of the sequence the file belongs to; empty when it stands alone
    std::vector<int> frames;                    // of that sequence, on disk
    std::optional<InspectedVelocity> velocity;  // where it was asked for: it may read several frames
};

// The file that says most about a sequence: the largest, since the first frame of an explosion is often empty. A
// pattern without frame token is the file itself. Throws Error MissingInput when there is none.
std::filesystem::path telling_file(const std::string& pattern);

// Throws Error MissingInput or BadData when the file as a whole cannot be read.
Inspection inspect_file(const std::filesystem::path& file);

std::string inspection_text(const Inspection& inspection);
std::string inspection_json(const Inspection& inspection);

// A shot in JSON made of the look; empty when there is none.
std::string suggested_shot(const Inspection& inspection);

struct InspectOptions {
    std::string input;       // a .vdb, a pattern or a folder
    std::string write_look;  // file to write the first look to; empty: none
    bool as_json = false;
};

// Prints to standard output; of a sequence, the file that says most, and the look of the whole. Returns the exit code:
// 0, or that of BadData when nothing in the file can be rendered. Throws as inspect_file.
int run_inspect(const InspectOptions& options);

}  // namespace brisance
