#include "tracking/line_tracker.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// Optical depth at which Russian roulette begins to end a line: transmittance 0.1.
constexpr double kRouletteDepth = 2.3;
// The same for the camera's own rays: transmittance 1e-7.
constexpr double kCameraRouletteDepth = 16.0;
// Voxels of less optical depth are sampled uniformly along the ray, others in proportion to transmittance.
constexpr double kThinVoxel = 0.1;

// One sample of the integral of T (sigma S + j) along a voxel, as seen from where the ray enters it. Draws uniformly
// along the ray, in proportion to T sigma, or by both with the balance heuristic where neither alone is bounded.
class VoxelEmission {
public:
    VoxelEmission(const TrackingField& field, const VoxelSegment& voxel, const Cubic& sigma, double depth)
        : field_(field), voxel_(voxel), sigma_(sigma), metres_(voxel.end - voxel.begin), depth_(depth) {}

    Rgb estimate(double xi) const {
        if (depth_ < kThinVoxel)
            return uniform(xi);
        const double absorbed = -std::expm1(-depth_);
        const double u = invert_depth(sigma_, metres_, std::min(-std::log1p(-xi * absorbed), depth_));
        Rgb sum(0.0f);
        if (field_.has_source())
            sum += float(absorbed) * field_.source(voxel_.brick, at(u));
        if (field_.has_emission())
            sum += balanced(u, absorbed) + balanced(xi, absorbed);
        return sum;
    }

    // Two antithetic samples: exact for what changes linearly along the voxel.
    Rgb estimate_pair(double xi) const { return 0.5f * (estimate(xi) + estimate(1.0 - xi)); }

private:
    vec3 at(double u) const { return point_in_brick(voxel_, voxel_.begin + u * metres_); }

    double transmittance(double u) const { return std::exp(-metres_ * sigma_.integral(u)); }

    Rgb uniform(double u) const {
        const vec3 p = at(u);
        const float seen = static_cast<float>(metres_ * transmittance(u));
        Rgb sum(0.0f);
        if (field_.has_source())
            sum += float(sigma_.at(u)) * field_.source(voxel_.brick, p);
        if (field_.has_emission())
            sum += field_.emission(voxel_.brick, p);
        return seen * sum;
    }

    // Of j alone, at a point drawn by either density.
    Rgb balanced(double u, double absorbed) const {
        const double t = transmittance(u);
        const double density = 1.0 + t * std::max(sigma_.at(u), 0.0) * metres_ / absorbed;
        return float(metres_ * t / density) * field_.emission(voxel_.brick, at(u));
    }

    const TrackingField& field_;
    const VoxelSegment& voxel_;
    const Cubic& sigma_;
    double metres_, depth_;
};

// Positions in [0, 1) along a line: one random number, then steps of the golden ratio. Each of them is uniform.
class Positions {
public:
    explicit Positions(Rng& rng) : position_(rng.next_double()) {}
    double next() {
        position_ += 0.6180339887498949;
        return position_ -= position_ >= 1.0;
    }

private:
    double position_;
};

// The weight of emission at an optical depth: T up to the depth at which roulette begins; beyond it T of that depth, up
// to a random depth that is reached with the remaining probability.
class Visibility {
public:
    explicit Visibility(double roulette_depth) : from_(roulette_depth) {}
    double of(double depth) const { return constant_ > 0.0 ? constant_ : std::exp(-depth); }
    void pass(double depth, Rng& rng) {
        if (constant_ == 0.0 && depth > from_) {
            constant_ = std::exp(-depth);
            stop_ = depth + rng.next_exponential();
        }
    }
    bool ended(double depth) const { return depth >= stop_ || (stop_ < 1e300 && constant_ == 0.0); }

private:
    double from_;
    double constant_ = 0.0;
    double stop_ = std::numeric_limits<double>::infinity();
};

Collision collision_in(const Cubic& extinction, const VoxelSegment& voxel, double depth) {
    const double metres = voxel.end - voxel.begin;
    const double t = voxel.begin + metres * invert_depth(extinction, metres, depth);
    return {t, voxel.brick, point_in_brick(voxel, t)};
}

// Where null collisions are neither so rare that they miss the fire nor so many that walking voxels is cheaper.
bool crowded(const TrackingField& field, const VoxelSegment& brick) {
    const double per_voxel = field.majorant(brick.brick) / glm::length(brick.direction);
    return !field.has_emission() && per_voxel > 0.05 && per_voxel < 8.0;
}

