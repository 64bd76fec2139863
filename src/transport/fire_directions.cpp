#include "transport/fire_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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

FireDirections::FireDirections(const TrackingField& field)
    : field_(&field), burning_of_(field.bricks().brick_count(), -1) {
    for (std::size_t b = 0; b < burning_of_.size(); ++b)
        if (field.burns(b)) {
            burning_of_[b] = static_cast<std::int32_t>(brick_of_.size());
            brick_of_.push_back(static_cast<std::int32_t>(b));
        }
    std::vector<double> glow(brick_of_.size() * kCubes);
    parallel_for(brick_of_.size(), [&](std::size_t i) {
        for (int c = 0; c < BrickLattice::kNodes; ++c) {
            const ivec3 voxel = BrickLattice::node_in_brick(c), cube = voxel / kCube;
            glow[i * kCubes + (cube.x * 2 + cube.y) * 2 + cube.z] += glow_of_voxel(field, brick_of_[i], voxel);
        }
    });
    double total = 0.0;
    for (double g : glow)
        total += g;
    if (!(total > 0.0))
        return;
    const Medium& medium = field.medium();
    local_from_index_ = dmat3(medium.world_from_index);
    origin_ = local_from_index_ * dvec3(field.bricks().min_brick() * BrickLattice::kSize - medium.reference_node);
    ivec3 low(brick_of_.empty() ? ivec3(0) : field.bricks().brick(brick_of_[0])), high = low;
    for (const std::int32_t b : brick_of_) {
        low = glm::min(low, field.bricks().brick(b));
        high = glm::max(high, field.bricks().brick(b));
    }
    radius_ = static_cast<float>(0.5 * glm::length(local_from_index_ * dvec3((high - low + 1) * BrickLattice::kSize)));
    const double cube_volume = std::abs(glm::determinant(local_from_index_)) * kCube * kCube * kCube;
    double sum = 0.0;
    for (double g : glow) {
        density_.push_back(g / total / cube_volume);
        cumulative_.push_back((sum += g) / total);
    }
    power_ = 4.0 * std::numbers::pi * total * cube_volume / (kCube * kCube * kCube);
}

FireDirections::Drawn FireDirections::draw(Rng& rng) const {
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), rng.next_double());
    const std::size_t i = std::min<std::size_t>(found - cumulative_.begin(), cumulative_.size() - 1);
    const int cube = static_cast<int>(i % kCubes);
    const auto brick = static_cast<std::size_t>(brick_of_[i / kCubes]);
    const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
    const dvec3 in_brick = double(kCube) * (dvec3(cube >> 2, cube >> 1 & 1, cube & 1) + dvec3(x, y, z));
    const dvec3 first(field_->bricks().first_node(brick) - field_->bricks().min_brick() * BrickLattice::kSize);
    return {brick, vec3(in_brick), origin_ + local_from_index_ * (first + in_brick), density_[i]};
}

dvec3 FireDirections::sample(const dvec3& point, Rng& rng) const {
    for (;;) {
        const dvec3 offset = draw(rng).position - point;
        const double distance = glm::length(offset);
        if (distance > 0.0)
            return offset / distance;
    }
}

EmittedParticle FireDirections::emit(Rng& rng) const {
    const Drawn drawn = draw(rng);
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

double FireDirections::pdf(const Ray& ray) const {
    double sum = 0.0;
    walk_bricks(field_->bricks(), field_->enter(ray), [&](const VoxelSegment& s) {
        const std::int32_t burning = burning_of_[s.brick];
        if (burning >= 0)
            walk_cubes<kCube>(s, [&](const VoxelSegment& part) {
                const double b = part.begin, e = part.end;
                sum += density_[burning * kCubes + (part.cube.x * 2 + part.cube.y) * 2 + part.cube.z] * (e - b) *
                       (e * e + e * b + b * b) / 3.0;
                return true;
            });
        return true;
    });
    return sum;
}

}  // namespace brisance
