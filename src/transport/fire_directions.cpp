#include "transport/fire_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/parallel.h"

namespace brisance {

namespace {

// A number that is above zero wherever the voxel glows at all: products of means, not means of products. A voxel that
// is not finite is no aim, so that it spoils those paths alone that meet it.
double glow_of_voxel(const TrackingField& field, std::size_t brick, const ivec3& voxel) {
    const vec3 middle = vec3(voxel) + 0.5f;
    double glow = 0.0;
    if (field.has_source())
        glow += double(field.extinction(brick, middle)) * luminance(field.source(brick, middle));
    if (field.has_emission())
        glow += luminance(field.emission(brick, middle));
    return std::isfinite(glow) ? glow : 0.0;
}

}  // namespace

FireDirections::FireDirections(const TrackingField& field) : field_(&field) {
    constexpr int kCubes = CubeDirections::kCubes;
    std::vector<std::int32_t> burning;
    for (std::size_t b = 0; b < field.bricks().brick_count(); ++b)
        if (field.burns(b))
            burning.push_back(static_cast<std::int32_t>(b));
    std::vector<double> glow(burning.size() * kCubes);
    parallel_for(burning.size(), [&](std::size_t i) {
        for (int c = 0; c < BrickLattice::kNodes; ++c) {
            const ivec3 voxel = BrickLattice::node_in_brick(c);
            glow[i * kCubes + CubeDirections::index_of(voxel / CubeDirections::kCube)] +=
                glow_of_voxel(field, burning[i], voxel);
        }
    });
    points_ = CubeDirections(field, burning, glow);
    if (points_.empty())
        return;
    ivec3 low(field.bricks().brick(burning[0])), high = low;
    for (const std::int32_t b : burning) {
        low = glm::min(low, field.bricks().brick(b));
        high = glm::max(high, field.bricks().brick(b));
    }
    const Medium& medium = field.medium();
    const dmat3 local_from_index(medium.world_from_index);
    radius_ = static_cast<float>(0.5 * glm::length(local_from_index * dvec3((high - low + 1) * BrickLattice::kSize)));
    double total = 0.0;
    for (const double g : glow)
        total += g;
    constexpr int kVoxels = CubeDirections::kCube * CubeDirections::kCube * CubeDirections::kCube;
    power_ = 4.0 * std::numbers::pi * total * cube_volume(medium) / kVoxels;
}

EmittedParticle FireDirections::emit(Rng& rng) const {
    const CubeDirections::Drawn drawn = points_.draw(rng);
    Rgb glow(0.0f);
    if (field_->has_source())
        glow += field_->extinction(drawn.brick, drawn.in_brick) * field_->source(drawn.brick, drawn.in_brick);
    if (field_->has_emission())
        glow += field_->emission(drawn.brick, drawn.in_brick);
    const double z = 1.0 - 2.0 * rng.next_double(), azimuth = 2.0 * std::numbers::pi * rng.next_double();
    const double across = std::sqrt(std::max(0.0, (1.0 - z) * (1.0 + z)));
    const dvec3 direction(across * std::cos(azimuth), across * std::sin(azimuth), z);
    return {{drawn.position, direction}, glow * float(4.0 * std::numbers::pi / drawn.density)};
}

}  // namespace brisance
