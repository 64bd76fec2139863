#include "reference/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <vector>
#include <cstdlib>

#include "core/error.h"
#include "medium/phase.h"
#include "transport/path_step.h"

namespace brisance {

namespace {

// First scatterings drawn on one camera ray. The ray itself, integrated voxel by voxel, costs as much as several of
// them.
const int kFirstCollisions = getenv("NFIRST") ? atoi(getenv("NFIRST")) : 16;

// Surface paths that begin at the end of one camera ray through smoke. They share the cost of the ray itself; without
// smoke a ray costs little.
const int kFirstReflections = getenv("NREF") ? atoi(getenv("NREF")) : 1;

const float kGlowShare = getenv("GLOW") ? atof(getenv("GLOW")) : 0.5f;
const float kFlowShare = getenv("FLOW") ? atof(getenv("FLOW")) : 0.7f;
const float kRL = getenv("RL") ? atof(getenv("RL")) : 0.5f;
const float kP = getenv("P") ? atof(getenv("P")) : 1.0f;
constexpr float kMostCosine = 0.95f;
const float kSplitAbove = getenv("SPLIT") ? atof(getenv("SPLIT")) : 2.0f;
const float kMostCopies = 8.0f, kLeastSurvival = 0.1f;

}  // namespace

// Files the light that a path gathers by the number of its scatterings and by the ledger's cell.
class PathTracer::Filing : public PlainPath {
public:
    Filing(const PathTracer& tracer, bool row_surface, PathSum& sum, PathStatistics& statistics)
        : PlainPath(tracer.direct_),
          bounces_(tracer.bounces_),
          guide_(*tracer.guide_),
          row_surface_(row_surface),
          sum_(sum),
          statistics_(statistics) {}

    // Integrates the whole line where the path does not continue and no surface ends the segment.
    SegmentMedium medium_along(const PathState& state, const PathStep& step, Rng& rng) const {
        if (controls_) {
            const LineResult line = scene_.lines().follow_lit(step.segment.ray, guide_.scattered(), rng, step.segment.end);
            return {line.radiance, line.scattered, line.collision, 1.0f};
        }
        if (continues(state) || scene_.surroundings())
            return PlainPath::medium_along(state, step, rng);
        return {scene_.lines().follow_line(step.segment.ray, rng), Rgb(0.0f), std::nullopt, 1.0f};
    }

    bool continues(const PathState& state) const { return bounces_ < 0 || state.order < bounces_; }

    // The vertex's own distribution, mixed with that of the guide: toward the glow of the smoke from surfaces and from
    // thin smoke, along the flow of light in thick smoke.
    std::optional<PathVertex::Sample> direction(const PathState& state, Rng& rng) const {
        if (guide_.empty() || state.vertex.only_delta() || (!state.vertex.on_surface() && state.fire_lines > 0.0f))
            return state.vertex.sample(rng);
        if (state.vertex.on_surface() || thin_)
          if (state.fire_lines == 0.0f)
            return toward_glow(state, state.vertex.on_surface() ? guide_.glow_share(state.vertex.position()) : kGlowShare, rng);
        return along_flow(state, rng);
    }

    int copies(PathState& state, float begin, bool is_long, Rng& rng) {
        static const bool window = getenv("WIN");
        if (window && !state.vertex.on_surface()) if (const LightGuide::Cell* cell = guide_.at(state.vertex.position())) {
            const float expected = luminance(state.throughput) * std::pow(cell->radiance, kP);
            if (expected_ <= 0.0f) {
                expected_ = expected;
                return PlainPath::copies(state, begin, is_long, rng);
            }
            const float ratio = expected / expected_;
            float goal = ratio > kSplitAbove ? std::min(ratio, kMostCopies) : ratio >= kRL ? 1.0f : std::max(ratio / kRL, kLeastSurvival);
            const int n = int(goal + rng.next());
            state.throughput /= goal;
            state.before /= goal;
            return n;
        }
        if (!controls_ || state.vertex.on_surface())
            return PlainPath::copies(state, begin, is_long, rng);
        const float part = std::max(largest(state.throughput), 0.1f * largest(state.before)) / begin;
        if (part >= kRL)
            return 1;
        if (!(rng.next() < part / kRL))
            return 0;
        state.throughput /= part / kRL;
        state.before /= part / kRL;
        return 1;
    }
    void begin(PathState& state, float expected) {
        expected_ = expected;
        arrive_at(state);
    }
    void arrive_at(PathState& state) {
        thin_ = state.fire_lines > 0.0f;
        static const bool lines = getenv("LINES");
        if (!guide_.empty() && (state.vertex.on_surface() || !lines))
            state.fire_lines = 0.0f;
    }

