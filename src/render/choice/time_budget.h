// --seconds: the settings of least error for a time.
//
// The lighting grid has steps from coarse to fine. Their times are forecast from counts (forecast/costs.h), in seconds
// of one core; only how many of those this machine does in a second is timed (forecast/machine_speed.h). The finest
// step that fits is taken, with a margin since forecasts err. The path tracer stops by the clock, before the pass that
// would not fit. With surfaces and lamps the lights take a step, and the camera the samples that then fit
// (camera_time.h). Where method=auto leaves the choice, the method of less expected error is taken. A certificate's
// time is extra.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/progress.h"
#include "emitters/surroundings.h"
#include "medium/medium.h"
#include "shot/shot.h"
#include "statistics/statistics.h"

namespace brisance {

struct TimeBudget {
    double seconds = 0.0;  // of wall time, for a frame from its file to its picture
    double spent = 0.0;    // of them, before the choice
    double speed = 1.0;    // machine_speed()
};

struct TimedSettings {
    Shot shot;               // with the settings of the choice, and no time asked for
    std::string reason;      // one line
    double seconds = 0.0;    // of wall time, forecast for the whole frame
    bool too_short = false;  // even the coarsest settings take longer
    // When the camera of a set has to be done, in seconds of the frame: its samples are chosen once the lights are
    // there (camera_time.h). None: the settings say how many there are.
    std::optional<double> camera_end;
    StageCost cost;  // of the choice
};

// Settings of the step of the lighting grid, from 0, the coarsest.
int step_count();
Shot with_step(Shot shot, int step);

// A notice says what was chosen; warnings say that the time is too short, or that nothing could be forecast.
TimedSettings settings_for_time(const Shot& shot, const Medium& medium, const Surroundings* surroundings,
                                const CameraSettings& camera, const TimeBudget& budget, Progress& progress);

// The same for a frame that is not loaded, whose file may be empty (frame_input.h). Throws Error.
TimedSettings settings_for_time(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& progress);

}  // namespace brisance
