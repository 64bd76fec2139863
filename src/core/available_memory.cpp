#include "core/available_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace brisance {

namespace {

// The number that follows `name` at the beginning of a line.
std::optional<std::uint64_t> entry(const std::filesystem::path& file, const std::string& name) {
    std::ifstream in(file);
    std::string key, rest;
    for (std::uint64_t value = 0; in >> key >> value; std::getline(in, rest))
        if (key == name)
            return value;
    return std::nullopt;
}

std::optional<std::uint64_t> number_in(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::uint64_t value = 0;
    return in >> value ? std::optional<std::uint64_t>(value) : std::nullopt;  // "max": no limit
}

}  // namespace

std::optional<std::uint64_t> available_memory_in(const std::filesystem::path& root) {
    std::optional<std::uint64_t> least = entry(root / "proc/meminfo", "MemAvailable:");
    if (least)
        *least *= 1024;
    const std::filesystem::path group = root / "sys/fs/cgroup";
    const auto most = number_in(group / "memory.max"), used = number_in(group / "memory.current");
    if (!most || !used)
        return least;
    // Files that were read count as used, but make room.
    const std::uint64_t held = *used - std::min(*used, entry(group / "memory.stat", "inactive_file").value_or(0));
    return std::min(least.value_or(std::numeric_limits<std::uint64_t>::max()), *most > held ? *most - held : 0);
}

std::optional<std::uint64_t> available_memory() {
    return available_memory_in("/");
}

}  // namespace brisance
