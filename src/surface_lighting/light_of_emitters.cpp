#include "surface_lighting/light_of_emitters.h"

#include <cmath>

#include "surface_lighting/lobe_numbers.h"

namespace brisance {

namespace {

constexpr Stream kChoices = stream_of("surface_lighting/emitters"),
                 kLobes = stream_of("surface_lighting/emitters, lobes");

// Of the emitters at finite distances. They cost little beside the ray toward the one that is kept.
constexpr int kCandidates = 4;

}  // namespace

// The samples of a pixel divide the emitters among themselves: a sequence of evenly spread choices runs through them
// (golden ratio), shifted at random from pixel to pixel. A sample makes several choices where a pixel has fewer samples
// than there are kinds of light to choose from. Of the emitters at finite distances each choice keeps one of several
// candidates: the light tree knows them by boxes around many, which says little of those nearby.
void LightOfEmitters::choose(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng, Seen& seen) const {
    constexpr double kGolden = 0.6180339887498949;
    const auto samples = static_cast<std::uint64_t>(samples_);
    const std::uint64_t number = (sample.number >> 32) * samples + (sample.number & 0xffffffffu);
    const std::uint64_t choices = (direct_.surroundings()->emitters().choices() + samples - 1) / samples;
    const int candidates = direct_.surroundings()->emitters().near_count() > 1 ? kCandidates : 1;
    Rng shift(kChoices, sample.pixel | std::uint64_t(seed_) << 32);
    const double start = shift.next_double() + std::fmod(double(number) * kGolden, 1.0);
    for (std::uint64_t k = 0; k < choices; ++k) {
        const double at = start + double(k) / double(choices);
        DirectLight::ChosenEmitter chosen;
        const Rgb light = direct_.from_emitters_resampled(vertex, at - std::floor(at), candidates, rng, &chosen);
        if (light != Rgb(0.0f))
            seen.add(light / float(choices), chosen.in_background ? even_share(chosen.direction) : 0.0f);
    }
}

LightOfEmitters::Seen LightOfEmitters::at(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng) const {
    Seen seen;
    if (!vertex.only_delta())
        choose(sample, vertex, rng, seen);
    follow_ray(sample, vertex, rng, seen);
    return seen;
}

void LightOfEmitters::follow_ray(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng, Seen& seen) const {
    const std::optional<PathVertex::Sample> turn =
        vertex.sample_lobes(lobe_numbers(kLobes, sample, samples_, seed_, rng));
    if (!turn)
        return;
    const RaySegment segment = direct_.segment_along(vertex.leaving(turn->wi));
    seen.distance = segment.end;
    const Rgb light = direct_.at_end(segment, turn->pdf, turn->delta, &vertex);
    if (light != Rgb(0.0f))
        seen.add(turn->weight * light * float(direct_.lines().transmittance(segment.ray, segment.end, rng)),
                 segment.hit ? 0.0f : even_share(turn->wi));
}

}  // namespace brisance
