// What a ray that leaves a surface sees of the medium.
#pragma once

#include "camera_rays/ray_sum.h"
#include "camera_rays/source_field.h"
#include "light_selection/in_scattering.h"
#include "transport/direct_light.h"

namespace brisance {

class MediumAlongRay {
public:
    // Keeps references. `parts`: as of PictureSettings. `in_scattering`: null where it does not own MM.
    // `emitters_by_rays`: MA is estimated along the ray, as the field holds none.
    MediumAlongRay(const SourceField& field, const DirectLight& scene, int parts, const InScattering* in_scattering,
                   bool emitters_by_rays)
        : field_(field),
          scene_(scene),
          parts_(parts),
          in_scattering_(in_scattering),
          emitters_by_rays_(emitters_by_rays) {}

    // Up to `end` metres: V and the row M, as a ray of the camera has them.
    RaySum look(const Ray& ray, double end, Rng& rng) const;

private:
    const SourceField& field_;
    const DirectLight& scene_;
    int parts_;
    const InScattering* in_scattering_;
    bool emitters_by_rays_;
};

// The light of the row M.
Rgb scattered_by_medium(const CellSum& cells);

}  // namespace brisance
