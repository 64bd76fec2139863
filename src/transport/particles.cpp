#include "transport/particles.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// Of the particles from infinity, those toward a ball that is small.
constexpr double kMostAimed = 0.75;

// `direction`: unit.
dvec3 part_across(const dvec3& v, const dvec3& direction) {
    return v - glm::dot(v, direction) * direction;
}

bool passes_through(const BoundingBall& ball, const Ray& ray) {
    const dvec3 across = part_across(ball.centre - ray.origin, ray.direction);
    return glm::dot(across, across) < ball.radius * ball.radius;
}

}  // namespace

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

Particles::Particles(const DirectLight& scene, const BoundingBall& ball, std::uint64_t total, const BoundingBall& aim)
    : scene_(scene), ball_(ball), aim_(aim), total_(total) {
    if (aim.radius > 0.0 && aim.radius < ball.radius) {
        const double ratio = aim.radius / ball.radius;
        aimed_ = kMostAimed * (1.0 - ratio * ratio);
    }
    const double fire = scene.fire().empty() ? 0.0 : scene.fire().power(), all = emitted_power(scene, ball);
    if (fire > 0.0 && fire == all)
        from_fire_ = total_;
    else if (fire > 0.0 && total_ > 1)
        from_fire_ = std::clamp<std::uint64_t>(std::llround(fire / all * double(total_)), 1, total_ - 1);
}

std::optional<EmittedParticle> Particles::emit(std::uint64_t index, Rng& rng) const {
    if (from_fire(index)) {
        EmittedParticle particle = scene_.fire().emit(rng);
        particle.power /= float(from_fire_);
        return particle;
    }
    if (!scene_.has_emitters())
        return std::nullopt;
    std::optional<EmittedParticle> particle = emit_from_emitters(rng);
    if (particle)
        particle->power /= float(total_ - from_fire_);
    return particle;
}

// Light from infinity starts on a disc across its direction, which covers the ball. A part of it is moved to where the
// ball of the aim is covered; powers are over the density of both.
std::optional<EmittedParticle> Particles::emit_from_emitters(Rng& rng) const {
    std::optional<EmittedParticle> out = scene_.surroundings()->emitters().emit(ball_.centre, ball_.radius, rng);
    if (!out || !out->far || !(aimed_ > 0.0))
        return out;
    Ray& ray = out->ray;
    const double ratio = aim_.radius / ball_.radius;
    if (rng.next_double() < aimed_) {
        const dvec3 across = part_across(ray.origin - ball_.centre, ray.direction);
        ray.origin += part_across(aim_.centre - ball_.centre, ray.direction) - (1.0 - ratio) * across;
    }
    const double density = (passes_through(ball_, ray) ? 1.0 - aimed_ : 0.0) +
                           (passes_through(aim_, ray) ? aimed_ / (ratio * ratio) : 0.0);
    if (!(density > 0.0))  // by rounding, at the rim
        return std::nullopt;
    out->power /= float(density);
    return out;
}

}  // namespace brisance
