#include "camera_rays/primary_ray.h"

#include <cmath>

#include "camera_rays/integrate.h"

namespace brisance {

namespace {

// Takes out light that scattered once, in whose place other light comes. What the field holds beyond that has scattered
// more than once. `once`: of the field of single scattering; null: there is none, and nothing beyond.
void leave_to_rays(const CellSet& cells, const CellSum* once, RaySum& sum) {
    if (cells.contains(Cell::MV)) {
        sum.cells.at(Cell::MV) = once ? sum.cells.at(Cell::MV) - sum.once_from_fire : Rgb(0.0f);
        sum.once_from_fire = Rgb(0.0f);
    }
    if (cells.contains(Cell::MA)) {
        sum.cells.at(Cell::MA) = once ? sum.cells.at(Cell::MA) - sum.once_from_emitters : Rgb(0.0f);
        sum.once_from_emitters = Rgb(0.0f);
    }
    if (cells.contains(Cell::MS)) {
        if (once)
            sum.cells.at(Cell::MM) += sum.cells.at(Cell::MS) - once->at(Cell::MS);
        sum.cells.at(Cell::MS) = Rgb(0.0f);
    }
}

RayEnd end_of(const Ray& ray, const std::optional<SurfaceHit>& hit, const PictureSettings& settings) {
    if (!hit)
        return {};
    const dvec3 normal = triangle_of(settings.surroundings->scene(), hit->mesh, hit->triangle).normal();
    const double length = glm::length(normal);
    if (!(length > 0.0))
        return {hit->distance};
    return {hit->distance, normal * ((glm::dot(normal, ray.direction) > 0.0 ? -1.0 : 1.0) / length)};
}

}  // namespace

RaySum medium_along(const SourceField& field, const PixelRay& ray, const std::optional<SurfaceHit>& hit,
                    const PictureSettings& settings) {
    const RayEnd end = end_of(ray.ray, hit, settings);
    RaySum sum = integrate(field, ray.ray, settings.parts, end);
    CellSum once;
    if (settings.once) {
        once = integrate(*settings.once, ray.ray, settings.parts, end).cells;
        sum.once_from_fire = once.at(Cell::MV);
        const Rgb by_rays = settings.once_by_rays * once.at(Cell::MA);
        sum.once_from_emitters = once.at(Cell::MA) - by_rays;
        sum.cells.at(Cell::MA) -= by_rays;
    }
    leave_to_rays(settings.by_rays, settings.once ? &once : nullptr, sum);
    if (settings.light_rays) {
        const LightOnRay more = settings.light_rays(ray, end.distance);
        sum.cells.at(Cell::MM) += more.scattered;
        sum.cells.at(Cell::MA) += more.emitters;
        sum.cells.at(Cell::MV) += more.fire;
        sum.cells.at(Cell::MS) += more.surfaces;
        sum.once_from_emitters += more.emitters;
        sum.once_from_fire += more.fire;
    }
    return sum;
}

void add_end(const Surroundings& surroundings, const Ray& ray, const std::optional<SurfaceHit>& hit, float through,
             RaySum& sum) {
    if (!hit) {
        sum.cells.at(Cell::A) += through * surroundings.emitters().background(ray.direction);
        return;
    }
    const SurfacePoint point = surface_point(surroundings.scene(), *hit, -ray.direction);
    sum.cells.at(Cell::A) += through * point.emission;
    sum.alpha = 1.0f;
    sum.distance_weight += through;
    sum.distance_sum += through * static_cast<float>(hit->distance);
    sum.albedo_sum += through * point.material.base_colour;
}

PrimaryRay trace_primary_ray(const SourceField& field, const PixelRay& ray, const std::optional<SurfaceHit>& hit,
                             const PictureSettings& settings) {
    RaySum sum = medium_along(field, ray, hit, settings);
    if (settings.surroundings)
        add_end(*settings.surroundings, ray.ray, hit, std::exp(-sum.depth), sum);
    return {sum, sum.depth < kOpaqueDepth ? hit : std::nullopt};
}

void add_weighted(RaySum& sum, const RaySum& s, float weight) {
    sum.cells.add(s.cells, Rgb(weight));
    sum.alpha += weight * s.alpha;
    sum.through += weight * s.through;
    sum.distance_weight += weight * s.distance_weight;
    sum.distance_sum += weight * s.distance_sum;
    sum.albedo_sum += weight * s.albedo_sum;
    sum.once_from_fire += weight * s.once_from_fire;
    sum.once_from_emitters += weight * s.once_from_emitters;
}

}  // namespace brisance
