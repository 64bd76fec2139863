// What a first look is decided from: where the smoke and the fire of a few frames are, and how much of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/vec.h"
#include "volume/frame_path.h"
#include "volume/mapping.h"
#include "volume/settings.h"

namespace brisance {

// A grid's values in one frame, over its voxels above zero.
struct ValueSummary {
    std::uint64_t voxels = 0;  // above zero
    double most = 0.0;         // 99.9th percentile: a few wild voxels do not count
    double mean = 0.0;
};

// A cube of voxels. Absent grids read as 0.
struct SurveyCell {
    ivec3 index{0};
    float density = 0.0f;      // mean, zeros included
    float flame = 0.0f;        // mean of the voxels above zero ...
    float flame_share = 0.0f;  // ... and their share of the cell
    float temperature = 0.0f;  // as stored, mean of the voxels above zero
};

struct FrameSurvey {
    int frame = 0;
    dmat4 world_from_cell{1.0};     // the middle of a cell, in the file's space
    std::vector<SurveyCell> cells;  // in the order of their indices; at most some 10^5
    std::optional<ValueSummary> density, flame, temperature;
};

struct SequenceSurvey {
    std::string name;               // of the file or its pattern, without folders
    std::string writer;             // that the files name, or that their marks give away; empty: unknown
    GridMapping mapping;            // of the frame that holds most
    bool mapping_of_all = true;     // every file on disk has the grids of `mapping`
    std::vector<int> frames;        // on disk, sorted
    std::vector<FrameSurvey> seen;  // of them, sorted; those that were read
    std::vector<std::string> notes;
};

// Frames to look at: first, last, the quarters between, and the largest file. Sorted, each once.
std::vector<FrameFile> telling_frames(const std::vector<FrameFile>& all);

// Reads the telling frames, and where no flame burns in them while others have one, the first of those. Depends on
// the files on disk alone. Frames that cannot be read are left out with a warning. Throws Error when none can.
SequenceSurvey survey_sequence(const std::string& pattern, const VolumeSettings& settings, Progress& progress);

// One frame from its grids; `density`, `flame` and `temperature` may be null.
FrameSurvey survey_frame(int frame, const BlockGrid* density, const BlockGrid* flame, const BlockGrid* temperature);

}  // namespace brisance
