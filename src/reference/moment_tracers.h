// Path tracers for the moments of an open shutter.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "camera/camera.h"
#include "emitters/surroundings.h"
#include "reference/path_tracer.h"

namespace brisance {

// What there is at one moment, by reference. Local space is the same at all moments of a frame.
struct Moment {
    const Medium* medium;
    const Surroundings* surroundings;  // null: none
    const Camera* camera;
};

// Moments that share medium and surroundings share a tracer. All moments have equal weight.
class MomentTracers {
public:
    // One moment. Keeps references.
    MomentTracers(const PathTracer& tracer, const Camera& camera);
    // At least one moment.
    MomentTracers(std::span<const Moment> moments, const TracingSettings& settings, int bounces);

    std::size_t count() const { return cameras_.size(); }
    const PathTracer& tracer(std::size_t moment) const { return *tracers_[moment]; }
    const Camera& camera(std::size_t moment) const { return *cameras_[moment]; }
    std::uint64_t bytes() const;

    // One sample of a pixel: a camera ray within the pixel's filter, at one moment, with its paths [W/(m^2 sr)].
    // Samples are independent of each other: there is no sequence and no stratification.
    PathSum sample(std::size_t pixel, Rng& rng) const;

    // The moment for u in [0, 1).
    std::size_t at(double u) const { return std::min(count() - 1, static_cast<std::size_t>(u * double(count()))); }

private:
    std::vector<std::unique_ptr<PathTracer>> own_;
    std::vector<const PathTracer*> tracers_;  // per moment
    std::vector<const Camera*> cameras_;
};

}  // namespace brisance
