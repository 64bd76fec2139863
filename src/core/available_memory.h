// How much memory this process may still take.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace brisance {

// Bytes that the machine has available, or that the limit of the process's control group leaves, whichever is less.
// None where the system does not say.
std::optional<std::uint64_t> available_memory();

// The same from a copy of those files: `root`/proc/meminfo and `root`/sys/fs/cgroup/memory.{max,current,stat}.
std::optional<std::uint64_t> available_memory_in(const std::filesystem::path& root);

}  // namespace brisance
