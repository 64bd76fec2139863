#include "render/input/frame_velocity.h"

namespace brisance {

namespace {

std::optional<BlockGrid> in_world(BlockGrid grid, const VelocitySettings& settings, double rate,
                                  const dmat4& world_from_file) {
    const dmat3 metres = dmat3(world_from_file) * voxels_per_frame(settings, grid.info.world_from_index, dmat4(1.0));
    const mat3 matrix(rate * metres);
    if (grid.empty() || matrix == mat3(0.0f))
        return std::nullopt;
    for (std::size_t i = 0; i + 2 < grid.values.size(); i += 3) {
        const vec3 v = matrix * vec3(grid.values[i], grid.values[i + 1], grid.values[i + 2]);
        for (int c = 0; c < 3; ++c)
            grid.values[i + c] = v[c];
    }
    grid.info.world_from_index = world_from_file * grid.info.world_from_index;
    return grid;
}

}  // namespace

std::optional<BlockGrid> frame_velocity(const CentredVelocity& velocity, const VelocitySettings& settings, double rate,
                                        const dmat4& world_from_file) {
    return velocity.empty() ? std::nullopt : in_world(velocity.grid, settings, rate, world_from_file);
}

std::optional<BlockGrid> frame_velocity(const BetweenFrames& pair, const VelocitySettings& settings, double rate,
                                        const dmat4& world_from_file) {
    if (pair.first.velocity.empty() || pair.second.velocity.empty()) {
        const CentredVelocity& known = pair.first.velocity.empty() ? pair.second.velocity : pair.first.velocity;
        return frame_velocity(known, settings, rate, world_from_file);
    }
    BetweenFrames velocities{
        {{pair.first.velocity.grid}, {}}, {{pair.second.velocity.grid}, {}}, pair.weight, pair.frames, pair.where};
    std::optional<BlockGrid> mean = std::move(blended(velocities)[0]);
    return mean ? in_world(std::move(*mean), settings, rate, world_from_file) : std::nullopt;
}

}  // namespace brisance
