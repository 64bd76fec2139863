#include "fire_lights/sampled_fire.h"

namespace brisance {

SampledFire::SampledFire(const DirectLight& scene, const FireLightSampling& sampling, const FireLightSettings& settings)
    : scene_(scene),
      lights_(scene),
      gatherer_(sampling.make(lights_, settings)),
      points_(settings.points),
      seed_(settings.seed) {}

Rng SampledFire::rng(std::uint32_t pixel, std::uint64_t number) const {
    return Rng(stream_of("fire_lights/ray"), pixel | std::uint64_t(seed_) << 32, number);
}

Rng SampledFire::surface_rng(std::uint32_t pixel, std::uint64_t number) const {
    return Rng(stream_of("fire_lights/surface"), pixel | std::uint64_t(seed_) << 32, number);
}

Rgb SampledFire::along(const RayMedium& seen, const Ray& ray, Rng& rng) const {
    thread_local std::vector<GatherPoint> points;
    points.clear();
    if (seen.empty() || lights_.size() == 0)
        return Rgb(0.0f);
    add_flight_ends(scene_, seen, ray, points_, rng.next_double(), points);
    return gatherer_->at(points, rng);
}

Rgb SampledFire::on_surface(const PathVertex& vertex, Rng& rng) const {
    if (lights_.size() == 0)
        return Rgb(0.0f);
    const GatherPoint point{vertex, Rgb(1.0f), lights_.extinction_at(vertex.position())};
    return gatherer_->at({&point, 1}, rng);
}

}  // namespace brisance
