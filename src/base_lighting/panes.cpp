#include "base_lighting/panes.h"

#include <algorithm>

namespace brisance {

namespace {

// Fraction transmitted in the direction opposite to `toward`.
Rgb straight_weight(const SurfaceMaterial& m, const ShadingFrame& frame, const dvec3& toward) {
    return m.transmission > 0.0f ? Bsdf(m, frame).straight_on(toward) : Rgb(0.0f);
}

bool is_pane(const SceneMaterial& m) {
    const ShadingFrame frame;
    return straight_weight(m.surface, frame, frame.normal) != Rgb(0.0f);
}

}  // namespace

Panes::Panes(const Surroundings& surroundings)
    : surroundings_(surroundings), any_(std::ranges::any_of(surroundings.scene().materials, is_pane)) {}

Rgb Panes::straight_on(const SurfacePoint& point, const dvec3& direction) {
    return straight_weight(point.material, point.frame, -direction);
}

Panes::Passage Panes::along(Ray ray, double end) const {
    Passage passage;
    if (!any_) {
        passage.blocked = surroundings_.intersector().occluded(ray, end);
        return passage;
    }
    while (const std::optional<SurfaceHit> hit = surroundings_.intersector().first_hit(ray, end)) {
        const SurfacePoint point = surface_point(surroundings_.scene(), *hit, -ray.direction);
        passage.weight *= straight_on(point, ray.direction);
        ++passage.panes;
        end -= hit->distance;
        passage.blocked = passage.weight == Rgb(0.0f) || !(end > 0.0);
        if (passage.blocked)
            return passage;
        ray = point.leaving(ray.direction);
    }
    return passage;
}

}  // namespace brisance
