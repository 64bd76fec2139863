#include "forecast/memory_need.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"

namespace brisance {

namespace {

constexpr std::uint64_t kBytesOfNode = 150, kBytesOfDirectionalNode = 560;
// Maps of all levels, where a light of the finest stands for eight nodes: no more than this for each node.
constexpr std::uint64_t kMapBytesOfNode = 1500;

double gibibytes(std::uint64_t bytes) {
    return double(bytes) / double(std::uint64_t{1} << 30);
}

}  // namespace

std::uint64_t bytes_to_light(const Medium& medium, bool directional, std::uint64_t map_bytes) {
    const std::uint64_t nodes = medium.lattice.node_count();
    return nodes * (directional ? kBytesOfDirectionalNode : kBytesOfNode) +
           std::min(map_bytes, nodes * kMapBytesOfNode);
}

void check_memory(const Medium& medium, std::uint64_t needed, std::optional<std::uint64_t> available) {
    if (!available || needed <= *available)
        return;
    throw Error(
        ExitCode::Temporary,
        fmt::format("to light {:.1f} million nodes takes about {:.1f} GiB of memory and {:.1f} GiB are available; "
                    "a lower lighting.memory_limit_mebibytes or fewer frames at once may make it fit, and "
                    "method=path takes far less",
                    double(medium.lattice.node_count()) / 1e6, gibibytes(needed), gibibytes(*available)));
}

}  // namespace brisance
