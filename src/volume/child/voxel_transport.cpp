#include "volume/child/voxel_transport.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace brisance {
namespace {

constexpr std::size_t kVoxels = BlockGrid::kBlock * BlockGrid::kBlock * BlockGrid::kBlock;
constexpr std::uint32_t kNoVoxels = std::variant_size_v<AnyRawGrid>;

template <class T>
std::size_t leaves_per_turn(int channels) {
    return kTurnBytes / (kVoxels * static_cast<std::size_t>(channels) * sizeof(T));
}

template <class T>
T* half(std::span<std::byte> halves, std::size_t turn) {
    return reinterpret_cast<T*>(halves.data() + (turn % 2) * kTurnBytes);
}

void check_leaf(const RawLeaf& leaf) {
    if (glm::any(glm::notEqual(leaf.origin & (BlockGrid::kBlock - 1), ivec3(0))))
        throw std::out_of_range("origin of a leaf");
}

template <class T>
void check_tile(const RawTile<T>& tile) {
    if (tile.width <= 0 || tile.width % BlockGrid::kBlock != 0 ||
        glm::any(glm::notEqual(tile.origin & (BlockGrid::kBlock - 1), ivec3(0))))
        throw std::out_of_range("a tile");
}

template <class T>
void send_values_of(const LoadedVoxels<T>& voxels, std::span<std::byte> halves, const Line& line) {
    const std::size_t per_turn = leaves_per_turn<T>(voxels.channels);
    const std::size_t per_leaf = kVoxels * static_cast<std::size_t>(voxels.channels);
    const std::size_t turns = (voxels.values.size() + per_turn - 1) / per_turn;
    char sign = 0;
    for (std::size_t turn = 0; turn < turns; ++turn) {
        if (turn >= 2 && !line.receive(&sign, 1))
            return;
        T* to = half<T>(halves, turn);
        const std::size_t end = std::min((turn + 1) * per_turn, voxels.values.size());
        for (std::size_t i = turn * per_turn; i < end; ++i, to += per_leaf)
            std::memcpy(to, voxels.values[i], per_leaf * sizeof(T));
        if (!line.send(&sign, 1))
            return;
    }
    for (std::size_t left = std::min<std::size_t>(turns, 2); left > 0; --left)
        line.receive(&sign, 1);
}

template <class T>
void visit_turns(const Turns& turns, std::size_t leaves, std::size_t per_turn, const VisitLeaves<T>& visit) {
    turns.begin();
    for (std::size_t turn = 0; turn * per_turn < leaves; ++turn) {
        turns.receive_turn();
        const std::size_t first = turn * per_turn;
        visit(first, std::min(per_turn, leaves - first), half<T>(turns.halves, turn));
        turns.return_turn();
    }
}

template <class T>
RawGrid<T> get_voxels(SharedReader& in, const Turns& turns) {
    RawGrid<T> grid;
    grid.channels = in.get<int>();
    if (grid.channels != 1 && grid.channels != 3)
        throw std::out_of_range("channels");
    const std::span<const RawLeaf> leaves = in.array<RawLeaf>(in.get<std::uint64_t>());
    const std::span<const RawTile<T>> tiles = in.array<RawTile<T>>(in.get<std::uint64_t>());
    grid.leaves.assign(leaves.begin(), leaves.end());
    grid.tiles.assign(tiles.begin(), tiles.end());
    std::for_each(grid.leaves.begin(), grid.leaves.end(), check_leaf);
    std::for_each(grid.tiles.begin(), grid.tiles.end(), check_tile<T>);
    const auto unsorted = [](const RawLeaf& a, const RawLeaf& b) { return !comes_before(a.origin, b.origin); };
    if (std::adjacent_find(grid.leaves.begin(), grid.leaves.end(), unsorted) != grid.leaves.end())
        throw std::out_of_range("order of leaves");
    grid.visit_leaves = [turns, count = leaves.size(), per_turn = leaves_per_turn<T>(grid.channels)](
                            const VisitLeaves<T>& visit) { visit_turns(turns, count, per_turn, visit); };
    return grid;
}

template <std::size_t N = 0>
AnyRawGrid get_any_voxels(SharedReader& in, const Turns& turns, std::uint32_t type) {
    if constexpr (N < kNoVoxels) {
        using Value = typename std::variant_alternative_t<N, AnyRawGrid>::Value;
        if (type == N)
            return get_voxels<Value>(in, turns);
        return get_any_voxels<N + 1>(in, turns, type);
    }
    throw std::out_of_range("type of voxels");
}

}  // namespace

void put_info(SharedWriter& out, const GridInfo& info) {
    out.put_text(info.name);
    out.put(info.index);
    out.put_text(info.value_type);
    out.put_text(info.grid_class);
    out.put(info.usable ? 1 : 0);
    out.put_text(info.why_unusable);
    out.put(info.world_from_index);
    out.put(info.affine ? 1 : 0);
    out.put(info.active_min);
    out.put(info.active_max);
    out.put_text(info.creator);
}

GridInfo get_info(SharedReader& in) {
    GridInfo info;
    info.name = in.get_text();
    info.index = in.get<int>();
    info.value_type = in.get_text();
    info.grid_class = in.get_text();
    info.usable = in.get<int>() != 0;
    info.why_unusable = in.get_text();
    info.world_from_index = in.get<dmat4>();
    info.affine = in.get<int>() != 0;
    info.active_min = in.get<ivec3>();
    info.active_max = in.get<ivec3>();
    info.creator = in.get_text();
    return info;
}

void put_grid(SharedWriter& out, const LoadedGrid& grid) {
    out.put(grid.active_voxels);
    out.put(grid.active_tiles);
    out.put(grid.voxels ? static_cast<std::uint32_t>(grid.voxels->index()) : kNoVoxels);
    if (!grid.voxels)
        return;
    std::visit(
        [&](const auto& voxels) {
            using Value = typename std::decay_t<decltype(voxels)>::Value;
            out.put(voxels.channels);
            out.template put<std::uint64_t>(voxels.leaves.size());
            std::copy(voxels.leaves.begin(), voxels.leaves.end(), out.template array<RawLeaf>(voxels.leaves.size()));
            out.template put<std::uint64_t>(voxels.tiles.size());
            std::copy(voxels.tiles.begin(), voxels.tiles.end(),
                      out.template array<RawTile<Value>>(voxels.tiles.size()));
        },
        *grid.voxels);
}

void send_values(const AnyLoadedVoxels& voxels, std::span<std::byte> halves, const Line& line) {
    std::visit([&](const auto& of_type) { send_values_of(of_type, halves, line); }, voxels);
}

ReceivedGrid get_grid(SharedReader& in, const Turns& turns) {
    ReceivedGrid grid;
    grid.census.active_voxels = in.get<std::uint64_t>();
    grid.census.active_tiles = in.get<std::uint64_t>();
    const auto type = in.get<std::uint32_t>();
    if (type != kNoVoxels)
        grid.voxels = get_any_voxels(in, turns, type);
    return grid;
}

}  // namespace brisance
