#include "surface_lighting/gloss_of_medium.h"

#include "base_lighting/panes.h"

namespace brisance {

namespace {

// Of a line toward the fire. Most of them lie far off the lobe, and march through the smoke for less than this.
constexpr float kLeastWeight = 0.003f;

bool is_dark(const SecondaryField::Seen& seen) {
    return seen.emission == Rgb(0.0f) && seen.scattered == Rgb(0.0f);
}

void add(const SecondaryField::Seen& seen, const Rgb& weight, bool first, CellSum& light) {
    light.at(first ? Cell::SV : Cell::SS) += weight * seen.emission;
    light.at(first ? Cell::SM : Cell::SS) += weight * seen.scattered;
}

}  // namespace

bool has_wide_lobes(const SurfaceMaterial& m) {
    return needs_energy_tables(m) && double(m.roughness) * m.roughness >= kSmoothAlpha;
}

double GlossOfMedium::reflect(const SurfacePoint& point, const dvec3& toward_viewer, const GlossyLobes& lobes,
                              const dvec3& numbers, Rng& ray_rng, CellSum& light) const {
    const PathVertex vertex(point, lobes.bsdf, -toward_viewer);
    const float lines = has_wide_lobes(point.material) ? direct_.fire_lines_on_surface(vertex) : 0.0f;
    if (lines > 0.0f)
        if (const auto line = direct_.line_toward_fire(vertex, lines, ray_rng, kLeastWeight))
            add(medium_.glance(line->ray, line->end, float(lobes.split.of_rays(line->ray.direction)), ray_rng),
                line->weight, true, light);
    const std::optional<BsdfSample> drawn = lobes.bsdf.sample(toward_viewer, numbers);
    if (!drawn || point.leaks(toward_viewer, drawn->wi))
        return 0.0;
    const float of_rays = drawn->delta ? 1.0f : float(lobes.split.of_rays(drawn->wi));
    Rgb weight = drawn->weight;
    RaySegment segment = direct_.segment_along(point.leaving(drawn->wi));
    double closeness = 0.0;
    for (bool first = true;; first = false) {
        const SecondaryField::Seen seen = medium_.glance(segment.ray, segment.end, of_rays, ray_rng);
        const bool by_lines = first && !drawn->delta && !is_dark(seen);
        const float share = by_lines ? direct_.weight_of_sample(lines, segment.ray, drawn->pdf) : 1.0f;
        add(seen, share * weight, first, light);
        if (first)
            closeness = seen.closeness + seen.transmittance / segment.end;
        if (!through_panes_ || !segment.point)
            return closeness;
        weight *= seen.transmittance * Panes::straight_on(*segment.point, segment.ray.direction);
        if (weight == Rgb(0.0f))
            return closeness;
        segment = direct_.segment_along(segment.point->leaving(segment.ray.direction));
    }
}

}  // namespace brisance
