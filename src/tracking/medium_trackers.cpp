#include "tracking/medium_trackers.h"

#include <array>
#include <cmath>

namespace brisance {

namespace {

// Tentative collisions per voxel above which inverting the optical depth voxel by voxel is cheaper than null
// collisions. Next to a voxel 1e8 times denser than its neighbours nothing else ends.
constexpr double kTentativePerVoxel = 8.0;

bool stiff(const TrackingField& field, const VoxelSegment& in_brick) {
    const double metres_per_voxel = 1.0 / glm::length(in_brick.direction);
    return field.majorant(in_brick.brick) * metres_per_voxel > kTentativePerVoxel;
}

// Inverts the optical depth voxel by voxel; `depth` is what remains up to the collision.
std::optional<Collision> flight_in_brick(const TrackingField& field, const VoxelSegment& in_brick, double& depth) {
    std::optional<Collision> found;
    walk_cubics(field, in_brick, [&](const VoxelSegment& voxel) {
        const Cubic sigma = field.extinction_along(voxel);
        const double metres = voxel.end - voxel.begin;
        const double tau = std::max(0.0, sigma.integral(1.0) * metres);
        if (depth >= tau) {
            depth -= tau;
            return true;
        }
        const double t = voxel.begin + metres * invert_depth(sigma, metres, depth);
        found = Collision{t, voxel.brick, point_in_brick(voxel, t)};
        return false;
    });
    return found;
}

std::optional<Collision> woodcock_in_brick(const TrackingField& field, const VoxelSegment& s, Rng& rng) {
    const double majorant = field.majorant(s.brick);
    if (majorant <= 0.0)
        return std::nullopt;
    for (double t = s.begin + rng.next_exponential() / majorant; t < s.end; t += rng.next_exponential() / majorant) {
        const vec3 p = point_in_brick(s, t);
        if (rng.next_double() * majorant < field.extinction(s.brick, p))
            return Collision{t, s.brick, p};
    }
    return std::nullopt;
}

double depth_of_brick(const TrackingField& field, const VoxelSegment& in_brick) {
    double depth = 0.0;
    walk_cubics(field, in_brick, [&](const VoxelSegment& voxel) {
        depth += field.extinction_along(voxel).integral(1.0) * (voxel.end - voxel.begin);
        return true;
    });
    return std::max(depth, 0.0);
}

// Segments of a ray in bricks that absorb, so that a comb of samples need not look for its bricks again.
struct Absorbers {
    std::vector<VoxelSegment> segments;
    double majorant_depth = 0.0;
    double metres = 0.0;
};

void collect(const TrackingField& field, const LatticeRay& ray, Absorbers& out) {
    out.segments.clear();
    out.majorant_depth = out.metres = 0.0;
    walk_bricks(field.bricks(), ray, [&](const VoxelSegment& s) {
        if (field.majorant(s.brick) > 0.0f) {
            out.segments.push_back(s);
            out.majorant_depth += field.majorant(s.brick) * (s.end - s.begin);
            out.metres += s.end - s.begin;
        }
        return true;
    });
}

// Estimates the optical depth from `teeth` equidistant samples with one random offset.
double comb(const TrackingField& field, const Absorbers& absorbers, int teeth, double offset) {
    const double step = absorbers.metres / teeth;
    double sum = 0.0, next = offset * step, passed = 0.0;
    for (const VoxelSegment& s : absorbers.segments) {
        const double length = s.end - s.begin;
        for (; next < passed + length; next += step)
            sum += field.extinction(s.brick, point_in_brick(s, s.begin + (next - passed)));
        passed += length;
    }
    return sum * step;
}

// Roulette on the order of the series, section 5 of the paper: 90 % of the estimates stop at order zero.
constexpr double kContinue = 0.1;
constexpr double kMeanOrder = 0.31945;  // of the roulette below

int sample_order(Rng& rng) {
    if (rng.next_double() >= kContinue)
        return 0;
    int order = 2;
    while (order < 64 && rng.next_double() < std::min(1.0, 2.0 / (order + 1)))
        ++order;
    return order;
}

// The series around the estimate `pivot` of minus the depth. `others` are independent estimates; the k-th term is the
// elementary symmetric mean of their differences, over k! and the chance to get that far.
double series(double pivot, const std::vector<double>& estimates, std::size_t skip) {
    const int order = static_cast<int>(estimates.size()) - 1;
    std::array<double, 66> mean{};
    mean[0] = 1.0;
    int n = 0;
    for (std::size_t j = 0; j < estimates.size(); ++j) {
        if (j == skip)
            continue;
        ++n;
        const double x = estimates[j] - pivot;
        for (int k = n; k >= 1; --k)
            mean[k] += (double(k) / n) * (mean[k - 1] * x - mean[k]);
    }
    double sum = 1.0, reached = 1.0, factorial = 1.0;
    for (int k = 1; k <= order; ++k) {
        reached *= k == 1 ? kContinue : std::min(1.0, 2.0 / k);
        factorial *= k;
        sum += mean[k] / (factorial * reached);
    }
    return std::exp(pivot) * sum;
}

}  // namespace

double invert_depth(const Cubic& sigma, double metres, double depth) {
    const double target = depth / metres;
    double low = 0.0, high = 1.0;
    double u = std::clamp(target / std::max(sigma.integral(1.0), 1e-300), 0.0, 1.0);
    // Newton, kept inside a bracket that halves where Newton does not: the integral never falls.
    for (int i = 0; i < 60 && high - low > 1e-15; ++i) {
        const double excess = sigma.integral(u) - target;
        (excess > 0.0 ? high : low) = u;
        if (std::abs(excess) <= 1e-13 * target)
            break;
        const double slope = sigma.at(u);
        double next = slope > 0.0 ? u - excess / slope : -1.0;
        if (!(next > low && next < high))
            next = 0.5 * (low + high);
        u = next;
    }
    return u;
}

double optical_depth(const TrackingField& field, const Ray& ray, double end) {
    double depth = 0.0;
    walk_bricks(field.bricks(), field.enter(ray, end), [&](const VoxelSegment& s) {
        depth += depth_of_brick(field, s);
        return true;
    });
    return depth;
}

double coarse_depth(const TrackingField& field, const Ray& ray, double end) {
    double depth = 0.0;
    walk_bricks(field.bricks(), field.enter(ray, end), [&](const VoxelSegment& s) {
        depth += field.mean(s.brick) * (s.end - s.begin);
        return true;
    });
    return depth;
}

// The exponential distribution has no memory: every brick may sample it anew.
std::optional<Collision> null_collision_in_brick(const TrackingField& field, const VoxelSegment& brick, Rng& rng) {
    if (!stiff(field, brick))
        return woodcock_in_brick(field, brick, rng);
    double depth = rng.next_exponential();
    return flight_in_brick(field, brick, depth);
}

std::optional<Collision> null_collision_flight(const TrackingField& field, const Ray& ray, double end, Rng& rng) {
    std::optional<Collision> found;
    walk_bricks(field.bricks(), field.enter(ray, end), [&](const VoxelSegment& s) {
        found = null_collision_in_brick(field, s, rng);
        return !found;
    });
    return found;
}

double ratio_tracking(const TrackingField& field, const LatticeRay& ray, Rng& rng) {
    double transmittance = 1.0;
    walk_bricks(field.bricks(), ray, [&](const VoxelSegment& s) {
        const double majorant = field.majorant(s.brick);
        if (majorant <= 0.0)
            return true;
        if (stiff(field, s)) {
            transmittance *= std::exp(-depth_of_brick(field, s));
            return transmittance > 0.0;
        }
        for (double t = s.begin + rng.next_exponential() / majorant; t < s.end; t += rng.next_exponential() / majorant)
            transmittance *= 1.0 - field.extinction(s.brick, point_in_brick(s, t)) / majorant;
        return transmittance > 0.0;
    });
    return transmittance;
}

double unbiased_ray_march(const TrackingField& field, const LatticeRay& ray, Rng& rng) {
    thread_local Absorbers absorbers;
    collect(field, ray, absorbers);
    if (absorbers.segments.empty())
        return 1.0;
    const double depth = absorbers.majorant_depth;
    const double target = std::cbrt((0.015 + depth) * (0.65 + depth) * (60.3 + depth));
    // Voxels need no more than two samples each for their exact depth.
    const double voxels = absorbers.metres * glm::length(ray.direction);
    if (target > 3.0 * voxels + 8.0) {
        double exact = 0.0;
        for (const VoxelSegment& s : absorbers.segments)
            exact += depth_of_brick(field, s);
        return std::exp(-exact);
    }
    const int teeth = std::max(1, static_cast<int>(std::lround(std::ceil(target) / (kMeanOrder + 1.0))));
    thread_local std::vector<double> estimates;
    estimates.resize(sample_order(rng) + 1);
    for (double& e : estimates)
        e = -comb(field, absorbers, teeth, rng.next_double());
    double sum = 0.0;
    for (std::size_t i = 0; i < estimates.size(); ++i)
        sum += series(estimates[i], estimates, i);
    return sum / estimates.size();
}

}  // namespace brisance