// A free flight through a brick that collects emission at its tentative collisions. False: it collided.
bool meet_in_brick(const TrackingField& field, const VoxelSegment& brick, LineResult& out, Rng& rng) {
    const double majorant = field.majorant(brick.brick);
    for (double t = brick.begin + rng.next_exponential() / majorant; t < brick.end;
         t += rng.next_exponential() / majorant) {
        const vec3 p = point_in_brick(brick, t);
        const float real = field.extinction(brick.brick, p) / float(majorant);
        out.radiance += real * field.source(brick.brick, p);
        if (rng.next_double() < real) {
            out.collision = Collision{t, brick.brick, p};
            return false;
        }
    }
    return true;
}

}  // namespace

LineTracker::LineTracker(const TrackingField& field, const TracingSettings& settings)
    : field_(field), settings_(settings), fire_low_(1e300), fire_high_(-1e300) {
    for (std::size_t b = 0; b < field.bricks().brick_count(); ++b)
        if (field.burns(b)) {
            const dvec3 low((field.bricks().brick(b) - field.bricks().min_brick()) * BrickLattice::kSize);
            fire_low_ = glm::min(fire_low_, low);
            fire_high_ = glm::max(fire_high_, low + double(BrickLattice::kSize));
        }
}

// Where the ray has left the box of all that burns behind it; its begin when it misses the box.
double LineTracker::end_of_fire(const LatticeRay& ray) const {
    double begin = ray.begin, end = ray.end;
    for (int a = 0; a < 3; ++a) {
        if (ray.direction[a] == 0.0) {
            if (ray.origin[a] < fire_low_[a] || ray.origin[a] > fire_high_[a])
                return ray.begin;
            continue;
        }
        const double t0 = (fire_low_[a] - ray.origin[a]) / ray.direction[a];
        const double t1 = (fire_high_[a] - ray.origin[a]) / ray.direction[a];
        begin = std::max(begin, std::min(t0, t1));
        end = std::min(end, std::max(t0, t1));
    }
    return begin < end ? end : ray.begin;
}

LineResult LineTracker::follow_path(const Ray& ray, Rng& rng, double end) const {
    LineResult out;
    Positions positions(rng);
    const bool exact = settings_.free_flight == FreeFlight::Exact;
    walk_bricks(field_.bricks(), field_.enter(ray, end), [&](const VoxelSegment& brick) {
        const bool burns = field_.burns(brick.brick);
        if (!burns && !exact) {
            out.collision = null_collision_in_brick(field_, brick, rng);
            return !out.collision;
        }
        if (!exact && crowded(field_, brick))
            return meet_in_brick(field_, brick, out, rng);
        // The exponential distribution has no memory: every brick samples it anew.
        double left = rng.next_exponential();
        return walk_cubics(field_, brick, [&](const VoxelSegment& voxel) {
            const Cubic sigma = field_.extinction_along(voxel);
            const double tau = std::max(0.0, sigma.integral(1.0) * (voxel.end - voxel.begin));
            if (burns && field_.voxel_burns(voxel))
                out.radiance += VoxelEmission(field_, voxel, sigma, tau).estimate(positions.next());
            if (tau > left)
                out.collision = collision_in(sigma, voxel, left);
            left -= tau;
            return !out.collision;
        });
    });
    return out;
}

LineResult LineTracker::follow_lit(const Ray& ray, const CoarseField& scattering, Rng& rng, double end) const {
    LineResult out;
    Visibility visibility(kRouletteDepth);
    Positions positions(rng);
    double depth = 0.0, left = rng.next_exponential();
    walk_bricks(field_.bricks(), field_.enter(ray, end), [&](const VoxelSegment& brick) {
        const bool burns = field_.burns(brick.brick);
        return walk_cubics(field_, brick, [&](const VoxelSegment& voxel) {
            const Cubic sigma = field_.extinction_along(voxel);
            const double tau = std::max(0.0, sigma.integral(1.0) * (voxel.end - voxel.begin));
            if (!visibility.ended(depth)) {
                const auto seen = static_cast<float>(visibility.of(depth));
                if (burns && field_.voxel_burns(voxel))
                    out.radiance += seen * VoxelEmission(field_, voxel, sigma, tau).estimate(positions.next());
                if (tau > 0.0)
                    out.scattered += seen * float(-std::expm1(-tau)) * scattering.of(voxel);
            }
            if (!out.collision && tau > left)
                out.collision = collision_in(sigma, voxel, left);
            left -= tau;
            depth += tau;
            visibility.pass(depth, rng);
            return !visibility.ended(depth) || !out.collision;
        });
    });
    return out;
}

