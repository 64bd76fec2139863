// What a ray that leaves a surface sees of the medium.
#pragma once

#include "ray_lights/lights_in_smoke.h"
#include "render/cell_field.h"
#include "render/march.h"
#include "render/plan.h"
#include "tracing/direct_light.h"

namespace brisance {

class MediumAlongRay {
public:
    // Keeps references. `parts`: as of PictureSettings. `scattered_lights`: null where they do not own MM.
    MediumAlongRay(const Plan& plan, const CellField& field, const DirectLight& scene, int parts,
                   const LightsInSmoke* scattered_lights)
        : plan_(plan), field_(field), scene_(scene), parts_(parts), scattered_lights_(scattered_lights) {}

    // Up to `end` metres: V and the row M, as a ray of the camera has them.
    RaySum look(const Ray& ray, double end, Rng& rng) const;

private:
    const Plan& plan_;
    const CellField& field_;
    const DirectLight& scene_;
    int parts_;
    const LightsInSmoke* scattered_lights_;
};

// The light of the row M.
Rgb scattered_by_medium(const CellSum& cells);

}  // namespace brisance
