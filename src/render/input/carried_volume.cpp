#include "render/input/carried_volume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "camera/shutter.h"
#include "core/error.h"
#include "scene/load_scene.h"

namespace brisance {

namespace {

constexpr int kBlockVoxels = BlockGrid::kBlock * BlockGrid::kBlock * BlockGrid::kBlock;

// Blocks and their neighbours: smoke fades out toward nodes beside the last that hold some.
std::vector<ivec3> with_neighbours(const std::vector<ivec3>& blocks) {
    std::vector<ivec3> out;
    for (const ivec3& block : blocks)
        for (int n = 0; n < 27; ++n)
            out.push_back(block + BlockGrid::kBlock * (ivec3(n / 9, n / 3 % 3, n % 3) - 1));
    const auto less = [](const ivec3& a, const ivec3& b) {
        return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
    };
    std::ranges::sort(out, less);
    const auto rest = std::ranges::unique(out);
    out.erase(rest.begin(), rest.end());
    return out;
}

// The velocity where `like` has voxels and around them.
BlockGrid velocity_around(const BlockGrid& like, const dmat4& carried) {
    BlockGrid out;
    out.info = like.info;
    out.info.name = "velocity";
    out.channels = 3;
    out.block_origin = with_neighbours(like.block_origin);
    out.values.reserve(out.block_origin.size() * kBlockVoxels * 3);
    const dmat4 of_index = carried * like.info.world_from_index;
    for (const ivec3& block : out.block_origin)
        for (int n = 0; n < kBlockVoxels; ++n) {
            const ivec3 voxel = block + ivec3(n >> 6, n >> 3 & 7, n & 7);
            const dvec3 v(of_index * glm::dvec4(dvec3(voxel), 1.0));
            out.values.insert(out.values.end(), {float(v.x), float(v.y), float(v.z)});
        }
    return out;
}

// Adds values of `from`, whose blocks are all in `to`.
void add_blocks(const BlockGrid& from, BlockGrid& to) {
    std::size_t at = 0;
    for (std::size_t block = 0; block < from.block_origin.size(); ++block) {
        while (to.block_origin[at] != from.block_origin[block])
            ++at;
        for (std::size_t i = 0; i < std::size_t{3 * kBlockVoxels}; ++i)
            to.values[at * 3 * kBlockVoxels + i] += from.values[block * 3 * kBlockVoxels + i];
    }
}

}  // namespace

Carrier::Carrier(const Shot& shot, std::string node) : shot_(shot), node_(std::move(node)) {}

dmat4 Carrier::at(double frame) const {
    std::vector<std::string> known;
    for (const SceneFile& file : shot_.scene.files)
        if (const std::optional<dmat4> place =
                load_node(file, shot_.folder, frame / shot_.scene.frames_per_second, node_, known))
            return *place;
    std::erase(known, "");
    throw Error(ExitCode::Usage, fmt::format("a volume's node: no glTF file of the shot has a node \"{}\"; {}", node_,
                                             known.empty() ? "there is none with a name"
                                                           : "there are " + fmt::format("{}", fmt::join(known, ", "))));
}

dmat4 carried_velocity(const Carrier& carrier, double frame, const ShutterSettings& shutter) {
    const ShutterSpan span = shutter_span(shutter);
    const dmat4 opens = carrier.at(frame + span.opens), closes = carrier.at(frame + span.closes);
    return (closes - opens) / (span.closes - span.opens) * glm::inverse(carrier.at(frame));
}

void add_carried_velocity(const dmat4& carried, MediumGrids& grids) {
    if (carried == dmat4(0.0))
        return;
    for (std::optional<BlockGrid>* const like : {&grids.velocity, &grids.density, &grids.temperature, &grids.flame})
        if (*like && !(*like)->empty()) {
            BlockGrid velocity = velocity_around(**like, carried);
            if (like == &grids.velocity)
                add_blocks(**like, velocity);
            grids.velocity = std::move(velocity);
            return;
        }
}

}  // namespace brisance
