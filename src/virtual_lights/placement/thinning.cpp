#include "virtual_lights/placement/thinning.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/rng.h"
#include "virtual_lights/placement/packing_distance.h"

namespace brisance {

namespace {

// Neighbours from whose distance the density around each of few lights is estimated: too many would blur it, too few
// make it uneven.
constexpr int kFewNeighbours = 12;

}  // namespace

Survivors thin_to_blue_noise(const std::vector<vec3>& positions, const VirtualLightSettings& s) {
    EliminationSettings settings;
    settings.neighbours = s.neighbours;
    if (s.radius == LightRadius::Uniform) {
        settings.radius = EliminationRadius::Uniform;
        for (const float distance : packing_distances(positions, s.neighbours))
            settings.measure += area_of_distance(distance);
        if (!(settings.measure > 0.0))
            return {};
    }
    return eliminate(positions, static_cast<std::size_t>(s.count), settings);
}

// The first of a shuffled sequence (Fisher and Yates).
std::vector<std::uint32_t> random_subset(std::size_t of, const VirtualLightSettings& s) {
    std::vector<std::uint32_t> order(of);
    std::iota(order.begin(), order.end(), 0u);
    const std::size_t count = std::min(of, static_cast<std::size_t>(s.count));
    for (std::size_t i = 0; i < count; ++i) {
        Rng rng(Stream::LightCandidate, ~i, s.seed);
        std::swap(order[i], order[i + static_cast<std::size_t>(rng.next_double() * double(order.size() - i))]);
    }
    order.resize(count);
    std::sort(order.begin(), order.end());
    return order;
}

// Of uniform radius: the mean area of all.
Survivors with_distances(std::vector<std::uint32_t> index, const std::vector<vec3>& positions,
                         const VirtualLightSettings& s) {
    std::vector<vec3> chosen;
    chosen.reserve(index.size());
    for (const std::uint32_t i : index)
        chosen.push_back(positions[i]);
    Survivors out{std::move(index), packing_distances(chosen, kFewNeighbours)};
    if (s.radius == LightRadius::Uniform) {
        double area = 0.0;
        for (const float distance : out.distance)
            area += area_of_distance(distance);
        std::fill(out.distance.begin(), out.distance.end(),
                  float(std::sqrt(area / double(chosen.size()) / area_of_distance(1.0))));
    }
    return out;
}

Survivors thin_at_random(const std::vector<vec3>& positions, const VirtualLightSettings& s) {
    return with_distances(random_subset(positions.size(), s), positions, s);
}

VirtualLight light_at(const Scene& scene, const Deposit& deposit) {
    const SurfacePoint point = surface_point(scene, deposit.hit, dvec3(deposit.direction));
    VirtualLight light;
    light.position = point.position;
    light.clearance = point.clearance;
    light.frame = frame_around(lit_normal(point));
    light.scene_material = deposit.scene_material;
    light.material = point.material;
    return light;
}

}  // namespace brisance
