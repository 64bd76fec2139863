#include "unified_lights/unified_lights.h"

#include "transport/emitters_along_ray.h"

namespace brisance {

UnifiedLights::UnifiedLights(const DirectLight& scene, const DirectLight& through, const VirtualLights* virtual_lights,
                             double point_bound, const CellSet& wanted, const UnifiedLightSampling& sampling,
                             const UnifiedLightSettings& settings)
    : scene_(scene),
      virtual_lights_(wanted.contains(Cell::MS) ? virtual_lights : nullptr),
      lights_(scene, through, virtual_lights, point_bound, wanted),
      gatherer_(sampling.make(lights_, settings)),
      points_(settings.points),
      seed_(settings.seed) {}

Rng UnifiedLights::rng(std::uint32_t pixel, std::uint64_t number) const {
    return Rng(stream_of("unified_lights/surface"), pixel | std::uint64_t(seed_) << 32, number);
}

LightBySender UnifiedLights::at(const UnifiedReceiver& receiver, Rng& rng) const {
    if (lights_.size() == 0 || receiver.vertex.only_delta())
        return {};
    const GatherPoint point{receiver.vertex, Rgb(1.0f), lights_.extinction_at(receiver.vertex.position()),
                            receiver.base};
    return gatherer_->at({&point, 1}, rng);
}

Rng UnifiedLights::ray_rng(std::uint32_t pixel, std::uint64_t number) const {
    return Rng(stream_of("unified_lights/ray"), pixel | std::uint64_t(seed_) << 32, number);
}

LightBySender UnifiedLights::along(const RayMedium& seen, const Ray& ray, Rng& rng) const {
    thread_local std::vector<GatherPoint> points;
    points.clear();
    if (seen.empty() || lights_.size() + (virtual_lights_ ? 1 : 0) == 0)
        return {};
    add_flight_ends(scene_, seen, ray, points_, rng.next_double(), points);
    LightBySender sum = lights_.size() > 0 ? gatherer_->at(points, rng) : LightBySender();
    for (const GatherPoint& point : points)
        sum += point.weight * by_phase(point.vertex, rng);
    return sum;
}

LightBySender UnifiedLights::by_phase(const PathVertex& vertex, Rng& rng) const {
    LightBySender out;
    if (lights_.emitters() > 0)
        out.emitters = emitters_by_phase(scene_, vertex, rng);
    if (virtual_lights_) {
        VirtualLights::Shading how;
        how.lights_apart = true;
        out.surfaces = virtual_lights_->shade(vertex, rng, how);
    }
    return out;
}

}  // namespace brisance
