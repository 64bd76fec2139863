#include "volumetric_vpls/volumetric_vpls.h"

#include "light_selection/thin_lights.h"

namespace brisance {

VolumetricVpls::VolumetricVpls(const DirectLight& scene, const VolumetricVplSettings& settings, int bounces,
                               std::span<const LightReceiver> receivers)
    : InScattering(settings.seed),
      samples_(settings.samples),
      sum_(scene,
           thin_lights(trace_vpls(scene, settings, bounces, report_), receivers,
                       {static_cast<std::size_t>(settings.count), scene.field().mean_cosine(),
                        settings.roulette_visibility ? scene.occluders() : nullptr, Stream::VolumetricVplRoulette,
                        settings.seed}),
           bound_of(settings, scene.field()), bounces),
      compensation_(scene, sum_, settings, bounces) {
    report_.lights = lights().size();
}

Rgb VolumetricVpls::along_ray(const RayMedium& seen, Rng& rng, SelectionCost* cost) const {
    const Rgb sent = sum_.along_ray(seen, samples_, rng, cost);
    return sent + compensation_.along_ray(seen, rng);
}

Rgb VolumetricVpls::at_surface(const SurfacePoint& point, const ReceiverLobes& lobes, const dvec3& toward_viewer,
                               Rng& rng, SelectionCost* cost) const {
    const PathVertex vertex(point, lobes.whole, -toward_viewer);
    const Rgb sent = sum_.at(vertex, 1, samples_, rng, cost);
    return sent + compensation_.at_surface(vertex, rng);
}

Rgb VolumetricVpls::along_ray_from_all(const RayMedium& seen, Rng& rng) const {
    const Rgb sent = sum_.along_ray_from_all(seen, rng);
    return sent + compensation_.along_ray(seen, rng);
}

Rgb VolumetricVpls::at_surface_from_all(const SurfacePoint& point, const ReceiverLobes& lobes,
                                        const dvec3& toward_viewer, Rng& rng) const {
    const PathVertex vertex(point, lobes.whole, -toward_viewer);
    const Rgb sent = sum_.at_from_all(vertex, 1, rng);
    return sent + compensation_.at_surface(vertex, rng);
}

}  // namespace brisance
