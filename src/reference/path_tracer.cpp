#include "reference/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "transport/roulette.h"

namespace brisance {

namespace {

// First scatterings drawn on one ray of the camera: the ray itself, integrated cell by cell, costs as much as several.
constexpr int kFirstCollisions = 16;

double exponential(Rng& rng) {
    return -std::log1p(-rng.next_double());
}

void note(PathStatistics& statistics, const TracedVertex& vertex) {
    if (statistics.vertices) [[unlikely]]
        statistics.vertices->push_back(vertex);
}

// Surface paths that begin at the end of one ray of the camera that comes through smoke: what the ray itself costs is
// shared by them. Where there is none a ray costs little.
constexpr int kFirstReflections = 4;

}  // namespace

struct PathTracer::Vertex {
    PathVertex place;
    Rgb throughput;     // with the albedo of this scattering in smoke
    float light_lines;  // how many are drawn toward the fire: a probability
    int order;          // scatterings with this one
    bool row_surface;   // the first vertex of the path lies on a surface, ...
    Sender column;      // ... and the second there, or in smoke: the cell of what it brings
};

PathTracer::PathTracer(const Medium& medium, const TracingSettings& settings, int bounces,
                       const Surroundings* surroundings)
    : bounces_(bounces), direct_(medium, settings, surroundings) {
    if (surroundings && settings.emission == EmissionEstimator::Collision)
        throw Error(ExitCode::Usage,
                    "tracing.emission: \"collision\", the plain tracker, knows neither surfaces nor lights; "
                    "use \"line\", or a shot without a scene");
}

void PathTracer::trace(const Ray& ray, double place, Rng& rng, PathSum& sum, PathStatistics& statistics) const {
    if (direct_.fire().empty() && !direct_.surroundings())
        return;
    if (settings().emission == EmissionEstimator::Collision)
        trace_plain(ray, rng, sum, statistics);
    else
        trace_lines(ray, place, rng, sum, statistics);
}

// `vertex`: where the light arrives; none: at the camera.
void PathTracer::add(PathSum& sum, const Vertex* vertex, Sender source, const Rgb& radiance) const {
    const int order = vertex ? vertex->order : 0;
    sum[std::min(order, kPathOrders - 1)] += radiance;
    if (!direct_.surroundings())
        return;
    Cell cell = source == Sender::V ? Cell::V : Cell::A;
    if (order == 1)
        cell = cell_of(vertex->row_surface, source);
    else if (order > 1)
        cell = cell_of(vertex->row_surface, vertex->column);
    sum.cells.at(cell) += radiance;
}

void PathTracer::trace_lines(const Ray& camera_ray, double place, Rng& rng, PathSum& sum,
                             PathStatistics& statistics) const {
    thread_local CameraLine seen;
    const RaySegment segment = direct_.segment_along(camera_ray);
    direct_.lines().follow_camera(camera_ray, rng, seen, segment.end);
    add(sum, nullptr, Sender::V, seen.radiance);
    const auto through = static_cast<float>(seen.transmittance());
    Rgb at_end(0.0f);
    if (direct_.surroundings()) {
        at_end = through * direct_.at_end(segment, 0.0, true, nullptr);
        add(sum, nullptr, Sender::A, at_end);
    }
    note(statistics, {0, camera_ray.origin, Rgb(1.0f), seen.radiance + at_end, Rgb(0.0f)});
    if (bounces_ == 0)
        return;
    const double opacity = seen.opacity();
    const Rgb arriving(static_cast<float>(opacity / kFirstCollisions));
    for (int i = 0; i < kFirstCollisions && opacity > 0.0; ++i) {
        ++statistics.paths;
        const Collision first = direct_.lines().choose(seen, (i + place) / kFirstCollisions);
        trace_from(in_smoke(camera_ray, first, arriving, nullptr), rng, sum, statistics);
    }
    if (!segment.point || !(through > 0.0f))
        return;
    const int reflections = opacity > 0.0 ? static_cast<int>(std::ceil(through * kFirstReflections)) : 1;
    for (int i = 0; i < reflections; ++i) {
        ++statistics.paths;
        trace_from(on_surface(*segment.point, camera_ray.direction, Rgb(through / float(reflections)), nullptr), rng,
                   sum, statistics);
    }
}

void PathTracer::trace_from_surface(const SurfacePoint& point, const dvec3& arriving, Rng& rng, PathSum& sum) const {
    PathStatistics ignored;
    if (bounces_ != 0)
        trace_from(on_surface(point, arriving, Rgb(1.0f), nullptr), rng, sum, ignored);
}

void PathTracer::trace_from(Vertex vertex, Rng& rng, PathSum& sum, PathStatistics& statistics) const {
    const float begin = largest(vertex.throughput);
    const auto endless = [&] { return vertex.place.on_surface() && vertex.order > kManyScatterings; };
    while (survives(vertex.throughput, begin, endless(), rng)) {
        ++statistics.scatterings;
        const PathVertex& place = vertex.place;
        TracedVertex seen{vertex.order, place.position(), vertex.throughput, Rgb(0.0f),
                          Rgb(0.0f),    Rgb(0.0f),        place.on_surface()};
        if (vertex.light_lines > 0.0f && (vertex.light_lines == 1.0f || rng.next() < vertex.light_lines)) {
            seen.from_fire = vertex.throughput * direct_.from_fire(place, vertex.light_lines, rng);
            add(sum, &vertex, Sender::V, seen.from_fire);
        }
        if (direct_.has_emitters() && !place.only_delta()) {
            seen.from_emitters = vertex.throughput * direct_.from_emitters(place, rng);
            add(sum, &vertex, Sender::A, seen.from_emitters);
        }
        const std::optional<PathVertex::Sample> turn = place.sample(rng);
        if (!turn) {
            note(statistics, seen);
            return;
        }
        const RaySegment segment = direct_.segment_along(place.leaving(turn->wi));
        const Rgb leaving = vertex.throughput * turn->weight;
        const bool goes_on = bounces_ < 0 || vertex.order < bounces_;
        LineResult line;
        if (goes_on || direct_.surroundings())
            line = direct_.lines().follow_path(segment.ray, rng, segment.end);
        else
            line.radiance = direct_.lines().follow_line(segment.ray, rng);
        if (line.radiance != Rgb(0.0f)) {
            const float share =
                turn->delta ? 1.0f : direct_.share_of_sample(vertex.light_lines, segment.ray, turn->pdf);
            seen.along_segment = share * leaving * line.radiance;
            add(sum, &vertex, Sender::V, seen.along_segment);
        }
        if (direct_.surroundings() && !line.collision) {
            const Rgb at_end = leaving * direct_.at_end(segment, turn->pdf, turn->delta, &place);
            add(sum, &vertex, Sender::A, at_end);
            seen.along_segment += at_end;
        }
        note(statistics, seen);
        if (!goes_on || !(line.collision || segment.hit))
            return;
        vertex = line.collision ? in_smoke(segment.ray, *line.collision, leaving, &vertex)
                                : on_surface(*segment.point, segment.ray.direction, leaving, &vertex);
    }
}

PathTracer::Vertex PathTracer::in_smoke(const Ray& ray, const Collision& c, const Rgb& arriving,
                                        const Vertex* from) const {
    const int order = from ? from->order + 1 : 1;
    return {direct_.in_smoke(ray, c),         arriving * field().albedo(c.brick, c.position),
            direct_.lines_in_smoke(c),        order,
            from ? from->row_surface : false, order > 2 ? from->column : Sender::M};
}

PathTracer::Vertex PathTracer::on_surface(const SurfacePoint& point, const dvec3& direction, const Rgb& arriving,
                                          const Vertex* from) const {
    const int order = from ? from->order + 1 : 1;
    Vertex v{PathVertex(point, direction),        arriving, 0.0f, order, from ? from->row_surface : true,
             order > 2 ? from->column : Sender::S};
    v.light_lines = direct_.lines_on_surface(v.place);
    return v;
}

// The plain tracker: emission at every tentative collision, absorption or scattering at real ones. Where only emission
// is, tentative collisions must be made.
void PathTracer::trace_plain(Ray ray, Rng& rng, PathSum& sum, PathStatistics& statistics) const {
    ++statistics.paths;
    Rgb throughput(1.0f);
    for (int order = 0;; ++order) {
        std::optional<Collision> collision;
        note(statistics, {order, ray.origin, throughput, Rgb(0.0f), Rgb(0.0f)});
        walk_bricks(field().bricks(), field().enter(ray), [&](const VoxelSegment& s) {
            const bool burns = field().burns(s.brick);
            const double per_voxel = glm::length(s.direction) / 4.0;
            const double majorant =
                std::max<double>(field().majorant(s.brick), burns && field().has_emission() ? per_voxel : 0.0);
            if (majorant <= 0.0)
                return true;
            for (double t = s.begin + exponential(rng) / majorant; t < s.end; t += exponential(rng) / majorant) {
                const vec3 p = point_in_brick(s, t);
                const float sigma = field().extinction(s.brick, p);
                Rgb glow(0.0f);
                if (burns && field().has_source())
                    glow += sigma * field().source(s.brick, p);
                if (burns && field().has_emission())
                    glow += field().emission(s.brick, p);
                const Rgb gathered = throughput * glow / float(majorant);
                sum[std::min(order, kPathOrders - 1)] += gathered;
                if (statistics.vertices) [[unlikely]]
                    statistics.vertices->back().along_segment += gathered;
                if (rng.next_double() * majorant < sigma) {
                    collision = Collision{t, s.brick, p};
                    return false;
                }
            }
            return true;
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
