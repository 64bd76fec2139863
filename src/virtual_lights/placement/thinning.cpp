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

// The first of a shuffled sequence (Fisher and Yates). Of uniform radius: the mean area of all.
Survivors thin_at_random(const std::vector<vec3>& positions, const VirtualLightSettings& s) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const std::size_t count = std::min(positions.size(), static_cast<std::size_t>(s.count));
    for (std::size_t i = 0; i < count; ++i) {
        Rng rng(Stream::LightCandidate, ~i, s.seed);
        std::swap(order[i], order[i + static_cast<std::size_t>(rng.next_double() * double(order.size() - i))]);
    }
    order.resize(count);
    std::sort(order.begin(), order.end());
    std::vector<vec3> chosen;
    chosen.reserve(count);
    for (const std::uint32_t i : order)
        chosen.push_back(positions[i]);
    Survivors out{order, packing_distances(chosen, kFewNeighbours)};
    if (s.radius == LightRadius::Uniform) {
        double area = 0.0;
        for (const float distance : out.distance)
            area += area_of_distance(distance);
        std::fill(out.distance.begin(), out.distance.end(),
                  float(std::sqrt(area / double(count) / area_of_distance(1.0))));
    }
    return out;
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
