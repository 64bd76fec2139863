#include "render/emitters_along_ray.h"

namespace brisance {

namespace {

// What the phase function finds, by a ray of its own.
Rgb by_phase(const DirectLight& scene, const Scatterer& place, Rng& rng) {
    const std::optional<Scatterer::Sample> turn = place.sample(rng);
    if (!turn)
        return Rgb(0.0f);
    const RaySegment segment = scene.segment_along(place.leaving(turn->wi));
    const Rgb shining = scene.at_end(segment, turn->pdf, turn->delta, &place);
    if (shining == Rgb(0.0f))
        return shining;
    return turn->weight * shining * float(scene.lines().transmittance(segment.ray, segment.end, rng));
}

}  // namespace

Rgb emitters_along_ray(const DirectLight& scene, const SeenMedium& seen, const Ray& ray, int places, Rng& rng) {
    Rgb sum(0.0f);
    if (seen.empty())
        return sum;
    const double shift = rng.next_double();
    for (int i = 0; i < places; ++i) {
        const std::optional<Collision> c = seen.place(seen.sample_flight((i + shift) / places));
        if (!c)
            continue;
        const Scatterer place = scene.in_smoke(ray, *c);
        sum += scene.field().albedo(c->brick, c->position) *
               (scene.from_emitters(place, rng) + by_phase(scene, place, rng));
    }
    return sum * float(seen.opacity() / places);
}

}  // namespace brisance
