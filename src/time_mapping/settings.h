// Which time of a sequence a frame of the picture shows.
#pragma once

#include <vector>

namespace brisance {

// What is shown of times before the first or after the last frame on disk.
enum class BeyondEnd { Error, Hold, Repeat, PingPong, Empty };

// What stands in for a frame that is not on disk while earlier and later ones are.
enum class MissingFrame { Error, Hold, Interpolate };

// How a time between two frames is made from them.
enum class Retime {
    Automatic,  // Linear or Advect, whichever predicts known frames of the sequence better
    Nearest,
    Linear,  // blends voxel by voxel
    Advect   // moves both frames along their velocity, and blends
};

struct TimePoint {
    double frame;   // of the picture
    double source;  // frame of the sequence, also between two
};

struct TimeSettings {
    double offset = 0.0;           // frames of the sequence, added to its time
    double speed = 1.0;            // frames of the sequence for each frame of the picture, from its first frame on
    std::vector<TimePoint> curve;  // instead of the speed; frames rise, source times do not fall; held beyond its ends
    BeyondEnd before = BeyondEnd::Error;
    BeyondEnd after = BeyondEnd::Error;
    MissingFrame missing = MissingFrame::Error;
    Retime retime = Retime::Automatic;

    // Frame n of the picture shows frame n of the sequence, which must be there.
    bool identity() const {
        return offset == 0.0 && speed == 1.0 && curve.empty() && before == BeyondEnd::Error &&
               after == BeyondEnd::Error && missing == MissingFrame::Error;
    }
};

}  // namespace brisance
