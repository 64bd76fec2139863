#include "ray_lights/ray_light.h"

namespace brisance {

MediumLightBounds bounds_of(const RayLight& light) {
    const dvec3 a = light.segment.start, b = light.segment.at(light.segment.length);
    return {glm::min(a, b) - light.radius, glm::max(a, b) + light.radius, light.scattered, light.extinction,
            light.segment.direction};
}

}  // namespace brisance
