#include "surface_lighting/medium_along_ray.h"

#include "camera_rays/integrate.h"
#include "transport/emitters_along_ray.h"

namespace brisance {

namespace {

// On such a ray, where it asks emitters.
constexpr int kEmitterPlaces = 4;

}  // namespace

RaySum MediumAlongRay::look(const Ray& ray, double end, Rng& rng) const {
    RaySum sum = integrate(field_, ray, parts_, end);
    if (!scattered_lights_ && !plan_.emitters_by_rays)
        return sum;
    thread_local RayMedium medium;
    medium.look(scene_.field(), ray, end);
    if (scattered_lights_)
        sum.cells.at(Cell::MM) += scattered_lights_->along_ray(medium, rng);
    if (plan_.emitters_by_rays)
        sum.cells.at(Cell::MA) += emitters_along_ray(scene_, medium, ray, kEmitterPlaces, rng);
    return sum;
}

Rgb scattered_by_medium(const CellSum& cells) {
    return cells.at(Cell::MV) + cells.at(Cell::MM) + cells.at(Cell::MS) + cells.at(Cell::MA);
}

}  // namespace brisance
