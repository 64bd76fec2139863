#include "reference/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "transport/path_step.h"

namespace brisance {

namespace {

// First scatterings drawn on one camera ray. The ray itself, integrated voxel by voxel, costs as much as several of
// them.
constexpr int kFirstCollisions = 16;

// Surface paths that begin at the end of one camera ray through smoke. They share the cost of the ray itself; without
// smoke a ray costs little.
constexpr int kFirstReflections = 4;
// The same where paths know where the light is. Then they cost less than the ray, and a ray without smoke starts as
// many, because surfaces are noisier than smoke.
constexpr int kGuidedReflections = 8;

// Whether paths from surfaces find more by a guide: it aims at fire and lit smoke.
bool wants_guide(const DirectLight& scene, int bounces) {
    return bounces != 0 && scene.settings().light_sampling && !scene.fire().empty() && scene.surroundings() &&
           scene.surroundings()->has_surfaces();
}

}  // namespace

// Files the light that a path gathers by the number of its scatterings and by the ledger's cell.
class PathTracer::Filing : public PlainPath {
public:
    Filing(const PathTracer& tracer, bool row_surface, PathSum& sum, PathStatistics& statistics)
        : PlainPath(tracer.direct_),
          bounces_(tracer.bounces_),
          guide_(tracer.guide()),
          row_surface_(row_surface),
          sum_(sum),
          statistics_(statistics) {}

    // Integrates the whole line where the path does not continue and no surface ends the segment.
    SegmentMedium medium_along(const PathState& state, const PathStep& step, Rng& rng) const {
        if (continues(state) || scene_.surroundings())
            return PlainPath::medium_along(state, step, rng);
        return {scene_.lines().follow_line(step.segment.ray, rng), Rgb(0.0f), std::nullopt, 1.0f};
    }

    bool continues(const PathState& state) const { return bounces_ < 0 || state.order < bounces_; }

    void gather(const PathState& state, const PathStep& step) {
        ++statistics_.scatterings;
        const Rgb from_fire = state.throughput * step.from_fire;
        const Rgb from_emitters = state.throughput * step.from_emitters;
        const Rgb emission = step.emission_weight * step.leaving * step.medium.emission;
        const Rgb at_end = step.leaving * step.at_end;
        add(state.order, Sender::V, from_fire);
        add(state.order, Sender::A, from_emitters);
        add(state.order, Sender::V, emission);
        add(state.order, Sender::A, at_end);
        statistics_.note({state.order, state.vertex.position(), state.throughput, emission + at_end, from_fire,
                          from_emitters, state.vertex.on_surface()});
    }

    // A guided direction finds the fire too: no line toward it besides.
    void begin(PathState& state) const {
        if (guides(state.vertex))
            state.fire_lines = 0.0f;
    }

    std::optional<PathVertex::Sample> direction(const PathState& state, Rng& rng) const {
        return guides(state.vertex) ? guide_->sample(state.vertex, rng) : PlainPath::direction(state, rng);
    }

    bool arrive(const PathState&, const PathStep&, PathState& next) {
        begin(next);
        if (next.order == 2)
            column_ = next.vertex.on_surface() ? Sender::S : Sender::M;
        return true;
    }

private:
    bool guides(const PathVertex& vertex) const { return guide_ && vertex.on_surface() && !vertex.only_delta(); }

    // `source`: of the light, which names the column of what has scattered once.
    void add(int order, Sender source, const Rgb& radiance) {
        sum_[std::min(order, kPathOrders - 1)] += radiance;
        if (scene_.surroundings())
            sum_.cells.at(cell_of(row_surface_, order == 1 ? source : column_)) += radiance;
    }

