#include "fires.h"

#include <cmath>
#include <memory>

#include "core/rng.h"
#include "lighting_grid/voxel_lights.h"

namespace brisance::benchmarks {

namespace {

BlockGrid noise_cube(const char* name, int side, std::uint64_t salt, float least) {
    BlockGrid grid;
    grid.info.name = name;
    grid.info.world_from_index = dmat4(0.05);
    grid.info.world_from_index[3][3] = 1.0;
    const int blocks = (side + 7) / 8;
    for (int b = 0; b < blocks * blocks * blocks; ++b) {
        const ivec3 origin = 8 * ivec3(b / (blocks * blocks), b / blocks % blocks, b % blocks);
        grid.block_origin.push_back(origin);
        Rng rng(Stream::EscapeRay, salt, static_cast<std::uint64_t>(b));
        for (int n = 0; n < 512; ++n) {
            const ivec3 node = origin + BrickLattice::node_in_brick(n);
            const bool inside = glm::all(glm::lessThan(node, ivec3(side)));
            grid.values.push_back(inside ? least + rng.next() : 0.0f);
        }
    }
    return grid;
}

Medium noise_medium(int side, float depth_of_voxel) {
    MediumGrids grids;
    grids.density = noise_cube("density", side, 1, 0.5f);
    grids.flame = noise_cube("flame", side, 2, 0.1f);
    MediumSettings settings;
    settings.smoke.extinction_per_metre = depth_of_voxel / 0.05f;
    Progress silent;
    return build_medium(grids, settings, false, silent);
}

}  // namespace

Fire::Fire(int side, float depth_of_voxel)
    : medium(noise_medium(side, depth_of_voxel)), pyramid(medium, 6), intensity(voxel_lights(medium)) {
    for (const Rgb& i : intensity)
        weight.push_back(luminance(i));
    grid = build_lighting_grid(medium, intensity, nullptr, automatic_levels(medium));
}

LightField Fire::field(const LightingSettings& settings) const {
    LightField field{};
    field.pyramid = &pyramid;
    field.intensity = &intensity;
    field.grid = &grid;
    field.weight = &weight;
    field.alpha = settings.alpha;
    field.settings = settings;
    return field;
}

const Fire& fire_of(int side) {
    static std::unique_ptr<Fire> fire;
    static int made = 0;
    if (made != side) {
        fire.reset();
        fire = std::make_unique<Fire>(side, 0.05f);
        made = side;
    }
    return *fire;
}

int side_for(std::int64_t lights) {
    return static_cast<int>(std::lround(std::cbrt(static_cast<double>(lights))));
}

}  // namespace brisance::benchmarks
