// Reads the grids of one volume at one time.
#pragma once

#include <filesystem>

#include "core/progress.h"
#include "medium/medium.h"
#include "render/input/volume_in_time.h"
#include "retiming/source_frame.h"
#include "volume/read_ahead.h"
#include "volume/settings.h"

namespace brisance {

// One volume of a frame, and what the shot says of it.
struct VolumePart {
    SourceFiles files;
    VolumeSettings settings;
    MediumSettings look;
    TimeSettings time;
    VelocitySettings velocity;
    bool blurred = false;  // the shutter is open: velocity is read where there is one
    dmat4 carried{0.0};    // velocity by what carries it (carried_volume.h)
    MediumGrids grids{};
};

struct ReadVolume {
    std::string mapping;                  // in words
    std::uint64_t bytes = 0;              // of the grids
    std::vector<GridName> names;          // read of the file; none where there were two
    std::optional<double> seconds_ahead;  // that it took to read, where that was done before
};

// Reads the grids that the part's look needs, in the world's space: those of one file as they are, or a time between
// two. Velocity is read only where it moves them or blurs them. `ahead`: files that were read before, or null. Throws
// Error.
ReadVolume read_volume(VolumePart& part, ReadAhead* ahead, Progress& progress);

// The field by which retiming is chosen: density, or the first other one that the look needs.
struct DecidingField {
    std::string name;  // the role
    std::size_t role = 0;
    bool has_velocity = false;
    std::string why_no_velocity;
};

// From the headers of the sequence's largest file.
DecidingField deciding_field(const std::string& pattern, const std::vector<int>& on_disk,
                             const VolumeSettings& settings, const MediumSettings& look);

// That field alone, with the velocity where there is one.
SourceFrame read_deciding(const std::filesystem::path& file, const VolumeSettings& settings, const DecidingField& field,
                          Progress& progress);

}  // namespace brisance
