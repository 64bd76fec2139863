#include "motion/mean_fire.h"

#include "lighting_grid/voxel_lights.h"

namespace brisance {

Medium with_mean_fire(Medium medium, std::span<const Medium* const> moments) {
    dvec3 mean(0.0);
    for (const Medium* const moment : moments)
        mean += total(voxel_lights(*moment)) / double(moments.size());
    const dvec3 own = total(voxel_lights(medium));
    vec3 factor(1.0f);
    for (int c = 0; c < 3; ++c)
        if (own[c] > 0.0)
            factor[c] = float(mean[c] / own[c]);
    for (std::vector<Rgb>* const field : {&medium.source, &medium.emission})
        for (Rgb& value : *field)
            value *= factor;
    return medium;
}

}  // namespace brisance
