#include "virtual_lights/placement/packing_distance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "elimination/eliminate.h"

namespace brisance {

double area_of_distance(double distance) {
    return 0.5 * std::numbers::sqrt3 * distance * distance;
}

// All points survive: only their distances are wanted.
std::vector<float> packing_distances(const std::vector<vec3>& points, int neighbours) {
    EliminationSettings settings;
    settings.neighbours = neighbours;
    return eliminate(points, points.size(), settings).distance;
}

// Elimination gives each point pi r_k^2 / k of area: the distance r_k follows.
std::vector<double> distances_to_nearest(const std::vector<vec3>& points, int k) {
    const auto others = points.empty() ? 0 : static_cast<int>(std::min<std::size_t>(points.size() - 1, 1u << 30));
    const int nearest = std::clamp(k, 1, std::max(others, 1));
    std::vector<double> out;
    double sum = 0.0;
    std::size_t known = 0;
    for (const float distance : packing_distances(points, nearest)) {
        out.push_back(std::sqrt(nearest * area_of_distance(distance) / std::numbers::pi));
        sum += out.back();
        known += distance > 0.0f;
    }
    for (double& distance : out)
        if (!(distance > 0.0) && known > 0)
            distance = sum / double(known);
    return out;
}

}  // namespace brisance