    void gather(const PathState& state, const PathStep& step) {
        ++statistics_.scatterings;
        const Rgb from_fire = state.throughput * step.from_fire;
        const Rgb from_emitters = state.throughput * step.from_emitters;
        const Rgb emission = step.emission_weight * step.leaving * step.medium.emission;
        const Rgb at_end = step.leaving * step.at_end;
        if (controls_) {
            Rgb known = step.leaving * step.medium.scattered;
            file(state.order + 1, cell_of(row_surface_, state.order == 1 ? Sender::M : column_), known);
            const std::ptrdiff_t cell = state.vertex.on_surface() ? -1 : guide_.cell_at(state.vertex.position());
            if (cell >= 0) {
                if (state.order == 1) {
                    for (const Sender sender : {Sender::V, Sender::M, Sender::S, Sender::A})
                        file(sender == Sender::V || sender == Sender::A ? 1 : 2, cell_of(false, sender), -state.before * guide_.scattered(cell, sender));
                } else {
                    file(state.order, cell_of(row_surface_, column_), -state.before * guide_.scattered().cells[cell]);
                }
            }
        }
        add(state.order, Sender::V, from_fire);
        add(state.order, Sender::A, from_emitters);
        add(state.order, Sender::V, emission);
        add(state.order, Sender::A, at_end);
        statistics_.note({state.order, state.vertex.position(), state.throughput, emission + at_end, from_fire,
                          from_emitters, state.vertex.on_surface()});
    }

    bool arrive(const PathState&, const PathStep&, PathState& next) {
        arrive_at(next);
        if (next.order == 2)
            column_ = next.vertex.on_surface() ? Sender::S : Sender::M;
        return true;
    }

private:
    std::optional<PathVertex::Sample> toward_glow(const PathState& state, float share, Rng& rng) const {
        PathVertex::Sample sample;
        if (rng.next() < share) {
            sample.wi = guide_.sample_glow(state.vertex.position(), rng);
        } else {
            const std::optional<PathVertex::Sample> own = state.vertex.sample(rng);
            if (!own)
                return own;
            sample = *own;
            if (sample.delta) {
                sample.weight /= 1.0f - share;
                return sample;
            }
        }
        const PathVertex::Value scattered = state.vertex.at(sample.wi);
        if (scattered.value == Rgb(0.0f))
            return std::nullopt;
        sample.pdf = scattered.pdf;
        sample.weight = scattered.value / float(share * guide_.pdf_glow(state.vertex.leaving(sample.wi)) + (1.0f - share) * scattered.pdf);
        return sample;
    }
    std::optional<PathVertex::Sample> along_flow(const PathState& state, Rng& rng) const {
        const LightGuide::Cell* cell = guide_.at(state.vertex.position());
        const float cosine = cell ? std::min(glm::length(cell->flow), kMostCosine) : 0.0f;
        if (cosine < 0.01f)
            return state.vertex.sample(rng);
        const dvec3 towards = -glm::normalize(dvec3(cell->flow));
        const float share = kFlowShare;
        PathVertex::Sample sample;
        const double kappa = cosine * (3.0 - cosine * cosine) / (1.0 - cosine * cosine);
        if (rng.next() < share) {
            const double u = rng.next_double(), c = 1.0 + std::log(u + (1.0 - u) * std::exp(-2.0 * kappa)) / kappa;
            const double si = std::sqrt(std::max(0.0, 1.0 - c * c)), phi = 6.283185307179586 * rng.next_double();
            sample.wi = glm::normalize(frame_around(towards).world_from_local({si * std::cos(phi), si * std::sin(phi), c}));
        } else
            sample = *state.vertex.sample(rng);
        const PathVertex::Value scattered = state.vertex.at(sample.wi);
        sample.pdf = scattered.pdf;
        sample.weight = scattered.value / float(share * kappa / (6.283185307179586 * -std::expm1(-2.0 * kappa)) * std::exp(kappa * (glm::dot(towards, sample.wi) - 1.0)) + (1.0f - share) * scattered.pdf);
        return sample;
    }

    // `source`: of the light, which names the column of what has scattered once.
    void add(int order, Sender source, const Rgb& radiance) {
        file(order, cell_of(row_surface_, order == 1 ? source : column_), radiance);
    }
    void file(int order, Cell cell, const Rgb& radiance) {
        sum_[std::min(order, kPathOrders - 1)] += radiance;
        if (scene_.surroundings())
            sum_.cells.at(cell) += radiance;
    }

