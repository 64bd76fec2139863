// The reference of a report's methods.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/progress.h"
#include "metrics/comparison.h"
#include "render/input/frame_input.h"
#include "report.h"
#include "shot/shot.h"

namespace brisance {

struct ReportReference {
    ReferenceSummary summary;
    std::map<std::string, Reference> layers;  // "" the beauty, and the ledger's cells it has
    std::set<int> seeds;  // of path tracing; a run with one of them would share its paths and seem better than it is
};

// Layers that a report compares, in this order: the beauty and the ledger's cells.
const std::vector<std::string>& report_layers();

// Both halves of a path-traced picture of `shot`, whose method, seed and stop are set.
ReportReference trace_reference(const Shot& shot, const FrameInput& input, Progress& progress);

// One EXR, or two independent halves. Throws Error MissingInput or BadData; the latter names all in which it differs
// from the shot: size, frame, scene.
ReportReference read_reference(const std::vector<std::filesystem::path>& files, const Shot& shot, int frame);

// The mean of its halves.
Picture mean_picture(const Reference& reference);

}  // namespace brisance
