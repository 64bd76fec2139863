#include "virtual_lights/placement/relaxation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nanoflann.hpp>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr int kSteps = 10;
constexpr std::size_t kNeighbours = 8;
constexpr double kStepLength = 1.5;
// Deposits near where a light is led, of which it takes the nearest that no other light has.
constexpr std::size_t kPlaces = 8;

class NearestPoints {
public:
    explicit NearestPoints(const std::vector<vec3>& points) : points_{points}, index_(3, points_) {}

    // At most N of them, the nearest first; of equal distances the lower index.
    template <std::size_t N>
    std::span<const std::uint32_t> find(const vec3& at, std::array<std::uint32_t, N>& found) const {
        std::array<float, N> distance2{};
        const std::size_t count = index_.knnSearch(&at.x, N, found.data(), distance2.data());
        std::array<std::pair<float, std::uint32_t>, N> order;
        for (std::size_t i = 0; i < count; ++i)
            order[i] = {distance2[i], found[i]};
        std::sort(order.begin(), order.begin() + std::ptrdiff_t(count));
        for (std::size_t i = 0; i < count; ++i)
            found[i] = order[i].second;
        return {found.data(), count};
    }

private:
    struct Points {
        const std::vector<vec3>& points;
        std::size_t kdtree_get_point_count() const { return points.size(); }
        float kdtree_get_pt(std::size_t i, std::size_t axis) const { return points[i][int(axis)]; }
        template <class Box>
        bool kdtree_get_bbox(Box&) const {
            return false;
        }
    };
    Points points_;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3, std::uint32_t> index_;
};

// `lights`: among which x lies, and which hold x itself.
dvec3 away_from_neighbours(const vec3& x, const std::vector<vec3>& lights, const NearestPoints& nearest) {
    std::array<std::uint32_t, kNeighbours + 1> found;
    const std::span<const std::uint32_t> near = nearest.find(x, found);
    const double farthest = near.empty() ? 0.0 : glm::distance(dvec3(x), dvec3(lights[near.back()]));
    dvec3 sum(0.0);
    for (const std::uint32_t k : near) {
        const dvec3 offset = dvec3(x) - dvec3(lights[k]);
        const double distance = glm::length(offset);
        if (distance > 0.0)  // neither itself nor a deposit at the same place, which it cannot flee
            sum += offset * (farthest / distance - 1.0);
    }
    return kStepLength / double(std::max<std::size_t>(near.size(), 2) - 1) * sum;
}

// One step of all lights at once; `chosen` are indices into `positions`, each taken by one light.
void relax(const std::vector<vec3>& positions, const NearestPoints& deposits, std::vector<std::uint32_t>& chosen,
           std::vector<char>& taken) {
    std::vector<vec3> lights;
    lights.reserve(chosen.size());
    for (const std::uint32_t i : chosen)
        lights.push_back(positions[i]);
    const NearestPoints nearest(lights);
    std::vector<std::array<std::uint32_t, kPlaces>> places(chosen.size());
    std::vector<std::size_t> known(chosen.size());
    parallel_for(
        chosen.size(),
        [&](std::size_t i) {
            const vec3 wish(dvec3(lights[i]) + away_from_neighbours(lights[i], lights, nearest));
            known[i] = deposits.find(wish, places[i]).size();
        },
        64);
    for (std::size_t i = 0; i < chosen.size(); ++i)
        for (std::size_t k = 0; k < known[i] && places[i][k] != chosen[i]; ++k)
            if (!taken[places[i][k]]) {
                taken[chosen[i]] = 0;
                chosen[i] = places[i][k];
                taken[chosen[i]] = 1;
                break;
            }
}

}  // namespace

Survivors thin_by_relaxation(const std::vector<vec3>& positions, const VirtualLightSettings& settings) {
    std::vector<std::uint32_t> chosen = random_subset(positions.size(), settings);
    if (chosen.empty())
        return {};
    std::vector<char> taken(positions.size(), 0);
    for (const std::uint32_t i : chosen)
        taken[i] = 1;
    const NearestPoints deposits(positions);
    for (int step = 0; step < kSteps && chosen.size() > 1; ++step)
        relax(positions, deposits, chosen, taken);
    std::sort(chosen.begin(), chosen.end());
    return with_distances(std::move(chosen), positions, settings);
}

}  // namespace brisance