Rgb LineTracker::follow_line(const Ray& ray, Rng& rng, double end) const {
    LatticeRay path = field_.enter(ray, end);
    path.end = end_of_fire(path);
    if (settings_.transmittance != TransmittanceEstimator::Exact)
        return radiance_by_estimates(path, rng);
    Rgb radiance(0.0f);
    Visibility visibility(kRouletteDepth);
    Positions positions(rng);
    double depth = 0.0;
    walk_bricks(field_.bricks(), path, [&](const VoxelSegment& brick) {
        const bool burns = field_.burns(brick.brick);
        return walk_cubics(field_, brick, [&](const VoxelSegment& voxel) {
            const Cubic sigma = field_.extinction_along(voxel);
            const double tau = std::max(0.0, sigma.integral(1.0) * (voxel.end - voxel.begin));
            if (burns && field_.voxel_burns(voxel))
                radiance +=
                    float(visibility.of(depth)) * VoxelEmission(field_, voxel, sigma, tau).estimate(positions.next());
            depth += tau;
            visibility.pass(depth, rng);
            return !visibility.ended(depth);
        });
    });
    return radiance;
}

void LineTracker::follow_camera(const Ray& ray, Rng& rng, CameraLine& line, double end) const {
    line.radiance = Rgb(0.0f);
    line.voxels.clear();
    Visibility visibility(kCameraRouletteDepth);
    Positions positions(rng);
    double depth = 0.0;
    walk_bricks(field_.bricks(), field_.enter(ray, end), [&](const VoxelSegment& brick) {
        const bool burns = field_.burns(brick.brick);
        return walk_cubics(field_, brick, [&](const VoxelSegment& voxel) {
            const Cubic sigma = field_.extinction_along(voxel);
            const double tau = std::max(0.0, sigma.integral(1.0) * (voxel.end - voxel.begin));
            if (burns && field_.voxel_burns(voxel))
                line.radiance += float(visibility.of(depth)) *
                                 VoxelEmission(field_, voxel, sigma, tau).estimate_pair(positions.next());
            if (tau > 0.0)
                line.voxels.push_back({voxel, depth, depth + tau});
            depth += tau;
            visibility.pass(depth, rng);
            return !visibility.ended(depth);
        });
    });
}

double LineTracker::transmittance(const Ray& ray, double end, Rng& rng) const {
    switch (settings_.transmittance) {
        case TransmittanceEstimator::Ratio:
            return ratio_tracking(field_, field_.enter(ray, end), rng);
        case TransmittanceEstimator::RayMarch:
            return unbiased_ray_march(field_, field_.enter(ray, end), rng);
        case TransmittanceEstimator::Exact:
            break;
    }
    return std::exp(-optical_depth(field_, ray, end));
}

// Where roulette ended the walk, less than e^-16 of the ray's collisions lie beyond: below single precision.
Collision LineTracker::choose(const CameraLine& line, double position) const {
    const double depth = std::min(-std::log1p(-position * line.opacity()), line.voxels.back().end_depth);
    const auto voxel = std::upper_bound(line.voxels.begin(), line.voxels.end() - 1, depth,
                                        [](double d, const PassedVoxel& c) { return d < c.end_depth; });
    const double inside = std::clamp(depth - voxel->begin_depth, 0.0, voxel->end_depth - voxel->begin_depth);
    return choose_in(*voxel, inside);
}

Collision LineTracker::choose_in(const PassedVoxel& voxel, double depth) const {
    return collision_in(field_.extinction_along(voxel.segment), voxel.segment, depth);
}

// The whole line in runs of bricks that burn, which are integrated voxel by voxel, and gaps between them, whose
// transmittance is estimated; independent factors, so that their product is unbiased.
Rgb LineTracker::radiance_by_estimates(const LatticeRay& ray, Rng& rng) const {
    Rgb radiance(0.0f);
    Positions positions(rng);
    double seen = 1.0, gap_begin = ray.begin;
    walk_bricks(field_.bricks(), ray, [&](const VoxelSegment& brick) {
        if (!field_.burns(brick.brick))
            return true;
        LatticeRay gap = ray;
        gap.begin = gap_begin;
        gap.end = brick.begin;
        gap_begin = brick.end;
        if (!gap.empty())
            seen *= settings_.transmittance == TransmittanceEstimator::Ratio ? ratio_tracking(field_, gap, rng)
                                                                             : unbiased_ray_march(field_, gap, rng);
        if (std::abs(seen) < 0.1) {
            if (rng.next_double() < 0.5)
                return false;
            seen *= 2.0;
        }
        walk_cubes<1>(brick, [&](const VoxelSegment& voxel) {
            const Cubic sigma = field_.extinction_along(voxel);
            const double tau = std::max(0.0, sigma.integral(1.0) * (voxel.end - voxel.begin));
            if (field_.voxel_burns(voxel))
                radiance += float(seen) * VoxelEmission(field_, voxel, sigma, tau).estimate(positions.next());
            seen *= std::exp(-tau);
            return true;
        });
        return seen != 0.0;
    });
    return radiance;
}

}  // namespace brisance
