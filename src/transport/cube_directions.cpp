#include "transport/cube_directions.h"

#include <algorithm>
#include <cmath>

namespace brisance {

double cube_volume(const Medium& medium) {
    constexpr int kCube = CubeDirections::kCube;
    return std::abs(glm::determinant(dmat3(medium.world_from_index))) * kCube * kCube * kCube;
}

CubeDirections::CubeDirections(const TrackingField& field, std::vector<std::int32_t> bricks,
                               const std::vector<double>& weights)
    : field_(&field), brick_of_(std::move(bricks)), place_of_(field.bricks().brick_count(), -1) {
    for (std::size_t i = 0; i < brick_of_.size(); ++i)
        place_of_[brick_of_[i]] = static_cast<std::int32_t>(i);
    double total = 0.0;
    for (const double w : weights)
        total += w;
    if (!(total > 0.0))
        return;
    const Medium& medium = field.medium();
    local_from_index_ = dmat3(medium.world_from_index);
    origin_ = local_from_index_ * dvec3(field.bricks().min_brick() * BrickLattice::kSize - medium.reference_node);
    const double volume = cube_volume(medium);
    double sum = 0.0;
    for (const double w : weights) {
        density_.push_back(w / total / volume);
        cumulative_.push_back((sum += w) / total);
    }
}

CubeDirections::Drawn CubeDirections::draw(Rng& rng) const {
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), rng.next_double());
    const std::size_t i = std::min<std::size_t>(found - cumulative_.begin(), cumulative_.size() - 1);
    const int cube = static_cast<int>(i % kCubes);
    const auto brick = static_cast<std::size_t>(brick_of_[i / kCubes]);
    const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
    const dvec3 in_brick = double(kCube) * (dvec3(cube >> 2, cube >> 1 & 1, cube & 1) + dvec3(x, y, z));
    const dvec3 first(field_->bricks().first_node(brick) - field_->bricks().min_brick() * BrickLattice::kSize);
    return {brick, vec3(in_brick), origin_ + local_from_index_ * (first + in_brick), density_[i]};
}

dvec3 CubeDirections::sample(const dvec3& point, Rng& rng) const {
    for (;;) {
        const dvec3 offset = draw(rng).position - point;
        const double distance = glm::length(offset);
        if (distance > 0.0)
            return offset / distance;
    }
}

double CubeDirections::pdf(const Ray& ray) const {
    double sum = 0.0;
    walk_bricks(field_->bricks(), field_->enter(ray), [&](const VoxelSegment& s) {
        const std::int32_t place = place_of_[s.brick];
        if (place >= 0)
            walk_cubes<kCube>(s, [&](const VoxelSegment& part) {
                const double b = part.begin, e = part.end;
                sum += density_[place * kCubes + index_of(part.cube)] * (e - b) * (e * e + e * b + b * b) / 3.0;
                return true;
            });
        return true;
    });
    return sum;
}

}  // namespace brisance
