// How much memory and time a file may cost before it counts as damaged.
#pragma once

#include <cstdint>

#include "volume/child/child_process.h"

namespace brisance {

// Of memory, 8^3 voxels take 2 to 12 KiB, but at least 137 bytes of a file, for two masks and the size of their packed
// values: 100 bytes for each byte. OpenVDB unpacks about 100 MiB/s: 1 s for each MiB of the file.
inline ChildLimits read_limits(std::uint64_t file_bytes) {
    constexpr std::uint64_t least = std::uint64_t{256} << 20, per_byte = 100, mebibyte = std::uint64_t{1} << 20;
    return {least + per_byte * file_bytes, static_cast<int>(5 + file_bytes / mebibyte)};
}

}  // namespace brisance
