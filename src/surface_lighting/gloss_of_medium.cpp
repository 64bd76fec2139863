#include "surface_lighting/gloss_of_medium.h"

#include <cmath>

#include "base_lighting/panes.h"

namespace brisance {

namespace {

bool is_dark(const CellSum& cells) {
    return cells.at(Cell::V) == Rgb(0.0f) && scattered_by_medium(cells) == Rgb(0.0f);
}

}  // namespace

bool has_wide_lobes(const SurfaceMaterial& m) {
    return needs_energy_tables(m) && double(m.roughness) * m.roughness >= kSmoothAlpha;
}

void GlossOfMedium::reflect(const SurfacePoint& point, const dvec3& toward_viewer, const GlossyLobes& lobes, Rng& rng,
                            Rng& ray_rng, CellSum& light) const {
    const PathVertex vertex(point, lobes.bsdf, -toward_viewer);
    const float lines = has_wide_lobes(point.material) ? direct_.fire_lines_on_surface(vertex) : 0.0f;
    // `of_rays`: of MM, what ray lights leave to rays.
    const auto add = [&](CellSum cells, const Rgb& weight, float of_rays, bool first) {
        cells.at(Cell::MM) *= of_rays;
        light.at(first ? Cell::SV : Cell::SS) += weight * cells.at(Cell::V);
        light.at(first ? Cell::SM : Cell::SS) += weight * scattered_by_medium(cells);
    };
    if (lines > 0.0f)
        if (const auto line = direct_.line_toward_fire(vertex, lines, ray_rng))
            add(medium_.look(line->ray, line->end, ray_rng).cells, line->weight,
                float(lobes.split.of_rays(line->ray.direction)), true);
    const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
    const std::optional<BsdfSample> drawn = lobes.bsdf.sample(toward_viewer, {x, y, z});
    if (!drawn || point.leaks(toward_viewer, drawn->wi))
        return;
    const float of_rays = drawn->delta ? 1.0f : float(lobes.split.of_rays(drawn->wi));
    Rgb weight = drawn->weight;
    RaySegment segment = direct_.segment_along(point.leaving(drawn->wi));
    for (bool first = true;; first = false) {
        const RaySum seen = medium_.look(segment.ray, segment.end, ray_rng);
        const bool by_lines = first && !drawn->delta && !is_dark(seen.cells);
        const float share = by_lines ? direct_.weight_of_sample(lines, segment.ray, drawn->pdf) : 1.0f;
        add(seen.cells, share * weight, of_rays, first);
        if (!through_panes_ || !segment.point || seen.depth > kOpaqueDepth)
            return;
        weight *= std::exp(-seen.depth) * Panes::straight_on(*segment.point, segment.ray.direction);
        if (weight == Rgb(0.0f))
            return;
        segment = direct_.segment_along(segment.point->leaving(segment.ray.direction));
    }
}

}  // namespace brisance
