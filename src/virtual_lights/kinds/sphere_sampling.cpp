#include "virtual_lights/kinds/sphere_sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brisance {

namespace {

using std::numbers::pi;

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

dvec3 direction_toward(const VirtualLight& light, const LitPoint& point, const glm::dvec2& numbers) {
    const double u = numbers.x, azimuth = 2.0 * pi * numbers.y;
    const dvec3 offset = light.position - point.position;
    const double square_distance = glm::dot(offset, offset);
    if (square_distance > light.radius * light.radius)
        return around(glm::normalize(offset), 1.0 - u * cap_height(light.radius, square_distance), azimuth);
    if (point.kind == LitPoint::Kind::Surface)
        return around(point.normal, std::sqrt(u), azimuth);
    return around({0.0, 0.0, 1.0}, 1.0 - 2.0 * u, azimuth);
}

dvec3 sample_toward(const VirtualLight& light, const LitPoint& point, Rng& rng) {
    const double x = rng.next_double(), y = rng.next_double();
    return direction_toward(light, point, {x, y});
}

bool leads_into(const VirtualLight& light, const LitPoint& point, const dvec3& direction) {
    const dvec3 offset = light.position - point.position;
    const double square_distance = glm::dot(offset, offset), square_radius = light.radius * light.radius;
    if (square_distance <= square_radius)
        return true;
    const dvec3 across = glm::cross(offset, direction);
    return glm::dot(offset, direction) > 0.0 && glm::dot(across, across) < square_radius;
}

double pdf_toward(const VirtualLight& light, const LitPoint& point, const dvec3& direction) {
    const dvec3 offset = light.position - point.position;
    const double square_distance = glm::dot(offset, offset);
    if (square_distance > light.radius * light.radius)
        return 1.0 / (2.0 * pi * cap_height(light.radius, square_distance));
    if (point.kind == LitPoint::Kind::Surface)
        return std::max(0.0, glm::dot(point.normal, direction)) / pi;
    return 1.0 / (4.0 * pi);
}

}  // namespace brisance
