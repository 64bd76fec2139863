#include "reference/moment_tracers.h"

#include "camera/pixel_filter.h"

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

PathSum MomentTracers::sample(std::size_t pixel, Rng& rng) const {
    const CameraSettings& s = camera(0).settings();
    const auto width = static_cast<std::size_t>(s.width);
    const double x = rng.next_double() - 0.5, y = rng.next_double() - 0.5, position = rng.next_double();
    const double column = double(pixel % width) + 0.5 + x * s.filter_width_pixels;
    const double row = double(pixel / width) + 0.5 + y * s.filter_width_pixels;
    const std::size_t moment = count() > 1 ? at(rng.next_double()) : 0;
    PathSum path{};
    PathStatistics ignored;
    tracer(moment).trace(camera(moment).ray(column, row), position, rng, path, ignored);
    const float weight = filter_weight(s.filter, x, y);
    for (Rgb& order : path)
        order *= weight;
    for (Rgb& cell : path.cells)
        cell *= weight;
    return path;
}

std::uint64_t MomentTracers::bytes() const {
    std::uint64_t sum = 0;
    for (const std::unique_ptr<PathTracer>& tracer : own_)
        sum += tracer->bytes();
    return sum;
}

}  // namespace brisance
