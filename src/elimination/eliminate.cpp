#include "elimination/eliminate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "elimination/coincident.h"
#include "elimination/greedy.h"
#include "elimination/kd_order.h"
#include "elimination/local_reach.h"

namespace brisance {

namespace {

// Weight limiting, [1] section 3: a neighbour nearer than d_min counts as if it were at d_min.
constexpr double kBeta = 0.65, kGamma = 1.5;

constexpr std::size_t kGrain = 4096;  // points of one task of a simple loop

[[noreturn]] void fail(const std::string& message) {
    throw Error(ExitCode::RenderFailed, "sample elimination: " + message);
}

void check(std::span<const vec3> points, const EliminationSettings& s, std::span<const std::uint64_t> ids) {
    if (s.dimension != 2 && s.dimension != 3)
        fail("dimension must be 2 or 3, got " + std::to_string(s.dimension));
    if (s.neighbours < 1)
        fail("neighbours must be at least 1, got " + std::to_string(s.neighbours));
    if (!(s.stage_ratio > 1.0))
        fail("stage_ratio must be above 1, got " + std::to_string(s.stage_ratio));
    if (s.radius == EliminationRadius::Uniform && !(s.measure > 0.0 && std::isfinite(s.measure)))
        fail("the domain's measure must be positive and finite, got " + std::to_string(s.measure));
    if (!ids.empty() && ids.size() != points.size())
        fail(std::to_string(ids.size()) + " ids for " + std::to_string(points.size()) + " points");
    if (points.size() > std::numeric_limits<std::uint32_t>::max() / 2)
        fail("too many points: " + std::to_string(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!std::isfinite(points[i].x) || !std::isfinite(points[i].y) || !std::isfinite(points[i].z))
            fail("point " + std::to_string(i) + " is not finite");
}

// Indices of the points in the order of their ids.
std::vector<std::uint32_t> ranked(std::size_t points, std::span<const std::uint64_t> ids) {
    std::vector<std::uint32_t> order(points);
    std::iota(order.begin(), order.end(), 0u);
    if (!ids.empty())
        std::sort(order.begin(), order.end(),
                  [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b] || (ids[a] == ids[b] && a < b); });
    return order;
}

// The points in the order of their ids, in units of a power of two about the size of their box. Squares of distances
// neither overflow nor vanish, and no digit is lost.
class Scaled {
public:
    Scaled(std::span<const vec3> points, const std::vector<std::uint32_t>& order) : points_(points.size()) {
        vec3 low = points.empty() ? vec3(0.0f) : points[0], high = low;
        for (const vec3& p : points) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        const dvec3 side = dvec3(high) - dvec3(low);
        const double greatest = std::max({side.x, side.y, side.z});
        unit_ = greatest > 0.0 ? std::exp2(std::ceil(std::log2(greatest))) : 1.0;
        parallel_for(
            points_.size(), [&](std::size_t r) { points_[r] = vec3(dvec3(points[order[r]]) / unit_); }, kGrain);
    }

    const std::vector<vec3>& points() const { return points_; }
    double unit() const { return unit_; }  // [m]

private:
    std::vector<vec3> points_;
    double unit_ = 1.0;
};

// One point of each set of coincident points, in k-d order.
Candidates distinct(const std::vector<vec3>& points, const std::vector<std::uint32_t>& first) {
    std::vector<std::uint32_t> rank;
    std::vector<vec3> distinct_points;
    for (std::uint32_t r = 0; r < points.size(); ++r)
        if (first[r] == r) {
            rank.push_back(r);
            distinct_points.push_back(points[r]);
        }
    const std::vector<std::uint32_t> order = kd_order(distinct_points);
    Candidates candidates;
    candidates.position.resize(order.size());
    candidates.rank.resize(order.size());
    parallel_for(
        order.size(),
        [&](std::size_t i) {
            candidates.position[i] = distinct_points[order[i]];
            candidates.rank[i] = rank[order[i]];
        },
        kGrain);
    return candidates;
}

void set_reach(Candidates& candidates, std::size_t target, double unit, const EliminationSettings& s) {
    if (s.radius == EliminationRadius::Adaptive) {
        const double ratio = double(candidates.size()) / double(std::min(target, candidates.size()));
        return reach_by_density(candidates, s.neighbours, ratio, s.dimension);
    }
    const double each = s.measure / double(target) / std::pow(unit, s.dimension);
    candidates.reach.assign(candidates.size(), static_cast<float>(closest_packing_distance(each, s.dimension)));
}

// Only the last stage shows in the result, so it gets the full ratio, and the first stage the remainder.
std::vector<std::uint32_t> run_stages(const Candidates& candidates, std::size_t target, const EliminationSettings& s) {
    std::vector<std::uint32_t> alive(candidates.size());
    std::iota(alive.begin(), alive.end(), 0u);
    const double ratio = double(alive.size()) / double(target);
    const float least = static_cast<float>(kBeta * (1.0 - std::pow(std::min(1.0 / ratio, 1.0), kGamma)));
    double more = 1.0;  // survivors of a stage per survivor of the last
    while (more * s.stage_ratio < ratio)
        more *= s.stage_ratio;
    for (; more >= 1.0; more /= s.stage_ratio) {
        const auto left = static_cast<std::size_t>(std::llround(double(target) * more));
        const float scale = static_cast<float>(std::pow(more, -1.0 / s.dimension));
        alive = s.one_by_one ? eliminate_one_by_one(candidates, std::move(alive), left, scale, least)
                             : eliminate_greedily(candidates, std::move(alive), left, scale, least);
    }
    return alive;
}

// Returns the ranks of the survivors: one of each set of coincident points, and others only if there are too few sets.
std::vector<std::uint32_t> choose(const Candidates& candidates, const std::vector<std::uint32_t>& first,
                                  std::size_t target, const EliminationSettings& settings) {
    std::vector<std::uint32_t> ranks;
    for (const std::uint32_t i : run_stages(candidates, target, settings))
        ranks.push_back(candidates.rank[i]);
    for (std::uint32_t r = 0; r < first.size() && ranks.size() < target; ++r)
        if (first[r] != r)
            ranks.push_back(r);
    return ranks;
}

}  // namespace

Survivors eliminate(std::span<const vec3> points, std::size_t target, const EliminationSettings& settings,
                    std::span<const std::uint64_t> ids) {
    check(points, settings, ids);
    target = std::min(target, points.size());
    if (target == 0)
        return {};
    const std::vector<std::uint32_t> order = ranked(points.size(), ids);
    const Scaled scaled(points, order);
    const std::vector<std::uint32_t> first = first_coincident(scaled.points());
    Candidates candidates = distinct(scaled.points(), first);
    set_reach(candidates, target, scaled.unit(), settings);

    std::vector<float> distance(points.size());  // by index
    for (std::size_t i = 0; i < candidates.size(); ++i)
        distance[order[candidates.rank[i]]] = static_cast<float>(candidates.reach[i] * scaled.unit());
    Survivors survivors;
    for (const std::uint32_t rank : choose(candidates, first, target, settings)) {
        survivors.index.push_back(order[rank]);
        distance[order[rank]] = distance[order[first[rank]]];
    }
    std::sort(survivors.index.begin(), survivors.index.end());
    for (const std::uint32_t i : survivors.index)
        survivors.distance.push_back(distance[i]);
    return survivors;
}

}  // namespace brisance
