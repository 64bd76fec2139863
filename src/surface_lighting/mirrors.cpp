#include "surface_lighting/mirrors.h"

#include <cmath>

#include "transport/roulette.h"

namespace brisance {

namespace {

void add_segment(const RaySum& seen, const Rgb& emitted, const Rgb& throughput, bool first, CellSum& light) {
    const Rgb glow = throughput * seen.cells.at(Cell::V), scattered = throughput * scattered_by_medium(seen.cells);
    light.at(first ? Cell::SV : Cell::SS) += glow;
    light.at(first ? Cell::SM : Cell::SS) += scattered;
    light.at(first ? Cell::SA : Cell::SS) += throughput * std::exp(-seen.depth) * emitted;
}

}  // namespace

BehindMirrors Mirrors::follow(const SurfaceSample& sample, const SurfacePoint& point, Rng& medium_rng,
                              CellSum& light) const {
    BehindMirrors at{point, sample.ray.direction};
    Rng rng(Stream::Mirror, sample.pixel | std::uint64_t(seed_) << 32, sample.number);
    for (;; ++at.mirrors) {
        const PathVertex vertex(at.point, at.arriving);
        if (!vertex.only_delta())
            return at;
        at.lost = true;
        const bool first = at.mirrors == 0;
        const std::optional<PathVertex::Sample> turn = vertex.sample(rng);
        if (!turn)
            return at;
        at.throughput *= turn->weight;
        if (!survives(at.throughput, 1.0f, at.mirrors > kManyScatterings, rng))
            return at;
        const RaySegment segment = scene_.segment_along(vertex.leaving(turn->wi));
        const RaySum seen = medium_.look(segment.ray, segment.end, medium_rng);
        add_segment(seen, scene_.at_end(segment, turn->pdf, turn->delta, &vertex), at.throughput, first, light);
        at.throughput *= std::exp(-seen.depth);
        if (!segment.point || !beyond_ || seen.depth > kOpaqueDepth)
            return at;
        at.point = *segment.point;
        at.arriving = segment.ray.direction;
        at.lost = false;
    }
}

}  // namespace brisance