    int bounces_;
    const LightGuide& guide_;
    bool controls_ = !guide_.empty() && bounces_ < 0 && !getenv("NOCTRL");
    bool thin_ = false;
    float expected_ = 0.0f;
    bool row_surface_;           // the path's first vertex lies on a surface
    Sender column_ = Sender::M;  // and its second vertex there or in the medium
    PathSum& sum_;
    PathStatistics& statistics_;
};

PathTracer::PathTracer(const Medium& medium, const TracingSettings& settings, int bounces,
                       const Surroundings* surroundings)
    : bounces_(bounces), direct_(medium, settings, surroundings) {
    guide_ = getenv("NOGUIDE") ? std::make_unique<LightGuide>() : std::make_unique<LightGuide>(direct_);
    if (surroundings && settings.emission == EmissionEstimator::Collision)
        throw Error(ExitCode::Usage,
                    "tracing.emission: \"collision\", the plain tracker, knows neither surfaces nor lights; "
                    "use \"line\", or a shot without a scene");
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
    if (opacity > 0.0 && guide_->empty()) {
        const Rgb throughput(static_cast<float>(opacity / kFirstCollisions));
        for (int i = 0; i < kFirstCollisions; ++i) {
            const Collision first = direct_.lines().choose(seen, (i + position) / kFirstCollisions);
            trace_from(state_in_medium(direct_, camera_ray, first, throughput, 1), rng, sum, statistics);
        }
    } else if (opacity > 0.0) {
        thread_local std::vector<double> upto;
        upto.clear();
        double total = 0.0;
        if (bounces_ < 0 && !getenv("NOCTRL"))
            for (const PassedVoxel& v : seen.voxels) {
                const double mass = std::exp(-v.begin_depth) * -std::expm1(v.begin_depth - v.end_depth);
                const std::size_t cell = CoarseField::cell_of(v.segment.brick, v.segment.cube);
                for (const Sender sender : {Sender::V, Sender::M, Sender::S, Sender::A}) {
                    const Rgb known = float(mass) * guide_->scattered(cell, sender);
                    sum[sender == Sender::V || sender == Sender::A ? 1 : 2] += known;
                    if (direct_.surroundings())
                        sum.cells.at(cell_of(false, sender)) += known;
                }
            }
        for (const PassedVoxel& v : seen.voxels) {
            const double mass = std::exp(-v.begin_depth) * -std::expm1(v.begin_depth - v.end_depth);
            upto.push_back(total += mass * std::pow(guide_->of(v.segment).radiance, kP));
        }
        const int n = kFirstCollisions;
        for (int i = 0; i < n; ++i) {
            const double at = (i + position) / n * total;
            const std::size_t k = std::min<std::size_t>(std::upper_bound(upto.begin(), upto.end(), at) - upto.begin(), upto.size() - 1);
            const PassedVoxel& v = seen.voxels[k];
            const double before = k ? upto[k - 1] : 0.0;
            const double part = std::clamp((at - before) / (upto[k] - before), 0.0, 1.0);
            const double inside = std::min(-std::log1p(part * std::expm1(v.begin_depth - v.end_depth)), v.end_depth - v.begin_depth);
            const Rgb throughput(static_cast<float>(total / n / std::pow(guide_->of(v.segment).radiance, kP)));
            trace_from(state_in_medium(direct_, camera_ray, direct_.lines().choose_in(v, inside), throughput, 1), rng, sum, statistics, float(total / n));
        }
    }
    if (!segment.point || !(through > 0.0f))
        return;
    const int reflections = opacity > 0.0 ? static_cast<int>(std::ceil(through * (getenv("NREF") ? kFirstReflections : 4))) : kFirstReflections;
    for (int i = 0; i < reflections; ++i)
        trace_from(
            state_on_surface(direct_, *segment.point, camera_ray.direction, Rgb(through / float(reflections)), 1), rng,
            sum, statistics);
}

void PathTracer::trace_from_surface(const SurfacePoint& point, const dvec3& arriving, Rng& rng, PathSum& sum) const {
    PathStatistics ignored;
    if (bounces_ != 0)
        trace_from(state_on_surface(direct_, point, arriving, Rgb(1.0f), 1), rng, sum, ignored);
}

void PathTracer::trace_from(PathState first, Rng& rng, PathSum& sum, PathStatistics& statistics, float expected) const {
    ++statistics.paths;
    Filing filing(*this, first.vertex.on_surface(), sum, statistics);
    filing.begin(first, expected);
    walk_path(direct_, first, filing, rng);
}

}  // namespace brisance
