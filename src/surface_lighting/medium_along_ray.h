// The light of the medium along a ray that leaves a surface.
#pragma once

#include <memory>

#include "camera_rays/ray_sum.h"
#include "camera_rays/secondary_field.h"
#include "camera_rays/source_field.h"
#include "light_selection/in_scattering.h"
#include "transport/direct_light.h"
#include "virtual_lights/lit_smoke.h"

namespace brisance {

class MediumAlongRay {
public:
    // Keeps references. `parts` is that of PictureSettings. `in_scattering` is null where it does not own MM.
    // `emitters_by_rays`: the share of MA that is estimated along the ray, as the field does not hold it.
    MediumAlongRay(const SourceField& field, const DirectLight& scene, int parts, const InScattering* in_scattering,
                   float emitters_by_rays);

    // V and the row M up to `end` metres, as for a ray of the camera.
    RaySum look(const Ray& ray, double end, Rng& rng) const;

    // The same for a ray that is one of many samples, by fewer points on it. `of_multiple`: the share that is wanted of
    // what `in_scattering` holds.
    SecondaryField::Seen glance(const Ray& ray, double end, float of_multiple, Rng& rng) const;

private:
    Rgb from_emitters(const Ray& ray, double end, const RayMedium& medium, Rng& rng) const;

    const SourceField& field_;
    const DirectLight& scene_;
    int parts_;
    const InScattering* in_scattering_;
    float emitters_by_rays_;
    std::shared_ptr<const SecondaryField> secondary_;  // null: the field knows a similar medium
};

// The light of the row M.
Rgb scattered_by_medium(const CellSum& cells);

// The same for paths between surfaces.
class LitSmokeAlongRay : public LitSmoke {
public:
    explicit LitSmokeAlongRay(const MediumAlongRay& medium) : medium_(medium) {}
    Light along(const Ray& ray, double end, Rng& rng) const override;

private:
    MediumAlongRay medium_;
};

}  // namespace brisance
