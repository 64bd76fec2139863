// What it costs that a child process reads a VDB: all grids of a file as blocks, with the child and without, in turns.
//   brisance_reading FILE [RUNS]     least and median time of each [ms]
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/stopwatch.h"
#include "volume/child/read_vdb.h"
#include "volume/raw_grid.h"
#include "volume/vdb_file.h"

namespace brisance::benchmarks {
namespace {

constexpr std::uint64_t kNoLimit = std::numeric_limits<std::uint64_t>::max();

template <class T>
AnyRawGrid leaf_by_leaf(const LoadedVoxels<T>& voxels) {
    RawGrid<T> raw{voxels.channels, voxels.leaves, voxels.tiles, {}};
    raw.visit_leaves = [&voxels](const VisitLeaves<T>& visit) {
        for (std::size_t i = 0; i < voxels.values.size(); ++i)
            visit(i, 1, voxels.values[i]);
    };
    return raw;
}

std::size_t blocks_by_child(const std::filesystem::path& file) {
    VdbReader reader(file);
    std::size_t blocks = 0;
    for (const GridInfo& info : reader.grids())
        blocks += reader.read(info.name, info.index, kNoLimit).block_origin.size();
    return blocks;
}

std::size_t blocks_without(const std::filesystem::path& file) {
    const auto open = open_vdb(file);
    const std::vector<GridInfo> grids = open->grids();
    std::size_t blocks = 0;
    for (std::size_t k = 0; k < grids.size(); ++k) {
        const LoadedGrid loaded = open->load(k, kNoLimit);
        const AnyRawGrid raw = std::visit([](const auto& voxels) { return leaf_by_leaf(voxels); }, *loaded.voxels);
        blocks += expand_blocks(raw, grids[k], kNoLimit, file.string()).block_origin.size();
    }
    return blocks;
}

template <class Read>
double milliseconds(const Read& read, const std::filesystem::path& file, std::size_t& blocks) {
    const Stopwatch watch;
    blocks = read(file);
    return 1e3 * watch.seconds();
}

void print(const char* name, std::vector<double> times) {
    std::sort(times.begin(), times.end());
    std::printf("%-16s %9.2f %9.2f\n", name, times.front(), times[times.size() / 2]);
}

int run(const std::filesystem::path& file, int runs) {
    initialize_openvdb();
    std::vector<double> child, without;
    std::size_t blocks = 0, same = 0;
    for (int i = 0; i < runs; ++i) {
        child.push_back(milliseconds(blocks_by_child, file, blocks));
        without.push_back(milliseconds(blocks_without, file, same));
    }
    if (blocks != same)
        return 1;
    std::printf("%zu blocks, %d runs; ms    least    median\n", blocks, runs);
    print("child process", child);
    print("this process", without);
    return 0;
}

}  // namespace
}  // namespace brisance::benchmarks

int main(int argc, char** argv) {
    int runs = 20;
    const bool usable =
        argc == 2 ||
        (argc == 3 && std::from_chars(argv[2], argv[2] + std::strlen(argv[2]), runs).ec == std::errc() && runs > 0);
    if (!usable) {
        std::fputs("usage: brisance_reading FILE [RUNS]\n", stderr);
        return 2;
    }
    try {
        return brisance::benchmarks::run(argv[1], runs);
    } catch (const brisance::Error& error) {
        std::fprintf(stderr, "brisance_reading: %s\n", error.what());
        return static_cast<int>(error.code());
    }
}
