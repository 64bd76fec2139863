#include "tracking/ray_medium.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

constexpr double kUnseenDepth = 64.0;

}  // namespace

std::optional<Collision> RayProbe::collision_at(double t) const {
    const dvec3 nodes = path_.origin + t * path_.direction;
    const dvec3 brick = glm::floor(nodes / double(BrickLattice::kSize));
    const dvec3 bound = dvec3(field_->bricks().brick_extent());
    for (int a = 0; a < 3; ++a)
        if (!(brick[a] >= 0.0 && brick[a] < bound[a]))
            return std::nullopt;
    const int b = field_->bricks().find(field_->bricks().min_brick() + ivec3(brick));
    if (b < 0)
        return std::nullopt;
    const vec3 p =
        glm::clamp(vec3(nodes - brick * double(BrickLattice::kSize)), vec3(0.0f), vec3(float(BrickLattice::kSize)));
    return Collision{t, static_cast<std::size_t>(b), p};
}

Coefficients RayProbe::at(double t) const {
    const std::optional<Collision> c = collision_at(t);
    if (!c)
        return {};
    const float extinction = field_->extinction(c->brick, c->position);
    return {extinction, extinction * field_->albedo(c->brick, c->position)};
}

void RayMedium::look(const TrackingField& field, const Ray& ray, double end) {
    voxels_.clear();
    double depth = 0.0;
    walk_bricks(field.bricks(), field.enter(ray, end), [&](const VoxelSegment& brick) {
        return walk_cubics(field, brick, [&](const VoxelSegment& voxel) {
            const Cubic sigma = field.extinction_along(voxel);
            const double tau = std::max(0.0, sigma.integral(1.0) * (voxel.end - voxel.begin));
            if (tau > 0.0)
                voxels_.push_back({voxel, sigma, depth, depth + tau});
            depth += tau;
            return depth < kUnseenDepth;
        });
    });
    if (voxels_.empty())
        return;
    begin_ = voxels_.front().segment.begin;
    segment_ = {ray.origin + begin_ * ray.direction, ray.direction, voxels_.back().segment.end - begin_};
    // The segment's points are counted from its start, so that an eye far away costs no digits.
    probe_.emplace(field, ray);
}

const RayMedium::Voxel& RayMedium::voxel_at(double t) const {
    const auto after = std::upper_bound(voxels_.begin(), voxels_.end() - 1, begin_ + t,
                                        [](double x, const Voxel& c) { return x < c.segment.end; });
    return *after;
}

double RayMedium::depth_at(double t) const {
    const Voxel& c = voxel_at(t);
    const double metres = c.segment.end - c.segment.begin;
    const double part = std::clamp((begin_ + t - c.segment.begin) / metres, 0.0, 1.0);
    return std::clamp(c.begin_depth + metres * c.extinction.integral(part), c.begin_depth, c.end_depth);
}

double RayMedium::transmittance(double t) const {
    return std::exp(-depth_at(t));
}

double RayMedium::opacity() const {
    return voxels_.empty() ? 0.0 : -std::expm1(-voxels_.back().end_depth);
}

double RayMedium::distance_to_depth(double depth) const {
    if (depth >= voxels_.back().end_depth)
        return segment_.length;
    const auto voxel = std::upper_bound(voxels_.begin(), voxels_.end() - 1, depth,
                                        [](double d, const Voxel& c) { return d < c.end_depth; });
    const double metres = voxel->segment.end - voxel->segment.begin;
    const double inside = std::clamp(depth - voxel->begin_depth, 0.0, voxel->end_depth - voxel->begin_depth);
    const double t = voxel->segment.begin + metres * invert_depth(voxel->extinction, metres, inside) - begin_;
    return std::clamp(t, 0.0, segment_.length);
}

double RayMedium::sample_flight(double xi) const {
    return distance_to_depth(std::min(-std::log1p(-xi * opacity()), voxels_.back().end_depth));
}

// By the same polynomial that sample_flight() inverts; no point between voxels with extinction is drawn.
double RayMedium::pdf_of_flight(double t) const {
    const Voxel& c = voxel_at(t);
    const double metres = c.segment.end - c.segment.begin, part = (begin_ + t - c.segment.begin) / metres;
    if (!(part >= 0.0))
        return 0.0;
    return std::max(0.0, c.extinction.at(std::min(part, 1.0))) * transmittance(t) / opacity();
}

}  // namespace brisance
