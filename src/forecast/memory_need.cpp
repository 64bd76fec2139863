#include "forecast/memory_need.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "core/error.h"

namespace brisance {

namespace {

constexpr std::uint64_t kBytesOfNode = 150, kBytesOfDirectionalNode = 560;
// Maps of all levels, where a light of the finest stands for eight nodes: no more than this for each node.
constexpr std::uint64_t kMapBytesOfNode = 1500;
// Where light has a lattice of its own: what is left of it when the camera begins, light at the medium's nodes, and the
// same as the camera samples it, if all smoke is seen.
constexpr std::uint64_t kBytesOfLitNode = 40, kBytesOfSources = 24, kBytesOfSeenNode = 92;

std::uint64_t nodes_of_level(const BrickLattice& lattice, int level) {
    std::vector<ivec3> bricks(lattice.brick_count());
    for (std::size_t b = 0; b < bricks.size(); ++b)
        bricks[b] = lattice.brick(b) >> level;
    return BrickLattice(std::move(bricks)).node_count();
}

double gibibytes(std::uint64_t bytes) {
    return double(bytes) / double(std::uint64_t{1} << 30);
}

}  // namespace

std::uint64_t bytes_to_light(const Medium& medium, bool directional, std::uint64_t map_bytes, int level) {
    const std::uint64_t own = medium.lattice.node_count(),
                        of_node = directional ? kBytesOfDirectionalNode : kBytesOfNode;
    const std::uint64_t nodes = level > 0 ? nodes_of_level(medium.lattice, level) : own;
    const std::uint64_t lighting = nodes * of_node + std::min(map_bytes, nodes * kMapBytesOfNode);
    return level == 0 ? lighting
                      : std::max(lighting + own * kBytesOfSources, nodes * kBytesOfLitNode + own * kBytesOfSeenNode);
}

void check_memory(const Medium& medium, std::uint64_t needed, std::optional<std::uint64_t> available) {
    if (!available || needed <= *available)
        return;
    throw Error(
        ExitCode::Temporary,
        fmt::format("to light {:.1f} million nodes takes about {:.1f} GiB of memory and {:.1f} GiB are available; "
                    "a higher lighting.lattice_level, a lower lighting.memory_limit_mebibytes or fewer frames at once "
                    "may make it fit, and method=path takes far less",
                    double(medium.lattice.node_count()) / 1e6, gibibytes(needed), gibibytes(*available)));
}

}  // namespace brisance
