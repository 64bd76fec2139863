// The shadow ray from a path vertex to the centre of a light.
#pragma once

#include "transport/direct_light.h"
#include "virtual_lights/kinds/kind.h"
#include "virtual_lights/virtual_light.h"

namespace brisance {

struct ShadowRay {
    Ray ray;
    double distance = 0.0;  // [m]
    bool clear = false;     // of surfaces
};

inline ShadowRay shadow_ray(const DirectLight& scene, const PathVertex& vertex, const VirtualLight& light) {
    // The last part of the way is not tested: the light's own surface lies there.
    constexpr double kLastPart = 1e-3;
    ShadowRay out;
    out.ray = vertex.toward(light.position + kAboveSurface * light.radius * light.frame.normal, out.distance);
    out.clear =
        out.distance > 0.0 && !scene.surroundings()->intersector().occluded(out.ray, (1.0 - kLastPart) * out.distance);
    return out;
}

// The light of a connection that its shadow ray lets through, times `factor`.
inline Rgb connect_by_shadow_ray(const DirectLight& scene, const PathVertex& vertex, const VirtualLight& light,
                                 const Connection& c, float factor, Rng& rng) {
    const ShadowRay shadow = shadow_ray(scene, vertex, light);
    if (!shadow.clear)
        return Rgb(0.0f);
    const double transmittance = scene.lines().transmittance(shadow.ray, shadow.distance, rng);
    return c.scattered.value * c.radiance * (factor * float(transmittance));
}

}  // namespace brisance
