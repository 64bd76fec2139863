#include "virtual_lights/placement.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "elimination/eliminate.h"

namespace brisance {

namespace {

// Neighbours from whose distance the room of each of few lights is taken: too many would blur it, too few make it
// uneven.
constexpr int kFewNeighbours = 12;

// The area that closest packing gives to a point that keeps its distance: a hexagon.
double area_of_distance(double distance) {
    return 0.5 * std::sqrt(3.0) * distance * distance;
}

// Everybody survives: only the distances are of interest.
Survivors distances(const std::vector<vec3>& points, int neighbours) {
    EliminationSettings settings;
    settings.neighbours = neighbours;
    return eliminate(points, points.size(), settings);
}

Survivors blue_noise(const std::vector<vec3>& points, const VirtualLightSettings& s) {
    EliminationSettings settings;
    settings.neighbours = s.neighbours;
    if (s.radius == LightRadius::Uniform) {
        settings.radius = EliminationRadius::Uniform;
        for (const float distance : distances(points, s.neighbours).distance)
            settings.measure += area_of_distance(distance);
        if (!(settings.measure > 0.0))
            return {};
    }
    return eliminate(points, static_cast<std::size_t>(s.count), settings);
}

// The first of a shuffled sequence (Fisher and Yates). Of uniform radius: the mean area of all.
Survivors at_random(const std::vector<vec3>& points, const VirtualLightSettings& s) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    const std::size_t count = std::min(points.size(), static_cast<std::size_t>(s.count));
    for (std::size_t i = 0; i < count; ++i) {
        Rng rng(Stream::LightCandidate, ~i, s.seed);
        std::swap(order[i], order[i + static_cast<std::size_t>(rng.next_double() * double(order.size() - i))]);
    }
    order.resize(count);
    std::sort(order.begin(), order.end());
    std::vector<vec3> chosen;
    chosen.reserve(count);
    for (const std::uint32_t i : order)
        chosen.push_back(points[i]);
    Survivors out = distances(chosen, kFewNeighbours);
    out.index = order;
    if (s.radius == LightRadius::Uniform) {
        double area = 0.0;
        for (const float distance : out.distance)
            area += area_of_distance(distance);
        std::fill(out.distance.begin(), out.distance.end(),
                  float(std::sqrt(area / double(count) / area_of_distance(1.0))));
    }
    return out;
}

}  // namespace

std::vector<VirtualLight> place_lights(const Scene& scene, const std::vector<LightCandidate>& candidates,
                                       const VirtualLightSettings& settings) {
    if (candidates.empty() || settings.count <= 0)
        return {};
    std::vector<vec3> points;
    points.reserve(candidates.size());
    for (const LightCandidate& c : candidates)
        points.push_back(c.position);
    const Survivors chosen =
        settings.placement == LightPlacement::BlueNoise ? blue_noise(points, settings) : at_random(points, settings);
    std::vector<VirtualLight> lights;
    for (std::size_t i = 0; i < chosen.index.size(); ++i) {
        if (!(chosen.distance[i] > 0.0f))
            continue;
        const LightCandidate& c = candidates[chosen.index[i]];
        const SurfacePoint point = surface_point(scene, c.hit, dvec3(c.toward_viewer));
        VirtualLight light;
        light.position = point.position;
        light.frame = frame_around(lit_normal(point));
        light.radius = settings.radius_factor * chosen.distance[i];
        light.scene_material = c.scene_material;
        light.material = point.material;
        lights.push_back(light);
    }
    return lights;
}

}  // namespace brisance
