#include "trace_path_command.h"

#include <fmt/format.h>

#include <optional>

#include "core/error.h"
#include "core/parallel.h"
#include "load_shot.h"
#include "render/trace_path.h"

namespace brisance {
namespace {

FrameFile only_frame(const Shot& shot, const TracePathOptions& options) {
    const auto requested = options.frames.empty() ? std::nullopt : std::optional(parse_frames(options.frames));
    const std::vector<FrameFile> frames = resolve_frames(shot, requested);
    if (frames.size() != 1)
        throw Error(ExitCode::Usage,
                    fmt::format("a path belongs to one frame, not to {}; choose it with -f", frames.size()));
    return frames.front();
}

const char* cell_name(int order) {
    return order == 0 ? "V" : order == 1 ? "MV" : "MM";
}

std::string order_name(int order, bool has_cells) {
    return fmt::format("{}{} {}", order, order + 1 == kPathOrders ? "+" : "", has_cells ? "" : cell_name(order));
}

// With surroundings the number of scatterings does not determine the cell.
std::string vertex_name(const TracedVertex& vertex, bool has_cells) {
    return has_cells ? std::to_string(vertex.order) : fmt::format("{} {}", vertex.order, cell_name(vertex.order));
}

template <class T>
std::string triple(const T& v) {
    return fmt::format("{} {} {}", v.x, v.y, v.z);
}

std::string coordinates(const dvec3& p) {
    return fmt::format("{:.9g} {:.9g} {:.9g}", p.x, p.y, p.z);
}

void print_vertices(const TracedPath& path) {
    fmt::print(
        "vertices: scatterings, position [m], throughput, radiance gathered along the segment that leaves it, by a "
        "line "
        "toward the fire, and by a ray toward an emitter:\n");
    for (const TracedVertex& vertex : path.vertices)
        fmt::print("  {:<6} {} {}  throughput {}  along {}  from fire {}  from emitters {}{}\n",
                   vertex_name(vertex, path.has_cells), vertex.on_surface ? "on a surface at" : "at",
                   coordinates(vertex.position), triple(vertex.throughput), triple(vertex.along_segment),
                   triple(vertex.from_fire), triple(vertex.from_emitters), finite(vertex) ? "" : "  NOT FINITE");
}

}  // namespace

int run_trace_path(const TracePathOptions& options) {
    TextProgress progress(options.progress);
    const ThreadLimit limit(options.threads);
    const Shot shot = load_shot(options.input, {options.preset, options.overrides}, progress);
    const FrameFile frame = only_frame(shot, options);
    const TracedPath path = trace_path(shot, frame.file, frame.frame, options.x, options.y, options.sample, progress);
    progress.finish();
    fmt::print("frame {}, pixel {} {}, sample {} (half {})\n", frame.frame, options.x, options.y, options.sample,
               options.sample % 2 == 0 ? "A" : "B");
    fmt::print("ray from {} m along {}\n", triple(path.ray.origin), triple(path.ray.direction));
    print_vertices(path);
    fmt::print("{} scatterings followed; radiance R G B [W/(m^2 sr)] by scatterings:\n", path.scatterings);
    for (int order = 0; order < kPathOrders; ++order)
        if (path.orders[order] != Rgb(0.0f))
            fmt::print("  {:<6} {}\n", order_name(order, path.has_cells), triple(path.orders[order]));
    for (int cell = 0; cell < kCells && path.has_cells; ++cell)
        if (path.orders.cells[cell] != Rgb(0.0f))
            fmt::print("  {:<6} {}\n", kCellNames[cell], triple(path.orders.cells[cell]));
    fmt::print("{}\n", path.finite() ? "finite" : "NOT FINITE");
    return static_cast<int>(path.finite() ? ExitCode::Success : ExitCode::RenderFailed);
}

}  // namespace brisance
