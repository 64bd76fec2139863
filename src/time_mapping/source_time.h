// From a frame of the picture to a time of a sequence, and to the frames on disk around it. Knows no file.
#pragma once

#include <string>
#include <vector>

#include "time_mapping/settings.h"

namespace brisance {

struct SourceTime {
    bool empty = false;  // nothing is there at this time
    int first = 0;       // frames on disk around the time; both are the same where one frame is shown as it is
    int second = 0;
    double weight = 0.0;  // of `second`, in [0, 1)
    double rate = 1.0;    // frames of the sequence per frame of the picture; negative: backward, 0: held
    bool single() const { return first == second; }
    int nearest() const { return weight < 0.5 ? first : second; }
};

// The time that `settings` give a frame of the picture, before its ends and holes are looked at. `first_on_disk` is
// where `speed` counts from.
double unbounded_time(const TimeSettings& settings, double frame, int first_on_disk);

// `on_disk`: sorted and not empty. A time within a millionth of a whole frame is that frame. Repetition is a cut: the
// last frame is not mixed with the first. Throws Error MissingInput, beginning with `where`, when the time lies beyond
// an end or in a hole and the settings call that an error.
SourceTime source_time(const TimeSettings& settings, double frame, const std::vector<int>& on_disk,
                       const std::string& where);

// Frames of the picture that show the sequence when nobody asks for certain ones: those of the curve, or those whose
// time lies between the sequence's ends; one where time stands still. Those that would show a missing frame are left
// out where `missing` is an error, as all frames of a sequence are those on disk. Throws Error Usage, beginning with
// `where`, where that has no end.
std::vector<int> covering_frames(const TimeSettings& settings, const std::vector<int>& on_disk,
                                 const std::string& where);

// Whether some frame of the picture may need two frames of the sequence; depends on no certain frame.
bool may_interpolate(const TimeSettings& settings, const std::vector<int>& on_disk);

}  // namespace brisance
