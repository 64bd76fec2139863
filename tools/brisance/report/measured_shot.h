// One shot of `brisance report`: opened, and all its methods measured against a reference.
#pragma once

#include <vector>

#include "core/progress.h"
#include "methods.h"
#include "page_pictures.h"
#include "report.h"
#include "report_command.h"
#include "shot/shot.h"
#include "volume/frame_path.h"

namespace brisance {

struct OpenedShot {
    Shot shot;
    FrameFile frame;
};

// Reads the shot and finds its frame. Throws Error: whatever load_shot does, and Usage where there are several frames.
OpenedShot open_shot(const ReportOptions& options, Progress& progress);

struct MeasuredShot {
    Report report;
    PagePictures pictures;
};

enum class Comparing {
    All,    // every method; one that fails ends the report
    Owners  // those that own a cell which the shot needs (Method::cells); one that fails becomes a failure
};

// Throws Error; with `Owners` also where no method is left.
MeasuredShot measure_shot(const ReportOptions& options, const OpenedShot& opened, const std::vector<Method>& methods,
                          Comparing comparing, Progress& progress);

}  // namespace brisance
