#include "surface_lighting/medium_along_ray.h"

#include "camera_rays/integrate.h"
#include "transport/emitters_along_ray.h"

namespace brisance {

namespace {

// Points on a ray at which emitters are sampled.
constexpr int kEmitterSamples = 4;

float closeness_of(const RaySum& sum) {
    return sum.distance_sum > 0.0f ? sum.distance_weight * sum.distance_weight / sum.distance_sum : 0.0f;
}

}  // namespace

MediumAlongRay::MediumAlongRay(const SourceField& field, const DirectLight& scene, int parts,
                               const InScattering* in_scattering, float emitters_by_rays)
    : field_(field),
      scene_(scene),
      parts_(parts),
      in_scattering_(in_scattering),
      emitters_by_rays_(emitters_by_rays),
      secondary_(field.has_similar() ? nullptr : std::make_shared<SecondaryField>(field)) {}

Rgb MediumAlongRay::from_emitters(const Ray& ray, double end, const RayMedium& medium, Rng& rng) const {
    thread_local StepDensity guide;
    guide_by_emitters(field_, ray, end, guide);
    return emitters_by_rays_ * emitters_along_ray(scene_, medium, ray, kEmitterSamples, rng, &guide);
}

RaySum MediumAlongRay::look(const Ray& ray, double end, Rng& rng) const {
    RaySum sum = integrate(field_, ray, parts_, {end});
    if (!in_scattering_ && emitters_by_rays_ == 0.0f)
        return sum;
    thread_local RayMedium medium;
    medium.look(scene_.field(), ray, end);
    if (in_scattering_)
        sum.cells.at(Cell::MM) += in_scattering_->along_ray(medium, rng);
    if (emitters_by_rays_ > 0.0f)
        sum.cells.at(Cell::MA) += from_emitters(ray, end, medium, rng);
    return sum;
}

SecondaryField::Seen MediumAlongRay::glance(const Ray& ray, double end, float of_multiple, Rng& rng) const {
    SecondaryField::Seen seen;
    if (secondary_) {
        seen = secondary_->along(ray, end);
    } else {
        const RaySum sum = integrate(field_, ray, 1, {end});
        seen = {sum.cells.at(Cell::V), scattered_by_medium(sum.cells), sum.through, closeness_of(sum)};
    }
    if (!in_scattering_ && emitters_by_rays_ == 0.0f)
        return seen;
    thread_local RayMedium medium;
    medium.look(scene_.field(), ray, end);
    if (in_scattering_)
        seen.scattered += of_multiple * in_scattering_->along_ray(medium, rng);
    if (emitters_by_rays_ > 0.0f)
        seen.scattered += from_emitters(ray, end, medium, rng);
    return seen;
}

Rgb scattered_by_medium(const CellSum& cells) {
    return cells.at(Cell::MV) + cells.at(Cell::MM) + cells.at(Cell::MS) + cells.at(Cell::MA);
}

LitSmoke::Light LitSmokeAlongRay::along(const Ray& ray, double end, Rng& rng) const {
    const SecondaryField::Seen seen = medium_.glance(ray, end, 1.0f, rng);
    return {seen.emission, seen.scattered, seen.transmittance};
}

}  // namespace brisance
