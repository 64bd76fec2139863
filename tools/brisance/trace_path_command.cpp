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
    const auto asked = options.frames.empty() ? std::nullopt : std::optional(parse_frames(options.frames));
    const std::vector<FrameFile> frames = resolve_frames(shot, asked);
    if (frames.size() != 1)
        throw Error(ExitCode::Usage,
                    fmt::format("a path belongs to one frame, not to {}; choose it with -f", frames.size()));
    return frames.front();
}

const char* cell_name(int order) {
    return order == 0 ? "V" : order == 1 ? "MV" : "MM";
}

std::string order_name(int order) {
    return fmt::format("{}{} {}", order, order + 1 == kPathOrders ? "+" : "", cell_name(order));
}

template <class T>
std::string triple(const T& v) {
    return fmt::format("{} {} {}", v.x, v.y, v.z);
}

std::string place(const dvec3& p) {
    return fmt::format("{:.9g} {:.9g} {:.9g}", p.x, p.y, p.z);
}

void print_vertices(const TracedPath& path) {
    fmt::print(
        "vertices: scatterings, place [m], throughput, radiance gathered along the segment that leaves it and "
        "by a line toward the fire:\n");
    for (const TracedVertex& vertex : path.vertices)
        fmt::print("  {:<6} at {}  throughput {}  along {}  from fire {}{}\n",
                   fmt::format("{} {}", vertex.order, cell_name(vertex.order)), place(vertex.position),
                   triple(vertex.throughput), triple(vertex.along_segment), triple(vertex.from_fire),
                   finite(vertex) ? "" : "  NOT FINITE");
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
            fmt::print("  {:<6} {}\n", order_name(order), triple(path.orders[order]));
    fmt::print("{}\n", path.finite() ? "finite" : "NOT FINITE");
    return static_cast<int>(path.finite() ? ExitCode::Success : ExitCode::RenderFailed);
}

}  // namespace brisance
