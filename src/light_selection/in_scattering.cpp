#include "light_selection/in_scattering.h"

#include <algorithm>
#include <cmath>

#include "light_selection/joint_sampling.h"
#include "light_selection/medium_light_tree.h"

namespace brisance {

namespace {

constexpr double kMostlySeen = 0.99;

// Approximate mean cosine of a phase function blurred over a ball of that angular sine.
double blurred(double g, double sine) {
    const double a = 1.0 - std::min(1.0, std::hypot(1.0 - std::abs(g), sine));
    return g < 0.0 ? -a : a;
}

}  // namespace

LightReceiver receiver_along(const RayMedium& seen) {
    Segment part = seen.segment();
    part.length = seen.sample_flight(kMostlySeen);
    return LightReceiver::along(part);
}

double shown_along(const RayMedium& seen, const LightPoint& light, double g) {
    constexpr int kAngles = 4;
    const Segment& ray = seen.segment();
    const dvec3 offset = ray.start - light.position;
    const double begin = glm::dot(offset, ray.direction);
    const dvec3 across = offset - begin * ray.direction;
    const double height = std::max({glm::length(across), 1e-9 * ray.length, 0.5 * light.radius}),
                 first = std::atan2(begin, height);
    const double angle = std::atan2(height * ray.length, height * height + begin * (begin + ray.length));
    double shown = 0.0;
    for (int k = 0; k < kAngles; ++k) {
        const double a = first + (k + 0.5) / kAngles * angle, cosine = std::max(std::cos(a), 1e-12);
        const double u = std::clamp(height * std::sin(a) / cosine - begin, 0.0, ray.length);
        const double distance = height / cosine;
        double here = seen.transmittance(u) * guessed_transmittance(light.extinction * distance);
        if (g != 0.0) {
            const dvec3 toward = across / distance + std::sin(a) * ray.direction;
            const double wide = blurred(g, light.radius / distance);
            here *= phase_about(light.direction, toward, wide) * phase_about(toward, -ray.direction, wide);
        }
        if (light.bound > 0.0)
            here *= std::min(1.0, light.bound * distance * distance);
        shown += here;
    }
    return shown * angle / (height * kAngles);
}

}  // namespace brisance
