#include "media/node_media.h"

#include <algorithm>
#include <cmath>

#include "core/rng.h"

namespace brisance::media {

namespace {

BlockGrid empty_grid(const std::string& name, const dmat4& world_from_index, int channels) {
    BlockGrid grid;
    grid.info.name = name;
    grid.info.usable = true;
    grid.info.world_from_index = world_from_index;
    grid.channels = channels;
    return grid;
}

// Fills the blocks that touch the box; `value` writes the grid's channels of one node.
void fill(BlockGrid& grid, const NodeBox& box, const std::function<void(const ivec3&, float*)>& value) {
    constexpr int kBlock = BlockGrid::kBlock;
    for (int bx = box.low.x >> 3; bx <= box.high.x >> 3; ++bx)
        for (int by = box.low.y >> 3; by <= box.high.y >> 3; ++by)
            for (int bz = box.low.z >> 3; bz <= box.high.z >> 3; ++bz) {
                const ivec3 origin = ivec3(bx, by, bz) * kBlock;
                grid.block_origin.push_back(origin);
                const std::size_t first = grid.values.size();
                grid.values.resize(first + std::size_t(512) * grid.channels, 0.0f);
                for (int n = 0; n < 512; ++n) {
                    const ivec3 node = origin + ivec3(n >> 6, n >> 3 & 7, n & 7);
                    if (glm::all(glm::greaterThanEqual(node, box.low)) && glm::all(glm::lessThanEqual(node, box.high)))
                        value(node, &grid.values[first + std::size_t(n) * grid.channels]);
                }
            }
    for (float& v : grid.values) {
        if (v < 0.0f)
            ++grid.census.negative_voxels;
        if (!std::isfinite(v)) {
            ++grid.census.nan_voxels;
            v = 0.0f;
        }
    }
}

}  // namespace

NodeBox cube(int low, int high) {
    return {ivec3(low), ivec3(high)};
}

BlockGrid scalar_grid(const std::string& name, const dmat4& world_from_index, const NodeBox& box,
                      const NodeScalar& value) {
    BlockGrid grid = empty_grid(name, world_from_index, 1);
    fill(grid, box, [&](const ivec3& node, float* to) { *to = value(node); });
    return grid;
}

BlockGrid colour_grid(const std::string& name, const dmat4& world_from_index, const NodeBox& box,
                      const NodeColour& value) {
    BlockGrid grid = empty_grid(name, world_from_index, 3);
    fill(grid, box, [&](const ivec3& node, float* to) {
        const Rgb c = value(node);
        to[0] = c.x, to[1] = c.y, to[2] = c.z;
    });
    return grid;
}

dmat4 transform(const dmat3& linear, const dvec3& origin) {
    dmat4 m(linear);
    m[3] = glm::dvec4(origin, 1.0);
    return m;
}

dmat4 cubic(double spacing, const dvec3& origin) {
    return transform(dmat3(spacing), origin);
}

MediumSettings black_smoke() {
    MediumSettings settings;
    settings.smoke.albedo = Rgb(0.0f);
    return settings;
}

Medium make_medium(const Recipe& r) {
    MediumGrids grids;
    if (r.density)
        grids.density = scalar_grid("density", r.world_from_index, r.box, r.density);
    if (r.flame)
        grids.flame = scalar_grid("flame", r.world_from_index, r.box, r.flame);
    if (r.temperature)
        grids.temperature = scalar_grid("temperature", r.world_from_index, r.box, r.temperature);
    if (r.colour)
        grids.colour = colour_grid("colour", r.world_from_index, r.box, r.colour);
    Progress silent;
    return build_medium(grids, r.settings, r.half_voxel_shift, silent);
}

float ball(const ivec3& node, const dvec3& centre, double radius) {
    return static_cast<float>(std::clamp(radius - glm::length(dvec3(node) - centre) + 0.5, 0.0, 1.0));
}

Recipe glowing_ball(int nodes, float density) {
    Recipe r;
    r.box = cube(-nodes - 3, nodes + 3);
    r.world_from_index = cubic(1.0 / nodes);
    r.density = [=](const ivec3& n) { return density * ball(n, dvec3(0.0), nodes); };
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    return r;
}

float noise(const ivec3& node, int salt) {
    const auto part = [](int c) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(c) & 0x1fffffu); };
    Rng rng(Stream::EscapeRay, part(node.x) << 42 | part(node.y) << 21 | part(node.z), salt);
    return rng.next();
}

}  // namespace brisance::media
