#include "surface_lighting/medium_along_ray.h"

#include <cmath>

#include "camera_rays/integrate.h"
#include "transport/emitters_along_ray.h"

namespace brisance {

namespace {

// Points on a ray at which emitters are sampled.
constexpr int kEmitterSamples = 4;

}  // namespace

RaySum MediumAlongRay::look(const Ray& ray, double end, Rng& rng) const {
    RaySum sum = integrate(field_, ray, parts_, end);
    if (!in_scattering_ && emitters_by_rays_ == 0.0f)
        return sum;
    thread_local RayMedium medium;
    medium.look(scene_.field(), ray, end);
    if (in_scattering_)
        sum.cells.at(Cell::MM) += in_scattering_->along_ray(medium, rng);
    if (emitters_by_rays_ > 0.0f) {
        thread_local StepDensity guide;
        guide_by_emitters(field_, ray, end, guide);
        sum.cells.at(Cell::MA) +=
            emitters_by_rays_ * emitters_along_ray(scene_, medium, ray, kEmitterSamples, rng, &guide);
    }
    return sum;
}

Rgb scattered_by_medium(const CellSum& cells) {
    return cells.at(Cell::MV) + cells.at(Cell::MM) + cells.at(Cell::MS) + cells.at(Cell::MA);
}

LitSmoke::Light LitSmokeAlongRay::along(const Ray& ray, double end, Rng& rng) const {
    const RaySum seen = medium_.look(ray, end, rng);
    return {seen.cells.at(Cell::V), scattered_by_medium(seen.cells), std::exp(-seen.depth)};
}

}  // namespace brisance
