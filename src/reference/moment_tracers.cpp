#include "reference/moment_tracers.h"

namespace brisance {

MomentTracers::MomentTracers(const PathTracer& tracer, const Camera& camera) : tracers_{&tracer}, cameras_{&camera} {}

MomentTracers::MomentTracers(std::span<const Moment> moments, const TracingSettings& settings, int bounces) {
    for (std::size_t k = 0; k < moments.size(); ++k) {
        const Moment& m = moments[k];
        const bool still = k > 0 && moments[k - 1].medium == m.medium && moments[k - 1].surroundings == m.surroundings;
        if (!still)
            own_.push_back(std::make_unique<PathTracer>(*m.medium, settings, bounces, m.surroundings));
        tracers_.push_back(own_.back().get());
        cameras_.push_back(m.camera);
    }
}

std::uint64_t MomentTracers::bytes() const {
    std::uint64_t sum = 0;
    for (const std::unique_ptr<PathTracer>& tracer : own_)
        sum += tracer->bytes();
    return sum;
}

}  // namespace brisance
