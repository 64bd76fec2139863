#include "light_selection/gloss_split.h"

#include <numbers>

namespace brisance {

GlossSplit::GlossSplit(const SurfacePoint& point, const Bsdf& gloss, const dvec3& toward_viewer, double light_samples)
    : point_(point), gloss_(gloss), toward_viewer_(toward_viewer), density_(light_samples / (2.0 * std::numbers::pi)) {}

double GlossSplit::of_rays(const dvec3& to_light) const {
    const dvec3& n = point_.geometric_normal;
    if (!(density_ > 0.0) || glm::dot(n, to_light) * glm::dot(n, toward_viewer_) <= 0.0)
        return 1.0;
    const double by_rays = gloss_.pdf(toward_viewer_, to_light);
    return by_rays / (by_rays + density_);
}

Rgb GlossSplit::of_lights(const dvec3& to_light) const {
    const double rays = of_rays(to_light);
    return rays < 1.0 ? gloss_.evaluate(toward_viewer_, to_light) * float(1.0 - rays) : Rgb(0.0f);
}

}  // namespace brisance
