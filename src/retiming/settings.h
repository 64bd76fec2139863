// How velocities of a file are read.
#pragma once

namespace brisance {

// What one unit of velocity means. Metres are those of the file's own space.
enum class VelocityUnit {
    Automatic,    // fitted: how far the smoke does move between neighbouring frames
    Second,       // m/s
    Frame,        // m per frame
    VoxelSecond,  // voxels of the velocity grid per second
    VoxelFrame    // voxels of the velocity grid per frame
};

struct VelocitySettings {
    VelocityUnit unit = VelocityUnit::Automatic;
    double scale = 1.0;               // multiplies all velocities
    double frames_per_second = 24.0;  // of the sequence; of the units per second
};

}  // namespace brisance
