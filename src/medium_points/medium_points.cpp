#include "medium_points/medium_points.h"

#include "ray_lights/keep_important.h"

namespace brisance {

MediumPoints::MediumPoints(const DirectLight& scene, const PointLightSettings& settings, int bounces,
                           std::span<const RayLightReceiver> receivers)
    : LightsInSmoke(settings.seed),
      samples_(settings.samples),
      sum_(scene,
           keep_important(trace_medium_points(scene, settings, bounces, report_), receivers,
                          static_cast<std::size_t>(settings.count), scene.field().mean_cosine(),
                          Stream::MediumPointRoulette, settings.seed),
           bound_of(settings, scene.field()), bounces),
      compensation_(scene, sum_, settings, bounces) {
    report_.lights = lights().size();
}

Rgb MediumPoints::along_ray(const SeenMedium& seen, Rng& rng, RayLightCost* cost) const {
    const Rgb sent = sum_.along_ray(seen, samples_, rng, cost);
    return sent + compensation_.along_ray(seen, rng);
}

Rgb MediumPoints::at_surface(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer, Rng& rng,
                             RayLightCost* cost) const {
    const Scatterer place(point, lobes.whole, -toward_viewer);
    const Rgb sent = sum_.at(place, 1, samples_, rng, cost);
    return sent + compensation_.at_surface(place, rng);
}

Rgb MediumPoints::along_ray_from_all(const SeenMedium& seen, Rng& rng) const {
    const Rgb sent = sum_.along_ray_from_all(seen, rng);
    return sent + compensation_.along_ray(seen, rng);
}

Rgb MediumPoints::at_surface_from_all(const SurfacePoint& point, const AskedLobes& lobes, const dvec3& toward_viewer,
                                      Rng& rng) const {
    const Scatterer place(point, lobes.whole, -toward_viewer);
    const Rgb sent = sum_.at_from_all(place, 1, rng);
    return sent + compensation_.at_surface(place, rng);
}

}  // namespace brisance
