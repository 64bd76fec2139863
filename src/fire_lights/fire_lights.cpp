#include "fire_lights/fire_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr float kGauss[2] = {0.21132486540518711775f, 0.78867513459481288225f};  // of the unit interval

// Of a parallelepiped, from its middle to the corner that is farthest from it.
double half_diagonal(const dmat3& edges) {
    double longest = 0.0;
    for (int k = 0; k < 4; ++k)
        longest = std::max(longest, glm::length(edges * dvec3(1.0, k & 1 ? 1.0 : -1.0, k & 2 ? 1.0 : -1.0)));
    return 0.5 * longest;
}

dvec3 corner_of(std::uint32_t offset) {
    return dvec3(BrickLattice::node_in_brick(static_cast<int>(offset)));
}

}  // namespace

FireLights::FireLights(const DirectLight& scene) : scene_(scene) {
    const TrackingField& field = scene.field();
    const Medium& medium = field.medium();
    local_from_index_ = dmat3(medium.world_from_index);
    index_from_local_ = glm::inverse(local_from_index_);
    origin_ = local_from_index_ * dvec3(field.bricks().min_brick() * BrickLattice::kSize - medium.reference_node);
    volume_ = std::abs(glm::determinant(local_from_index_));
    half_diagonal_ = half_diagonal(local_from_index_);
    std::vector<std::uint32_t> burning;
    for (std::size_t b = 0; b < field.bricks().brick_count(); ++b)
        if (field.burns(b))
            burning.push_back(static_cast<std::uint32_t>(b));
    std::vector<double> found(burning.size() * BrickLattice::kNodes);
    parallel_for(burning.size(), [&](std::size_t i) {
        for (std::uint32_t c = 0; c < BrickLattice::kNodes; ++c) {
            double sum = 0.0;
            for (int g = 0; g < 8; ++g)
                sum += luminance(
                    glow(burning[i], vec3(corner_of(c)) + vec3(kGauss[g >> 2], kGauss[g >> 1 & 1], kGauss[g & 1])));
            found[i * BrickLattice::kNodes + c] = sum * volume_ / 8.0;
        }
    });
    // A voxel that is not finite is no light, so that it spoils those paths alone that meet it.
    for (std::size_t i = 0; i < found.size(); ++i)
        if (found[i] > 0.0 && std::isfinite(found[i])) {
            lights_.push_back(
                {burning[i / BrickLattice::kNodes], static_cast<std::uint32_t>(i % BrickLattice::kNodes)});
            intensity_.push_back(found[i]);
        }
}

dvec3 FireLights::local(std::size_t brick, const dvec3& in_brick) const {
    const BrickLattice& bricks = scene_.field().bricks();
    const dvec3 first(bricks.first_node(brick) - bricks.min_brick() * BrickLattice::kSize);
    return origin_ + local_from_index_ * (first + in_brick);
}

double FireLights::extinction_at(const dvec3& position) const {
    const BrickLattice& bricks = scene_.field().bricks();
    const dvec3 index = index_from_local_ * (position - origin_),
                end = dvec3(bricks.brick_extent() * BrickLattice::kSize);
    for (int a = 0; a < 3; ++a)
        if (!(index[a] >= 0.0 && index[a] < end[a]))
            return 0.0;
    const ivec3 brick = ivec3(index) / BrickLattice::kSize;
    const int found = bricks.find(bricks.min_brick() + brick);
    return found < 0 ? 0.0
                     : scene_.field().extinction(std::size_t(found), vec3(index - dvec3(brick * BrickLattice::kSize)));
}

Rgb FireLights::glow(std::size_t brick, const vec3& in_brick) const {
    const TrackingField& field = scene_.field();
    Rgb out(0.0f);
    if (field.has_source())
        out += field.extinction(brick, in_brick) * field.source(brick, in_brick);
    if (field.has_emission())
        out += field.emission(brick, in_brick);
    return out;
}

std::vector<LightBounds> FireLights::bounds(LobeBrightness) const {
    const dvec3 half =
        0.5 * (glm::abs(local_from_index_[0]) + glm::abs(local_from_index_[1]) + glm::abs(local_from_index_[2]));
    std::vector<LightBounds> out(lights_.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const dvec3 middle = local(lights_[i].brick, corner_of(lights_[i].offset) + 0.5);
        out[i] = {middle - half, middle + half, dvec3(0.0, 0.0, 1.0), std::numbers::pi, std::numbers::pi / 2.0,
                  intensity_[i], false};
    }
    return out;
}

std::vector<double> FireLights::least_squared_distances() const {
    const double a = std::cbrt(volume_ * 0.75 / std::numbers::pi);
    return std::vector<double>(lights_.size(), a * a / 3.0);
}

FireLights::Point FireLights::uniform_point(const Voxel& voxel, Rng& rng) const {
    const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
    const dvec3 in_brick = corner_of(voxel.offset) + dvec3(x, y, z);
    return {vec3(in_brick), local(voxel.brick, in_brick)};
}

// Uniform in direction and, up to `farthest`, in distance from the vertex; none where that is outside of the voxel.
std::optional<FireLights::Point> FireLights::point_around(const Voxel& voxel, const dvec3& vertex, double farthest,
                                                          Rng& rng) const {
    const double z = 1.0 - 2.0 * rng.next_double(), azimuth = 2.0 * std::numbers::pi * rng.next_double();
    const double across = std::sqrt(std::max(0.0, (1.0 - z) * (1.0 + z)));
    const dvec3 position =
        vertex + farthest * rng.next_double() * dvec3(across * std::cos(azimuth), across * std::sin(azimuth), z);
    const dvec3 corner = corner_of(voxel.offset);
    const dvec3 inside = index_from_local_ * (position - local(voxel.brick, corner));
    for (int a = 0; a < 3; ++a)
        if (!(inside[a] >= 0.0 && inside[a] <= 1.0))
            return std::nullopt;
    return Point{vec3(corner + inside), position};
}

bool FireLights::occluded(const Ray& ray, double end) const {
    return scene_.surroundings() && scene_.surroundings()->intersector().occluded(ray, end);
}

Rgb FireLights::estimate(std::size_t light, double probability, const PathVertex& vertex, Rng& rng) const {
    const Voxel voxel = lights_[light];
    const double apart = glm::distance(vertex.position(), local(voxel.brick, corner_of(voxel.offset) + 0.5));
    const bool near = apart < 2.0 * half_diagonal_;
    const double farthest = apart + half_diagonal_;
    const std::optional<Point> point = near && rng.next_double() < 0.5
                                           ? point_around(voxel, vertex.position(), farthest, rng)
                                           : uniform_point(voxel, rng);
    if (!point)
        return Rgb(0.0f);
    double w = 0.0;
    const Ray ray = vertex.toward(point->position, w);
    const Rgb scattered = glow(voxel.brick, point->in_brick) * vertex.at(ray.direction).value;
    if (!(w > 0.0) || scattered == Rgb(0.0f) || occluded(ray, w))
        return Rgb(0.0f);
    // The density of the point times distance^2 [1/m].
    double density = w * w / volume_;
    if (near)
        density = 0.5 * (density + 1.0 / (4.0 * std::numbers::pi * farthest));
    return scattered * float(scene_.lines().transmittance(ray, w, rng) / (density * probability));
}

}  // namespace brisance