    int bounces_;
    const LightGuide* guide_;
    bool row_surface_;           // the path's first vertex lies on a surface
    Sender column_ = Sender::M;  // and its second vertex there or in the medium
    PathSum& sum_;
    PathStatistics& statistics_;
};

PathTracer::PathTracer(const Medium& medium, const TracingSettings& settings, int bounces,
                       const Surroundings* surroundings, Guiding guiding)
    : bounces_(bounces), direct_(medium, settings, surroundings) {
    if (surroundings && settings.emission == EmissionEstimator::Collision)
        throw Error(ExitCode::Usage,
                    "tracing.emission: \"collision\", the plain tracker, knows neither surfaces nor lights; "
                    "use \"line\", or a shot without a scene");
    if (guiding == Guiding::Allowed && wants_guide(direct_, bounces)) {
        guide_.emplace(direct_);
        if (guide_->empty())
            guide_.reset();
    }
}

void PathTracer::trace(const Ray& ray, double position, Rng& rng, PathSum& sum, PathStatistics& statistics) const {
    if (direct_.fire().empty() && !direct_.surroundings())
        return;
    if (settings().emission == EmissionEstimator::Collision)
        trace_plain(ray, rng, sum, statistics);
    else
        trace_lines(ray, position, rng, sum, statistics);
}

void PathTracer::add_seen(Cell cell, const Rgb& radiance, PathSum& sum) const {
    sum[0] += radiance;
    if (direct_.surroundings())
        sum.cells.at(cell) += radiance;
}

void PathTracer::trace_lines(const Ray& camera_ray, double position, Rng& rng, PathSum& sum,
                             PathStatistics& statistics) const {
    thread_local CameraLine seen;
    const RaySegment segment = direct_.segment_along(camera_ray);
    direct_.lines().follow_camera(camera_ray, rng, seen, segment.end);
    add_seen(Cell::V, seen.radiance, sum);
    const auto through = static_cast<float>(seen.transmittance());
    Rgb at_end(0.0f);
    if (direct_.surroundings()) {
        at_end = through * direct_.at_end(segment, 0.0, true, nullptr);
        add_seen(Cell::A, at_end, sum);
    }
    statistics.note({0, camera_ray.origin, Rgb(1.0f), seen.radiance + at_end, Rgb(0.0f)});
    if (bounces_ == 0)
        return;
    const double opacity = seen.opacity();
    const Rgb throughput(static_cast<float>(opacity / kFirstCollisions));
    for (int i = 0; i < kFirstCollisions && opacity > 0.0; ++i) {
        const Collision first = direct_.lines().choose(seen, (i + position) / kFirstCollisions);
        trace_from(state_in_medium(direct_, camera_ray, first, throughput, 1), rng, sum, statistics);
    }
    if (!segment.point || !(through > 0.0f))
        return;
    const int reflections = first_reflections(*segment.point, camera_ray.direction, opacity > 0.0, through);
    for (int i = 0; i < reflections; ++i)
        trace_from(
            state_on_surface(direct_, *segment.point, camera_ray.direction, Rgb(through / float(reflections)), 1), rng,
            sum, statistics);
}

// Paths that begin at a surface seen through a transmittance. All that go on from a mirror or clear glass go the same
// ways, and aim at nothing.
int PathTracer::first_reflections(const SurfacePoint& point, const dvec3& arriving, bool through_smoke,
                                  float transmittance) const {
    const bool guided = guide_ && !PathVertex(point, arriving).only_delta();
    if (!guided && !through_smoke)
        return 1;
    return static_cast<int>(std::ceil(transmittance * float(guided ? kGuidedReflections : kFirstReflections)));
}

void PathTracer::trace_from_surface(const SurfacePoint& point, const dvec3& arriving, Rng& rng, PathSum& sum) const {
    PathStatistics ignored;
    if (bounces_ != 0)
        trace_from(state_on_surface(direct_, point, arriving, Rgb(1.0f), 1), rng, sum, ignored);
}

void PathTracer::trace_from(PathState first, Rng& rng, PathSum& sum, PathStatistics& statistics) const {
    ++statistics.paths;
    Filing filing(*this, first.vertex.on_surface(), sum, statistics);
    filing.begin(first);
    walk_path(direct_, first, filing, rng);
}

}  // namespace brisance
