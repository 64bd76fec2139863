// What a ray that leaves a surface sees of the medium.
#pragma once

#include "camera_rays/ray_sum.h"
#include "camera_rays/source_field.h"
#include "light_selection/in_scattering.h"
#include "render/plan.h"
#include "transport/direct_light.h"

namespace brisance {

class MediumAlongRay {
public:
    // Keeps references. `parts`: as of PictureSettings. `scattered_lights`: null where they do not own MM.
    MediumAlongRay(const Plan& plan, const SourceField& field, const DirectLight& scene, int parts,
                   const InScattering* scattered_lights)
        : plan_(plan), field_(field), scene_(scene), parts_(parts), scattered_lights_(scattered_lights) {}

    // Up to `end` metres: V and the row M, as a ray of the camera has them.
    RaySum look(const Ray& ray, double end, Rng& rng) const;

private:
    const Plan& plan_;
    const SourceField& field_;
    const DirectLight& scene_;
    int parts_;
    const InScattering* scattered_lights_;
};

// The light of the row M.
Rgb scattered_by_medium(const CellSum& cells);

}  // namespace brisance
