#include "virtual_lights/gatherers/light_choosers.h"

#include <algorithm>
#include <numbers>

namespace brisance {

namespace {

constexpr double kBeyond = 1e-3;  // [rad]

}  // namespace

std::vector<LightBounds> bounds_of(const std::vector<VirtualLight>& lights, LobeBrightness lobes) {
    std::vector<LightBounds> out;
    out.reserve(lights.size());
    for (const VirtualLight& l : lights) {
        const bool lobed = l.profile < 0 && needs_energy_tables(l.material), by_peak = lobes == LobeBrightness::Peak;
        // A lobe may be as bright at grazing angles as along the normal: such a light reaches a little further than a
        // right angle, and counts as equally bright everywhere.
        out.push_back({l.position - l.radius, l.position + l.radius, l.frame.normal, l.spread,
                       std::numbers::pi / 2.0 + (lobed && by_peak ? kBeyond : 0.0),
                       lobed && !by_peak ? l.power / std::numbers::pi : l.intensity, false});
    }
    return out;
}

// As for emissive surfaces (EmitterLights), with a light's intensity of flux / pi.
std::vector<double> least_squared_distances(const std::vector<VirtualLight>& lights, double point_bound) {
    std::vector<double> out;
    out.reserve(lights.size());
    for (const VirtualLight& light : lights) {
        const double r2 = light.radius * light.radius;
        out.push_back(!(r2 > 0.0)        ? 1.0 / point_bound
                      : light.area > 0.0 ? std::min(r2, light.area / std::numbers::pi)
                                         : r2);
    }
    return out;
}

PowerChooser::PowerChooser(const std::vector<VirtualLight>& lights, LightImportance importance)
    : choice_([&] {
          std::vector<double> weights;
          weights.reserve(lights.size());
          for (const VirtualLight& light : lights)
              weights.push_back(importance(light));
          return weights;
      }()) {}

std::optional<LightTree::Choice> UniformChooser::choose(const LitPoint& point, double u) const {
    if (count_ == 0)
        return std::nullopt;
    const auto light = std::min(static_cast<std::size_t>(u * double(count_)), count_ - 1);
    return LightTree::Choice{light, probability(point, light)};
}

TreeChooser::TreeChooser(const std::vector<VirtualLight>& lights, LightImportance)
    : tree_(bounds_of(lights, LobeBrightness::Mean)) {}

}  // namespace brisance
