#include "unified_lights/unified_lights.h"

namespace brisance {

UnifiedLights::UnifiedLights(const DirectLight& scene, const DirectLight& through, const VirtualLights* virtual_lights,
                             double point_bound, const CellSet& wanted, const UnifiedLightSampling& sampling,
                             const UnifiedLightSettings& settings)
    : lights_(scene, through, virtual_lights, point_bound, wanted),
      gatherer_(sampling.make(lights_, settings)),
      seed_(settings.seed) {}

Rng UnifiedLights::rng(std::uint32_t pixel, std::uint64_t number) const {
    return Rng(stream_of("unified_lights/surface"), pixel | std::uint64_t(seed_) << 32, number);
}

LightBySender UnifiedLights::at(const UnifiedReceiver& receiver, Rng& rng) const {
    return lights_.size() == 0 || receiver.vertex.only_delta() ? LightBySender() : gatherer_->at(receiver, rng);
}

}  // namespace brisance
