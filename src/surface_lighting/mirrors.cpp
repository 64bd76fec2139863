#include "surface_lighting/mirrors.h"

#include <cmath>

#include "surface_lighting/lobe_numbers.h"
#include "transport/roulette.h"
#include "virtual_lights/virtual_light.h"

namespace brisance {

namespace {

// Of the first, second and later surfaces of a path.
constexpr Stream kNarrow[] = {stream_of("surface_lighting/narrow lobes"), stream_of("surface_lighting/narrow lobes, 2"),
                              stream_of("surface_lighting/narrow lobes, 3")};

void add_segment(const RaySum& seen, const Rgb& emitted, const Rgb& throughput, bool first, CellSum& light) {
    const Rgb glow = throughput * seen.cells.at(Cell::V), scattered = throughput * scattered_by_medium(seen.cells);
    light.at(first ? Cell::SV : Cell::SS) += glow;
    light.at(first ? Cell::SM : Cell::SS) += scattered;
    light.at(first ? Cell::SA : Cell::SS) += throughput * std::exp(-seen.depth) * emitted;
}

}  // namespace

bool has_narrow_lobes(const SurfaceMaterial& m) {
    return needs_energy_tables(m) && m.transmission == 0.0f && m.roughness < kLeastRoughness;
}

BehindMirrors Mirrors::follow(const SurfaceSample& sample, const SurfacePoint& point, Rng& medium_rng,
                              CellSum& light) const {
    BehindMirrors at{point, sample.ray.direction};
    Rng rng(Stream::Mirror, sample.pixel | std::uint64_t(seed_) << 32, sample.number);
    go_on(at, false, rng, medium_rng, light);
    return at;
}

BehindMirrors Mirrors::reflected(const SurfaceSample& sample, const BehindMirrors& from, Rng& medium_rng,
                                 CellSum& light) const {
    BehindMirrors at = from;
    at.lost = true;
    const auto mirror = static_cast<std::uint32_t>(at.mirrors++);
    const Stream stream = kNarrow[std::min<std::size_t>(mirror, std::size(kNarrow) - 1)];
    Rng rng(stream, sample.pixel | std::uint64_t(seed_) << 32, sample.number);
    const PathVertex lobes(at.point, Bsdf(at.point.material, at.point.frame, Lobes::Specular), at.arriving);
    const auto turn = lobes.sample_lobes(lobe_numbers(stream, sample, samples_, seed_, rng));
    if (!turn)
        return at;
    at.throughput *= turn->weight;
    // The first is what the pixel shows; later ones end in proportion to what they bring to it.
    if (mirror > 0 && !survives(at.throughput, largest(from.throughput), false, rng))
        return at;
    const RaySegment segment = scene_.segment_along(lobes.leaving(turn->wi));
    if (!segment.point)
        return at;
    at.throughput *= float(scene_.lines().transmittance(segment.ray, segment.end, medium_rng));
    if (at.throughput == Rgb(0.0f))
        return at;
    at.point = *segment.point;
    at.arriving = segment.ray.direction;
    at.lost = false;
    go_on(at, through_panes_, rng, medium_rng, light);
    return at;
}

// `seen_by_first`: the surface where all this began is lit by the medium straight ahead already.
void Mirrors::go_on(BehindMirrors& at, bool seen_by_first, Rng& rng, Rng& medium_rng, CellSum& light) const {
    const float begin = largest(at.throughput);
    for (;; ++at.mirrors) {
        const PathVertex vertex(at.point, at.arriving);
        if (!vertex.only_delta())
            return;
        at.lost = true;
        const bool first = at.mirrors == 0;
        const std::optional<PathVertex::Sample> turn = vertex.sample(rng);
        if (!turn)
            return;
        at.throughput *= turn->weight;
        if (!survives(at.throughput, begin, at.mirrors > kManyScatterings, rng))
            return;
        seen_by_first = seen_by_first && glm::dot(turn->wi, at.arriving) > 1.0 - 1e-12;
        const RaySegment segment = scene_.segment_along(vertex.leaving(turn->wi));
        RaySum seen = medium_.look(segment.ray, segment.end, medium_rng);
        if (seen_by_first)
            seen.cells = {};
        add_segment(seen, scene_.at_end(segment, turn->pdf, turn->delta, &vertex), at.throughput, first, light);
        at.throughput *= std::exp(-seen.depth);
        if (!segment.point || !beyond_ || seen.depth > kOpaqueDepth)
            return;
        at.point = *segment.point;
        at.arriving = segment.ray.direction;
        at.lost = false;
    }
}

}  // namespace brisance
