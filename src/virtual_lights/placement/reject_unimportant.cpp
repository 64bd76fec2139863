#include "virtual_lights/placement/reject_unimportant.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "core/rng.h"
#include "virtual_lights/placement/packing_distance.h"

namespace brisance {

namespace {

// Deposits of the camera that density is estimated from at most, and how many of them a kernel holds if they lie
// evenly.
constexpr std::size_t kMostPoints = 100000;
constexpr double kInKernel = 16.0;
constexpr double kLeastChance = 0.01;

// Beside the seed, so that rejection and placement draw independent numbers.
constexpr std::uint64_t kRejection = std::uint64_t{1} << 32;

// Points sorted into cubes; those near a position are in 27 of them.
class PointCubes {
public:
    PointCubes(const std::vector<vec3>& points, float side) : side_(side) {
        for (const vec3& p : points)
            entries_.push_back({key_of(cube_of(p)), p});
        std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) { return a.key < b.key; });
    }

    // Sum of 1 - d^2 / side^2 over the points at less than a cube's side.
    double kernel_sum(const vec3& at) const {
        double sum = 0.0;
        const ivec3 middle = cube_of(at);
        for (int i = 0; i < 27; ++i) {
            const ivec3 cube = middle + ivec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
            const std::uint64_t key = key_of(cube);
            const auto first = std::lower_bound(entries_.begin(), entries_.end(), key,
                                                [](const Entry& e, std::uint64_t k) { return e.key < k; });
            for (auto e = first; e != entries_.end() && e->key == key; ++e) {
                const vec3 offset = e->point - at;
                sum += std::max(0.0f, 1.0f - glm::dot(offset, offset) / (side_ * side_));
            }
        }
        return sum;
    }

private:
    struct Entry {
        std::uint64_t key;
        vec3 point;
    };

    ivec3 cube_of(const vec3& p) const { return ivec3(glm::floor(p / side_)); }
    static std::uint64_t key_of(const ivec3& c) {
        const auto part = [](int x) { return static_cast<std::uint64_t>(x + (1 << 20)) & 0x1fffff; };
        return part(c.x) << 42 | part(c.y) << 21 | part(c.z);
    }

    float side_;
    std::vector<Entry> entries_;
};

std::vector<vec3> thinned(const std::vector<Deposit>& from) {
    const std::size_t step = from.size() / kMostPoints + 1;
    std::vector<vec3> points;
    for (std::size_t i = 0; i < from.size(); i += step)
        points.push_back(from[i].position);
    return points;
}

// Within which `kInKernel` of the points would lie if they lay evenly on the surface that they cover.
float kernel_radius(const std::vector<vec3>& points) {
    double area = 0.0;
    for (const float distance : packing_distances(points, static_cast<int>(kInKernel)))
        area += area_of_distance(distance);
    return static_cast<float>(std::sqrt(kInKernel * area / (double(points.size()) * std::numbers::pi)));
}

double chance(double importance, double scale) {
    return std::clamp(scale * importance, kLeastChance, 1.0);
}

// By which importances are multiplied so that the chances add up to the target.
double scale_for(const std::vector<double>& importance, double target) {
    double low = 0.0, high = 1.0;
    const auto expected = [&](double scale) {
        double sum = 0.0;
        for (const double i : importance)
            sum += chance(i, scale);
        return sum;
    };
    while (expected(high) < target && high < 1e12)
        high *= 4.0;
    for (int step = 0; step < 40; ++step)
        (expected(0.5 * (low + high)) < target ? low : high) = 0.5 * (low + high);
    return high;
}

}  // namespace

std::vector<Deposit> reject_unimportant(const std::vector<Deposit>& deposits, const std::vector<Deposit>& from_camera,
                                        std::size_t target, std::uint32_t seed) {
    const std::vector<vec3> points = thinned(from_camera);
    const float radius = points.empty() ? 0.0f : kernel_radius(points);
    if (deposits.size() <= target || !(radius > 0.0f))
        return deposits;
    const PointCubes cubes(points, radius);
    std::vector<double> importance(deposits.size());
    parallel_for(
        deposits.size(), [&](std::size_t i) { importance[i] = cubes.kernel_sum(deposits[i].position); }, 256);
    const double scale = scale_for(importance, double(target));
    std::vector<Deposit> kept;
    for (std::size_t i = 0; i < deposits.size(); ++i)
        if (Rng(Stream::LightCandidate, i, kRejection | seed).next_double() < chance(importance[i], scale))
            kept.push_back(deposits[i]);
    return kept;
}

}  // namespace brisance
