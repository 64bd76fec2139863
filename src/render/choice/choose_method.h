// method=auto: the lighting grid or the path tracer, whichever is likely to reach lighting.error sooner.
//
// Both times are forecast from counts, never from a clock, so that a shot takes the same method on any machine that has
// the memory for both, and however many threads there are. The lighting grid's time is that of its nodes and of the
// camera's rays. The path tracer's is that of the paths it needs: a pilot of a few pixels measures their variance,
// which falls as one over their number, and their length. Forecasts are of one core, and may be wrong by a factor of
// two (docs/numbers.md): where the two times are close, either method may be chosen.
//
// Surfaces and lamps are not forecast: shots with them take the lighting grid. In all that were measured it has its
// error in half the time of paths, or less (docs/numbers.md).
#pragma once

#include <filesystem>
#include <string>

#include "camera/settings.h"
#include "core/progress.h"
#include "emitters/surroundings.h"
#include "medium/medium.h"
#include "shot/shot.h"
#include "statistics/statistics.h"

namespace brisance {

struct MethodForecast {
    RenderMethod method = RenderMethod::LightingGrid;
    std::string reason;         // one line
    double grid_seconds = 0.0;  // of one core; both 0 where nothing was forecast
    double path_seconds = 0.0;
    double samples = 0.0;  // camera rays per pixel that paths need
    StageCost cost;        // of the forecast
    const char* name() const { return method == RenderMethod::Path ? "path" : "lighting_grid"; }
};

MethodForecast forecast_methods(const Shot& shot, const Medium& medium, const Surroundings* surroundings,
                                const CameraSettings& camera, Progress& progress);

// The same for a frame that is not loaded, whose file may be empty (frame_input.h). Throws Error.
MethodForecast forecast_methods(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& progress);

// The shot with the chosen method. Paths are traced until their standard error is lighting.error, or tracing.error
// where the shot states one; tracing.samples does not count.
Shot with_method(Shot shot, const MethodForecast& forecast);

}  // namespace brisance
