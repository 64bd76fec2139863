#include "volume/vector_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <tuple>

#include "core/error.h"
#include "core/printable.h"

namespace brisance {

namespace {

constexpr std::array<std::array<const char*, 3>, 5> kEndings = {
    {{"_r", "_g", "_b"}, {".r", ".g", ".b"}, {"_x", "_y", "_z"}, {".x", ".y", ".z"}, {"x", "y", "z"}}};
constexpr std::size_t kVoxels = BlockGrid::kBlock * BlockGrid::kBlock * BlockGrid::kBlock;

std::string lower_of(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool is_scalar(const GridInfo& grid) {
    return grid.usable && !grid.value_type.starts_with("vec3") && !grid.value_type.starts_with("int");
}

}  // namespace

std::optional<VectorParts> find_vector_parts(const std::vector<GridInfo>& grids, std::span<const std::string> stems) {
    for (const std::string& stem : stems)
        for (const auto& endings : kEndings) {
            VectorParts parts{};
            for (std::size_t c = 0; c < 3; ++c)
                for (const GridInfo& grid : grids)
                    if (parts[c] == nullptr && is_scalar(grid) && lower_of(grid.name) == stem + endings[c])
                        parts[c] = &grid;
            if (parts[0] && parts[1] && parts[2])
                return parts;
        }
    return std::nullopt;
}

BlockGrid join_vector_parts(const std::array<BlockGrid, 3>& parts, const std::string& where) {
    BlockGrid out;
    out.info = parts[0].info;
    out.info.value_type = "vec3s";
    out.census = parts[0].census;
    out.channels = 3;
    std::map<std::tuple<int, int, int>, std::size_t> blocks;
    for (const BlockGrid& part : parts) {
        if (part.channels != 1 || part.info.world_from_index != parts[0].info.world_from_index)
            throw Error(ExitCode::BadData,
                        fmt::format("{}: grids \"{}\" and \"{}\" are no parts of one vector: they lie on other voxels; "
                                    "write them with one transform",
                                    where, printable(parts[0].info.name, kLongestName),
                                    printable(part.info.name, kLongestName)));
        for (const ivec3& o : part.block_origin)
            blocks.emplace(std::tuple(o.x, o.y, o.z), 0);
    }
    for (auto& [origin, position] : blocks) {
        position = out.block_origin.size();
        out.block_origin.emplace_back(std::get<0>(origin), std::get<1>(origin), std::get<2>(origin));
    }
    out.values.assign(out.block_origin.size() * kVoxels * 3, 0.0f);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t b = 0; b < parts[c].block_origin.size(); ++b) {
            const ivec3& o = parts[c].block_origin[b];
            const std::size_t first = blocks.at(std::tuple(o.x, o.y, o.z)) * kVoxels;
            for (std::size_t v = 0; v < kVoxels; ++v)
                out.values[(first + v) * 3 + c] = parts[c].values[b * kVoxels + v];
        }
    return out;
}

}  // namespace brisance
