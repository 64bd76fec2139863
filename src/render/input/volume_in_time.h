// Which files of its sequences a frame of the picture is made from, and how.
#pragma once

#include <filesystem>
#include <string>

#include "core/progress.h"
#include "shot/shot.h"
#include "time_mapping/source_time.h"

namespace brisance {

struct SourceFiles {
    std::filesystem::path first, second;  // the same where one file is shown as it is; empty: nothing is there
    SourceTime time;
    bool single() const { return first == second; }
    const std::filesystem::path& nearest() const { return time.weight < 0.5 ? first : second; }
};

// One volume: its path or pattern, seen from the current folder, and its times. A path without frame token is a volume
// that stands still. Throws Error MissingInput for a missing frame, as source_time.
SourceFiles source_files(const std::string& pattern, const TimeSettings& time, double frame);

// The shot's own volume; no file where it has none. Throws as source_files, and Usage when times are given and no
// volume of the shot is a sequence.
SourceFiles own_files(const Shot& shot, double frame);

// Further volumes: their times, where they are not the shot's, and their velocity.
const TimeSettings& time_of(const Shot& shot, const FurtherVolume& volume);
const VelocitySettings& velocity_of(const Shot& shot, const FurtherVolume& volume);

// Frames of the picture when nobody asks for certain ones; the shot's volume is a sequence.
std::vector<int> covering_frames(const Shot& shot);

// The shot with what is automatic settled for all of its sequences: time.retime and velocity.unit, from a few of their
// frames, which do not depend on the frames that are rendered. Volumes whose times are always whole frames are left as
// they are, and nothing is read. Throws Error as choose_retiming.
Shot settle_time(const Shot& shot, Progress& progress);

// The files whose grids it reads: none of sequences that are settled, or that cannot be read.
std::vector<std::filesystem::path> files_to_settle_time(const Shot& shot);

// Whether `time` and `velocity` leave nothing to settle.
bool is_settled(const TimeSettings& time, const VelocitySettings& velocity);

}  // namespace brisance
