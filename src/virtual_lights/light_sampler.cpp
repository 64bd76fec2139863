#include "virtual_lights/light_sampler.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brisance {

namespace {

constexpr double kPi = std::numbers::pi;

std::vector<LightBounds> bounds_of(const std::vector<VirtualLight>& lights) {
    std::vector<LightBounds> out;
    out.reserve(lights.size());
    for (const VirtualLight& l : lights)
        out.push_back(
            {l.position - l.radius, l.position + l.radius, l.frame.normal, l.spread, kPi / 2.0, l.intensity, false});
    return out;
}

// What a light brings to the picture, up to a factor. Where the camera's paths placed lights, those who lie close
// together are the ones whose light it sees: power per area, as by power alone the large ones far off would be asked in
// vain. Where photons placed them, power. Where photons near the camera's paths did, all bring about the same.
double worth(const VirtualLight& light, LightPlacement placement) {
    switch (placement) {
        case LightPlacement::LightPaths:
            return light.power;
        case LightPlacement::RelaxedLightPaths:
            return light.power > 0.0 ? 1.0 : 0.0;
        case LightPlacement::BlueNoise:
        case LightPlacement::Random:
            break;
    }
    return light.power / light.area;
}

bool is_by_tree(LightSampling sampling) {
    return sampling == LightSampling::LightTree || sampling == LightSampling::CombinedTree;
}

dvec3 around(const dvec3& axis, double cosine, double azimuth) {
    const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    return frame_around(axis).world_from_local({sine * std::cos(azimuth), sine * std::sin(azimuth), cosine});
}

// 1 - cos of the half angle that a sphere fills, from outside it. Without cancellation.
double cap_height(double radius, double square_distance) {
    const double square_sine = radius * radius / square_distance;
    return square_sine / (1.0 + std::sqrt(1.0 - square_sine));
}

}  // namespace

LightChoice::LightChoice(const std::vector<VirtualLight>& lights, const VirtualLightSettings& settings)
    : by_tree_(!lights.empty() && is_by_tree(settings.sampling)),
      tree_(by_tree_ ? bounds_of(lights) : std::vector<LightBounds>{}) {
    if (by_tree_ || settings.sampling == LightSampling::Bsdf || settings.sampling == LightSampling::All)
        return;
    double sum = 0.0;
    for (const VirtualLight& light : lights)
        cumulative_.push_back(sum += worth(light, settings.placement));
    if (!(sum > 0.0))
        cumulative_.clear();
    for (double& c : cumulative_)
        c /= sum;
}

std::optional<LightTree::Choice> LightChoice::choose(const LitPoint& place, double u) const {
    if (by_tree_)
        return tree_.choose(place, u);
    if (cumulative_.empty())
        return std::nullopt;
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, u);
    const auto light = static_cast<std::size_t>(found - cumulative_.begin());
    return LightTree::Choice{light, probability(place, light)};
}

double LightChoice::probability(const LitPoint& place, std::size_t light) const {
    if (by_tree_)
        return tree_.probability(place, light);
    if (cumulative_.empty())
        return 0.0;
    return cumulative_[light] - (light > 0 ? cumulative_[light - 1] : 0.0);
}

dvec3 sample_toward(const VirtualLight& light, const LitPoint& place, Rng& rng) {
    const double u = rng.next_double(), azimuth = 2.0 * kPi * rng.next_double();
    const dvec3 way = light.position - place.position;
    const double square_distance = glm::dot(way, way);
    if (square_distance > light.radius * light.radius)
        return around(glm::normalize(way), 1.0 - u * cap_height(light.radius, square_distance), azimuth);
    if (place.kind == LitPoint::Kind::Surface)
        return around(place.normal, std::sqrt(u), azimuth);
    return around({0.0, 0.0, 1.0}, 1.0 - 2.0 * u, azimuth);
}

bool leads_into(const VirtualLight& light, const LitPoint& place, const dvec3& direction) {
    const dvec3 way = light.position - place.position;
    const double square_distance = glm::dot(way, way), square_radius = light.radius * light.radius;
    if (square_distance <= square_radius)
        return true;
    const dvec3 across = glm::cross(way, direction);
    return glm::dot(way, direction) > 0.0 && glm::dot(across, across) < square_radius;
}

double pdf_toward(const VirtualLight& light, const LitPoint& place, const dvec3& direction) {
    const dvec3 way = light.position - place.position;
    const double square_distance = glm::dot(way, way);
    if (square_distance > light.radius * light.radius)
        return 1.0 / (2.0 * kPi * cap_height(light.radius, square_distance));
    if (place.kind == LitPoint::Kind::Surface)
        return std::max(0.0, glm::dot(place.normal, direction)) / kPi;
    return 1.0 / (4.0 * kPi);
}

}  // namespace brisance
