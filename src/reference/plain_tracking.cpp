// The plain tracker adds emission at every tentative collision and absorbs or scatters at real ones (Woodcock et al.
// 1965). It is the baseline for the line estimator of path_tracer.cpp.
#include <algorithm>
#include <cmath>

#include "reference/path_tracer.h"
#include "transport/roulette.h"

namespace brisance {

namespace {

// Tentative collisions per voxel where the medium emits. The smoke alone may need none.
constexpr double kTentativePerVoxel = 1.0 / 4.0;

double majorant_of(const TrackingField& field, const VoxelSegment& s) {
    const double per_voxel = glm::length(s.direction) * kTentativePerVoxel;
    const bool emits = field.burns(s.brick) && field.has_emission();
    return std::max<double>(field.majorant(s.brick), emits ? per_voxel : 0.0);
}

// Calls collect(emission [W/(m^3 sr)], majorant [1/m]) at the tentative collisions of a brick, up to a real one.
template <class Collect>
std::optional<Collision> track_in_brick(const TrackingField& field, const VoxelSegment& s, Rng& rng,
                                        const Collect& collect) {
    const bool burns = field.burns(s.brick);
    const double majorant = majorant_of(field, s);
    if (majorant <= 0.0)
        return std::nullopt;
    for (double t = s.begin + rng.next_exponential() / majorant; t < s.end; t += rng.next_exponential() / majorant) {
        const vec3 p = point_in_brick(s, t);
        const float sigma = field.extinction(s.brick, p);
        Rgb emission(0.0f);
        if (burns && field.has_source())
            emission += sigma * field.source(s.brick, p);
        if (burns && field.has_emission())
            emission += field.emission(s.brick, p);
        collect(emission, float(majorant));
        if (rng.next_double() * majorant < sigma)
            return Collision{t, s.brick, p};
    }
    return std::nullopt;
}

}  // namespace

void PathTracer::trace_plain(Ray ray, Rng& rng, PathSum& sum, PathStatistics& statistics) const {
    ++statistics.paths;
    Rgb throughput(1.0f);
    for (int order = 0;; ++order) {
        statistics.note({order, ray.origin, throughput, Rgb(0.0f), Rgb(0.0f)});
        const auto collect = [&](const Rgb& emission, float majorant) {
            const Rgb gathered = throughput * emission / majorant;
            sum[std::min(order, kPathOrders - 1)] += gathered;
            if (statistics.vertices) [[unlikely]]
                statistics.vertices->back().along_segment += gathered;
        };
        std::optional<Collision> collision;
        walk_bricks(field().bricks(), field().enter(ray), [&](const VoxelSegment& s) {
            collision = track_in_brick(field(), s, rng, collect);
            return !collision;
        });
        if (!collision || order == bounces_)
            return;
        const Rgb albedo = field().albedo(collision->brick, collision->position);
        const float scatter = largest(throughput * albedo) / std::max(largest(throughput), 1e-30f);
        if (!(rng.next_double() < scatter))
            return;
        throughput *= albedo / scatter;
        ++statistics.scatterings;
        ray = {ray.origin + ray.direction * collision->distance,
               sample_henyey_greenstein(ray.direction, field().mean_cosine(), rng)};
    }
}

}  // namespace brisance
