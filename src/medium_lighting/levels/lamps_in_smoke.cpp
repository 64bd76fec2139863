#include "medium_lighting/levels/lamps_in_smoke.h"

#include <cmath>
#include <numbers>

#include "medium/lattice/local_bounds.h"

namespace brisance {

namespace {

// Trilinear, so that a lamp that moves changes nothing at once.
double extinction_at(const Medium& medium, const vec3& local) {
    const vec3 at = medium.index_from_local * local, low = glm::floor(at);
    double sum = 0.0;
    for (int k = 0; k < 8; ++k) {
        const ivec3 corner(k & 1, k >> 1 & 1, k >> 2 & 1);
        const vec3 weight = glm::mix(1.0f - (at - low), at - low, vec3(corner));
        const std::int64_t node = medium.lattice.find_node(ivec3(low) + corner + medium.reference_node);
        if (node >= 0)
            sum += double(weight.x * weight.y * weight.z) * medium.extinction[static_cast<std::size_t>(node)];
    }
    return sum;
}

}  // namespace

LampsInSmoke::LampsInSmoke(const Surroundings& surroundings, const Medium& medium, double fire_power) {
    using std::numbers::pi;
    const Emitters& emitters = surroundings.emitters();
    if (emitters.points().empty() || medium.lattice.node_count() == 0)
        return;
    const LocalBounds box = local_bounds(medium);
    const double all = fire_power + emitters.power(0.5 * double(box.diagonal()));
    const double radius = double(medium.spacing) * std::cbrt(0.75 / pi);
    for (const PointEmitter& lamp : emitters.points()) {
        const vec3 position(lamp.position);
        const double depth = box.distance(position) > 0.0f ? 0.0 : radius * extinction_at(medium, position);
        if (depth > 0.0)
            lamps_.push_back({depth, 2.0 * pi * (1.0 - lamp.cosine) * lamp.intensity / all});
    }
}

float LampsInSmoke::scattered_beside_them(int level) const {
    double sum = 0.0;
    for (const Lamp& lamp : lamps_)
        sum -= lamp.share * std::expm1(-std::exp2(double(level)) * lamp.depth);
    return static_cast<float>(sum);
}

}  // namespace brisance
