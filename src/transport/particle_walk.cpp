#include "transport/particle_walk.h"

#include <algorithm>
#include <cmath>

#include "transport/roulette.h"

namespace brisance {

void FlightReport::add(const FlightReport& r) {
    paths += r.paths;
    flights += r.flights;
    not_finite += r.not_finite;
    emitted += r.emitted;
}

bool counts(const std::optional<EmittedParticle>& particle, FlightReport& report) {
    ++report.paths;
    if (!particle)
        return false;
    const Rgb& power = particle->power;
    const bool finite = std::isfinite(power.x) && std::isfinite(power.y) && std::isfinite(power.z);
    report.not_finite += !finite;
    if (!finite || !(largest(power) > 0.0f))
        return false;
    report.emitted += luminance(power);
    return true;
}

void follow_particle(const DirectLight& scene, const EmittedParticle& particle, std::uint64_t number, int most_before,
                     Rng& rng, const std::function<void(const ParticleFlight&)>& visit) {
    Ray ray = particle.ray;
    Rgb power = particle.power;
    bool from_smoke = false;
    for (int before = 0; most_before < 0 || before <= most_before; ++before) {
        const RaySegment segment = scene.segment_along(ray);
        const std::optional<Collision> collision = null_collision_flight(scene.field(), ray, segment.end, rng);
        visit({ray, segment.end, collision, power, number, before, from_smoke, &segment});
        if (!collision && !segment.point)
            return;
        const PathVertex place =
            collision ? scene.in_smoke(ray, *collision) : PathVertex(*segment.point, ray.direction);
        const std::optional<PathVertex::Sample> next = place.sample_particle(rng);
        if (!next)
            return;
        const Rgb left =
            power * (collision ? scene.field().albedo(collision->brick, collision->position) : next->weight);
        const float part = std::min(largest(left) / largest(power), before >= kManyScatterings ? kGoesOn : 1.0f);
        if (!(rng.next() < part))  // so for what is not finite
            return;
        power = left / part;
        ray = place.leaving(next->wi);
        from_smoke = collision.has_value();
    }
}

}  // namespace brisance
