// Renders every step of every method and measures it.
#pragma once

#include <exception>
#include <set>
#include <string>
#include <vector>

#include "core/progress.h"
#include "page_pictures.h"
#include "reference.h"
#include "render/input/frame_input.h"
#include "report.h"
#include "shot/shot.h"

namespace brisance {

// One render that is to be measured.
struct PlannedRun {
    MethodStep step;
    std::vector<std::string> settings;  // of method and step, applied to the shot
    Shot shot;
};

struct PlannedMethod {
    Method method;
    std::vector<PlannedRun> runs;
};

// Returns the shots of all runs, made from the given one. Throws Error Usage for settings that no shot accepts, and for
// those that would change the true picture rather than its computation. Path-traced runs whose seed is `taken` get
// another.
std::vector<PlannedMethod> plan_runs(const Shot& shot, const std::vector<Method>& methods,
                                     const std::set<int>& taken = {});

// The smallest seed that is not taken.
int free_seed(const std::set<int>& taken);

// `shot` with settings over it; `source` stands for it in messages.
Shot shot_with(const Shot& shot, const std::string& source, const std::vector<std::string>& settings);

// The first line of what an exception says.
std::string reason_of(const std::exception& error);

class FilmStrips;

struct MeasureOptions {
    int repeats = 1;          // renders of each step, with other seeds (repeats.h); its time is their median
    bool keep_going = false;  // a render that fails ends its method, as one of the report's failures, and nothing else
    bool few_pictures = false;     // of the last step of a method alone: its picture, and the cells that it owns
    FilmStrips* strips = nullptr;  // receives the first step of every method as the first frame
};

// The methods that `plan_runs` accepts; the others become failures of `report`.
std::vector<PlannedMethod> plan_what_can_run(const Shot& shot, const std::vector<Method>& methods,
                                             const std::set<int>& taken, Report& report);

// Adds the runs' results to `report`, whose reference is set, and their pictures to `pictures`.
void measure_runs(const std::vector<PlannedMethod>& methods, const FrameInput& input, const ReportReference& reference,
                  const MeasureOptions& options, Report& report, PagePictures& pictures, Progress& progress);

}  // namespace brisance
