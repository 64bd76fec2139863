#include "transport/particles.h"

#include <algorithm>
#include <cmath>

namespace brisance {

BoundingBall ball_around(const DirectLight& scene) {
    dvec3 low(1e300), high(-1e300);
    const auto include = [&](const dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    };
    if (scene.surroundings())
        for (const SceneMesh& mesh : scene.surroundings()->scene().meshes)
            for (const vec3& p : mesh.positions)
                include(dvec3(p));
    const Medium& medium = scene.field().medium();
    const BrickLattice& bricks = scene.field().bricks();
    for (int corner = 0; corner < 8 && !bricks.empty(); ++corner) {
        const ivec3 brick =
            bricks.min_brick() + bricks.brick_extent() * ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
        include(dvec3(medium.local_of_node(brick * BrickLattice::kSize)));
    }
    if (!(low.x <= high.x))
        return {};
    return {0.5 * (low + high), 0.5 * glm::length(high - low)};
}

double emitted_power(const DirectLight& scene, const BoundingBall& ball) {
    return (scene.fire().empty() ? 0.0 : scene.fire().power()) +
           (scene.has_emitters() ? scene.surroundings()->emitters().power(ball.radius) : 0.0);
}

Particles::Particles(const DirectLight& scene, const BoundingBall& ball, std::uint64_t total)
    : scene_(scene), ball_(ball), total_(total) {
    const double fire = scene.fire().empty() ? 0.0 : scene.fire().power(), all = emitted_power(scene, ball);
    if (fire > 0.0 && fire == all)
        from_fire_ = total_;
    else if (fire > 0.0 && total_ > 1)
        from_fire_ = std::clamp<std::uint64_t>(std::llround(fire / all * double(total_)), 1, total_ - 1);
}

std::optional<EmittedParticle> Particles::emit(std::uint64_t index, Rng& rng) const {
    const bool fire = from_fire(index);
    if (!fire && !scene_.has_emitters())
        return std::nullopt;
    std::optional<EmittedParticle> particle =
        fire ? scene_.fire().emit(rng) : scene_.surroundings()->emitters().emit(ball_.centre, ball_.radius, rng);
    if (particle)
        particle->power /= float(fire ? from_fire_ : total_ - from_fire_);
    return particle;
}

}  // namespace brisance
