#include "moving_media.h"

#include <cmath>
#include <numeric>

namespace brisance::testing {

Medium with_velocity(Medium medium, const Velocity& velocity) {
    medium.velocity.resize(medium.lattice.node_count());
    for (std::size_t i = 0; i < medium.velocity.size(); ++i)
        medium.velocity[i] = velocity(vec3(medium.world_of_local(medium.local_of_node(medium.lattice.node(i)))));
    return medium;
}

Velocity everywhere(const vec3& velocity) {
    return [velocity](const vec3&) { return velocity; };
}

Medium gaussian(const dvec3& centre, float extinction, float albedo) {
    Recipe recipe;
    recipe.box = cube(-32, 32);
    recipe.world_from_index = cubic(kSpacing);
    const auto value = [centre](const ivec3& node) {
        const double r = glm::distance(kSpacing * dvec3(node), centre) / kDeviation;
        return r < 4.0 ? float(std::exp(-0.5 * r * r)) : 0.0f;
    };
    recipe.density = value;
    recipe.flame = value;
    recipe.settings = black_smoke();
    recipe.settings.smoke.extinction_per_metre = extinction;
    recipe.settings.smoke.albedo = Rgb(albedo);
    return make_medium(recipe);
}

double total(const std::vector<float>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace brisance::testing
