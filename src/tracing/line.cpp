#include "tracing/line.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// Optical depth from which roulette decides how much farther emission is followed: a tenth of it is seen from there.
constexpr double kRouletteDepth = 2.3;
// The same for the camera's own rays: only a ten-millionth.
constexpr double kCameraRouletteDepth = 16.0;
// Cells thinner than this are sampled uniformly along the ray, thicker ones by their transmittance.
constexpr double kThinCell = 0.1;

double exponential(Rng& rng) {
    return -std::log1p(-rng.next_double());
}

// One sample of the integral of T (sigma S + j) along a cell, as seen from where the ray enters it. Draws uniformly
// along the ray, in proportion to T sigma, or by both with the balance heuristic where neither alone is bounded.
class CellEmission {
public:
    CellEmission(const TrackingField& field, const CellSegment& cell, const Cubic& sigma, double depth)
        : field_(field), cell_(cell), sigma_(sigma), metres_(cell.end - cell.begin), depth_(depth) {}

    Rgb estimate(double xi) const {
        if (depth_ < kThinCell)
            return uniform(xi);
        const double absorbed = -std::expm1(-depth_);
        const double u = invert_depth(sigma_, metres_, std::min(-std::log1p(-xi * absorbed), depth_));
        Rgb sum(0.0f);
        if (field_.has_source())
            sum += float(absorbed) * field_.source(cell_.brick, at(u));
        if (field_.has_emission())
            sum += balanced(u, absorbed) + balanced(xi, absorbed);
        return sum;
    }

private:
    vec3 at(double u) const { return point_in_brick(cell_, cell_.begin + u * metres_); }

    double transmittance(double u) const { return std::exp(-metres_ * sigma_.integral(u)); }

    Rgb uniform(double u) const {
        const vec3 p = at(u);
        const float seen = static_cast<float>(metres_ * transmittance(u));
        Rgb sum(0.0f);
        if (field_.has_source())
            sum += float(sigma_.at(u)) * field_.source(cell_.brick, p);
        if (field_.has_emission())
            sum += field_.emission(cell_.brick, p);
        return seen * sum;
    }

    // Of j alone, at a point drawn by either density.
    Rgb balanced(double u, double absorbed) const {
        const double t = transmittance(u);
        const double density = 1.0 + t * std::max(sigma_.at(u), 0.0) * metres_ / absorbed;
        return float(metres_ * t / density) * field_.emission(cell_.brick, at(u));
    }

    const TrackingField& field_;
    const CellSegment& cell_;
    const Cubic& sigma_;
    double metres_, depth_;
};

// Places in [0, 1) along a line: one random number, then steps of the golden ratio, each of them uniform.
class Places {
public:
    explicit Places(Rng& rng) : place_(rng.next_double()) {}
    double next() {
        place_ += 0.6180339887498949;
        return place_ -= place_ >= 1.0;
    }

private:
    double place_;
};

// How much of what is met at an optical depth counts: T up to the depth where roulette begins; from there on T of that
// depth, until a random depth that is reached with the rest of the probability.
class Visibility {
public:
    explicit Visibility(double roulette_depth) : from_(roulette_depth) {}
    double of(double depth) const { return constant_ > 0.0 ? constant_ : std::exp(-depth); }
    void pass(double depth, Rng& rng) {
        if (constant_ == 0.0 && depth > from_) {
            constant_ = std::exp(-depth);
            stop_ = depth + exponential(rng);
        }
    }
    bool ended(double depth) const { return depth >= stop_ || (stop_ < 1e300 && constant_ == 0.0); }

private:
    double from_;
    double constant_ = 0.0;
    double stop_ = std::numeric_limits<double>::infinity();
};

struct PassedCell {
    CellSegment segment;
    double depth;  // optical depth at its end
};

