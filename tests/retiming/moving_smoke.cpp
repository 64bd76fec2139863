#include "moving_smoke.h"

#include <cmath>

#include "media/node_media.h"

namespace brisance::testing {

namespace {

constexpr double kCut = 1e-3;  // density below is none, as simulations write it

media::NodeBox box_of(const MovingSmoke& smoke, double time) {
    dvec3 low(1e9), high(-1e9);
    for (const Blob& blob : smoke.blobs) {
        const dvec3 centre = smoke.motion.place(blob.centre, time);
        low = glm::min(low, centre - 5.0 * blob.sigma);
        high = glm::max(high, centre + 5.0 * blob.sigma);
    }
    return {ivec3(glm::floor(low)), ivec3(glm::ceil(high))};
}

}  // namespace

dvec3 RigidMotion::place(const dvec3& p, double time) const {
    const double c = std::cos(spin * time), s = std::sin(spin * time);
    return dvec3(c * p.x - s * p.y, s * p.x + c * p.y, p.z) + time * velocity;
}

dvec3 RigidMotion::velocity_at(const dvec3& p) const {
    return spin * dvec3(-p.y, p.x, 0.0) + velocity;
}

double MovingSmoke::density(const dvec3& p, double time) const {
    double sum = 0.0;
    for (const Blob& blob : blobs) {
        const dvec3 d = p - motion.place(blob.centre, time);
        sum += blob.amount * std::exp(-0.5 * glm::dot(d, d) / (blob.sigma * blob.sigma));
    }
    return sum < kCut ? 0.0 : sum;
}

BlockGrid MovingSmoke::grid(double time, const ivec3& shift) const {
    media::NodeBox box = box_of(*this, time);
    box.low += shift;
    box.high += shift;
    return media::scalar_grid("density", media::cubic(kVoxel, -kVoxel * dvec3(shift)), box, [&](const ivec3& node) {
        return static_cast<float>(density(dvec3(node - shift), time));
    });
}

BlockGrid MovingSmoke::velocity(double time) const {
    return media::colour_grid("velocity", media::cubic(kVoxel), box_of(*this, time), [&](const ivec3& node) {
        const bool there = density(dvec3(node), time) > 0.0;
        return there ? Rgb(motion.velocity_at(dvec3(node)) / unit) : Rgb(0.0f);
    });
}

SourceFrame MovingSmoke::frame(double time) const {
    return {{grid(time)}, centred_velocity({velocity(time)})};
}

BetweenFrames MovingSmoke::pair(double first, double second, double time) const {
    return {frame(first), frame(second), (time - first) / (second - first), static_cast<int>(second - first), "test"};
}

MovingSmoke turning_smoke(double spin) {
    MovingSmoke smoke;
    smoke.blobs = {{{12.0, 3.0, 1.0}, 2.5, 1.0}, {{-8.0, 9.0, 3.0}, 3.5, 0.7}, {{-2.0, -13.0, -4.0}, 2.0, 1.3}};
    smoke.motion.spin = spin;
    return smoke;
}

}  // namespace brisance::testing
