#include "farm/frame_chunk.h"

#include <fmt/format.h>

#include "core/error.h"

namespace brisance {

std::vector<int> frame_chunk(const std::vector<int>& frames, int index, int count) {
    if (count < 1)
        throw Error(ExitCode::Usage, fmt::format("--task-count {}: there is at least 1 task", count));
    if (index < 0 || index >= count)
        throw Error(ExitCode::Usage, fmt::format("--task-index {}: of {} task{}, the index goes from 0 to {}", index,
                                                 count, count == 1 ? "" : "s", count - 1));
    const auto begin_of = [&](int task) {
        return static_cast<std::ptrdiff_t>(frames.size() * static_cast<std::size_t>(task) /
                                           static_cast<std::size_t>(count));
    };
    return {frames.begin() + begin_of(index), frames.begin() + begin_of(index + 1)};
}

int tasks_for(std::size_t frames, int per_task) {
    const auto each = static_cast<std::size_t>(per_task < 1 ? 1 : per_task);
    return static_cast<int>((frames + each - 1) / each);
}

}  // namespace brisance
