// Ways in which points on ray lights are drawn: pairs of a point on the camera's ray and one on the light, and points
// on the light for a point of a surface. All are unbiased.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "light_selection/joint_sampling.h"
#include "ray_lights/ray_light.h"
#include "ray_lights/settings.h"
#include "tracking/ray_medium.h"

namespace brisance {

// A point on the light, and its density [1/m].
struct LightPointSample {
    double v = 0.0, pdf = 0.0;
};

// One row of the table.
struct PairSampling {
    RaySampling value;
    std::string name, help;
    // From one of two densities combined by the balance heuristic: the inverse square times both phase functions, and a
    // free flight along the camera's ray followed by the same density as seen from its collision. None where one of the
    // two has no length.
    std::optional<PairSample> (*draw)(const RayMedium& seen, const RayLight& light, double mean_cosine, Rng& rng);
    // For a point of a surface.
    LightPointSample (*draw_on_light)(const dvec3& point, const RayLight& light, double mean_cosine, Rng& rng);
};

// The first is the default.
const std::vector<PairSampling>& pair_samplings();
const PairSampling& pair_sampling(RaySampling value);

}  // namespace brisance
