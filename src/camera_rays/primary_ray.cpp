#include "camera_rays/primary_ray.h"

#include <cmath>

#include "camera_rays/integrate.h"

namespace brisance {

PrimaryRay trace_primary_ray(const SourceField& field, const PixelRay& pixel_ray, const PictureSettings& settings) {
    const Ray& ray = pixel_ray.ray;
    const auto integrated = [&](double end) {
        RaySum sum = integrate(field, ray, settings.parts, end);
        if (settings.light_rays) {
            const LightOnRay more = settings.light_rays(pixel_ray, end);
            sum.cells.at(Cell::MM) += more.scattered;
            sum.cells.at(Cell::MA) += more.emitters;
            sum.once_from_emitters = more.emitters;
        }
        if (settings.once) {
            const CellSum once = integrate(*settings.once, ray, settings.parts, end).cells;
            sum.once_from_fire = once.at(Cell::MV);
            sum.once_from_emitters += once.at(Cell::MA);
        }
        return sum;
    };
    constexpr double kNowhere = std::numeric_limits<double>::infinity();
    if (!settings.surroundings)
        return {integrated(kNowhere), std::nullopt};
    const Surroundings& set = *settings.surroundings;
    const std::optional<SurfaceHit> hit = set.intersector().first_hit(ray);
    RaySum sum = integrated(hit ? hit->distance : kNowhere);
    const float through = std::exp(-sum.depth);
    if (!hit) {
        sum.cells.at(Cell::A) += through * set.emitters().background(ray.direction);
        return {sum, std::nullopt};
    }
    const SurfacePoint point = surface_point(set.scene(), *hit, -ray.direction);
    sum.cells.at(Cell::A) += through * point.emission;
    sum.alpha = 1.0f;
    sum.distance_weight += through;
    sum.distance_sum += through * static_cast<float>(hit->distance);
    sum.albedo_sum += through * point.material.base_colour;
    return {sum, sum.depth < kOpaqueDepth ? hit : std::nullopt};
}

void add_weighted(RaySum& sum, const RaySum& s, float weight) {
    sum.cells.add(s.cells, Rgb(weight));
    sum.alpha += weight * s.alpha;
    sum.distance_weight += weight * s.distance_weight;
    sum.distance_sum += weight * s.distance_sum;
    sum.albedo_sum += weight * s.albedo_sum;
    sum.once_from_fire += weight * s.once_from_fire;
    sum.once_from_emitters += weight * s.once_from_emitters;
}

}  // namespace brisance