Collision collision_in(const TrackingField& field, const CellSegment& cell, double depth) {
    const double metres = cell.end - cell.begin;
    const double t = cell.begin + metres * invert_depth(field.extinction_along(cell), metres, depth);
    return {t, cell.brick, point_in_brick(cell, t)};
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

LineResult LineTracker::follow(const Ray& ray, bool with_collision, Rng& rng) const {
    LineResult out;
    const LatticeRay way = field_.enter(ray);
    const bool apart = settings_.transmittance != TransmittanceEstimator::Exact;
    if (with_collision && (apart || settings_.free_flight == FreeFlight::NullCollision)) {
        out.collision = settings_.free_flight == FreeFlight::NullCollision
                            ? null_collision_flight(field_, ray, way.end, rng)
                            : exact_flight(field_, ray, way.end, rng);
        with_collision = false;
    }
    if (apart) {
        out.radiance = radiance_by_estimates(way, rng);
        return out;
    }
    const double fire_end = end_of_fire(way);
    const double collision_depth = with_collision ? exponential(rng) : -1.0;
    Visibility visibility(kRouletteDepth);
    Places places(rng);
    double depth = 0.0;
    const auto wanted = [&](double t) {
        return depth <= collision_depth || (t < fire_end && !visibility.ended(depth));
    };
    if (!wanted(way.begin))
        return out;
    walk_bricks(field_.bricks(), way, [&](const CellSegment& brick) {
        const bool burns = field_.burns(brick.brick);
        return walk_cubes<1>(brick, [&](const CellSegment& cell) {
            const Cubic sigma = field_.extinction_along(cell);
            const double tau = std::max(0.0, sigma.integral(1.0) * (cell.end - cell.begin));
            if (burns && field_.cell_burns(cell) && !visibility.ended(depth))
                out.radiance += float(visibility.of(depth)) *
                                CellEmission(field_, cell, sigma, tau).estimate(places.next());
            if (depth <= collision_depth && depth + tau > collision_depth)
                out.collision = collision_in(field_, cell, collision_depth - depth);
            depth += tau;
            visibility.pass(depth, rng);
            return wanted(cell.end);
        });
    });
    return out;
}

LineResult LineTracker::follow_camera(const Ray& ray, double place, Rng& rng) const {
    LineResult out;
    thread_local std::vector<PassedCell> passed;
    passed.clear();
    Visibility visibility(kCameraRouletteDepth);
    Places places(rng);
    double depth = 0.0;
    walk_bricks(field_.bricks(), field_.enter(ray), [&](const CellSegment& brick) {
        const bool burns = field_.burns(brick.brick);
        return walk_cubes<1>(brick, [&](const CellSegment& cell) {
            const Cubic sigma = field_.extinction_along(cell);
            const double tau = std::max(0.0, sigma.integral(1.0) * (cell.end - cell.begin));
            if (burns && field_.cell_burns(cell))
                out.radiance += float(visibility.of(depth)) *
                                CellEmission(field_, cell, sigma, tau).estimate(places.next());
            depth += tau;
            if (tau > 0.0)
                passed.push_back({cell, depth});
            visibility.pass(depth, rng);
            return !visibility.ended(depth);
        });
    });
    if (passed.empty())
        return out;
    // Where roulette ended the walk, less than e^-16 of the ray's collisions lie beyond: below single precision.
    out.weight = -std::expm1(-depth);
    const double target = std::min(-std::log1p(-place * out.weight), depth);
    auto cell = std::upper_bound(passed.begin(), passed.end(), target,
                                 [](double t, const PassedCell& c) { return t < c.depth; });
    if (cell == passed.end())
        --cell;
    const double before = cell == passed.begin() ? 0.0 : (cell - 1)->depth;
    out.collision = collision_in(field_, cell->segment, std::max(0.0, target - before));
    return out;
}

// The whole line in runs of bricks that burn, which are integrated cell by cell, and gaps between them, whose
// transmittance is estimated; independent factors, so that their product is unbiased.
Rgb LineTracker::radiance_by_estimates(const LatticeRay& ray, Rng& rng) const {
    Rgb radiance(0.0f);
    Places places(rng);
    double seen = 1.0, gap_begin = ray.begin;
    LatticeRay way = ray;
    way.end = end_of_fire(ray);
    walk_bricks(field_.bricks(), way, [&](const CellSegment& brick) {
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
        walk_cubes<1>(brick, [&](const CellSegment& cell) {
            const Cubic sigma = field_.extinction_along(cell);
            const double tau = std::max(0.0, sigma.integral(1.0) * (cell.end - cell.begin));
            if (field_.cell_burns(cell))
                radiance += float(seen) * CellEmission(field_, cell, sigma, tau).estimate(places.next());
            seen *= std::exp(-tau);
            return true;
        });
        return seen != 0.0;
    });
    return radiance;
}

}  // namespace brisance
