#include "medium_lighting/levels/lamps_in_smoke.h"

#include <cmath>
#include <numbers>

#include "medium/lattice/local_bounds.h"

namespace brisance {

namespace {

double extinction_at(const Medium& medium, const vec3& local) {
    const vec3 node = glm::round(medium.index_from_local * local);
    const std::int64_t found = medium.lattice.find_node(ivec3(node) + medium.reference_node);
    return found < 0 ? 0.0 : double(medium.extinction[static_cast<std::size_t>(found)]);
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
