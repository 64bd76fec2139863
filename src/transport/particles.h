// Particles of light: their starts and their powers.
#pragma once

#include <cstdint>
#include <optional>

#include "transport/direct_light.h"

namespace brisance {

// The ball that particles from infinity aim at.
struct BoundingBall {
    dvec3 centre{0.0};
    double radius = 0.0;
};
BoundingBall ball_around(const DirectLight& scene);

// Total power of the particles, luminance [W].
double emitted_power(const DirectLight& scene, const BoundingBall& ball);

// A set of particles that share the power of fire and emitters. Those of the fire come first.
class Particles {
public:
    // Keeps a reference. `aim`: where light from infinity is wanted; more particles pass through it, with less power
    // each, so that no mean depends on it. Of no radius: everywhere.
    Particles(const DirectLight& scene, const BoundingBall& ball, std::uint64_t total, const BoundingBall& aim = {});

    bool from_fire(std::uint64_t index) const { return index < from_fire_; }
    // Its power is divided by the number of particles of its kind. None where the sampled light emits nothing.
    std::optional<EmittedParticle> emit(std::uint64_t index, Rng& rng) const;

private:
    std::optional<EmittedParticle> emit_from_emitters(Rng& rng) const;

    const DirectLight& scene_;
    BoundingBall ball_;
    BoundingBall aim_;
    double aimed_ = 0.0;  // the share of particles from infinity that start toward the aim
    std::uint64_t total_, from_fire_ = 0;
};

}  // namespace brisance
