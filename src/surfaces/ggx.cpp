#include "surfaces/ggx.h"

#include <algorithm>

namespace brisance {

dvec3 Ggx::sample_visible(const dvec3& wo, double u, double v) const {
    const dvec3 o = glm::normalize(dvec3(alpha * wo.x, alpha * wo.y, wo.z));
    const double azimuth = 2.0 * std::numbers::pi * u;
    const double height = (1.0 - v) * (1.0 + o.z);  // of the sum of cap and o: never below 0
    const double z = height - o.z;
    const double radius = std::sqrt(std::max(0.0, (1.0 - z) * (1.0 + z)));
    const dvec3 sum(radius * std::cos(azimuth) + o.x, radius * std::sin(azimuth) + o.y, height);
    return glm::normalize(dvec3(alpha * sum.x, alpha * sum.y, sum.z));
}

}  // namespace brisance
