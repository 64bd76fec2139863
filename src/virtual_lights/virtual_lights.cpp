#include "virtual_lights/virtual_lights.h"

#include "core/stopwatch.h"
#include "virtual_lights/technique.h"

namespace brisance {

VirtualLights::VirtualLights(const DirectLight& scene, const PixelCamera& camera, const VirtualLightSettings& settings,
                             std::span<const SharedPositions> positions)
    : scene_(scene), set_(std::make_unique<LightSet>(scene, settings)) {
    const Technique technique = technique_of(settings);
    shines_ = scene.lights_surfaces();
    const bool built = shines_ && settings.count > 0 && settings.photons != 0;
    if (built)
        technique.build(*set_, *technique.placement, {camera, positions});
    const Stopwatch watch;
    if (!set_->lights.empty())
        technique.fit(*set_);
    gatherer_ = technique.gather(*set_, technique.placement->importance);
    single_ = technique.single;
    if (!built)
        return;
    VirtualLightReport& report = set_->report;
    report.choice_seconds = watch.seconds();
    report.lights = set_->lights.size();
    report.bytes = set_->lights.size() * sizeof(VirtualLight) + set_->partition.bytes() + set_->profiles.bytes() +
                   set_->spots.bytes() + gatherer_->bytes();
}

bool VirtualLights::hold_base(const SurfaceHit& hit, const SurfacePoint& point) const {
    return set_->complete ? holds_light(point.material) && !set_->lights.empty() : count_covering(hit, point) > 0;
}

}  // namespace brisance
