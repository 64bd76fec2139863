#include "tracing/path_tracer.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "medium/phase.h"

namespace brisance {

namespace {

// First scatterings drawn on one ray of the camera: the ray itself, integrated cell by cell, costs as much as several.
constexpr int kFirstCollisions = 16;

// Lines toward the fire at a vertex, where the smoke around it lets them get there: its optical depth across the fire's
// radius is less than this. Deeper in the smoke they cost more than they bring (measured), and what they would find is
// found along the path's own segments.
constexpr float kLightLines = 0.25f;
constexpr float kThickToFire = 1.0f;

// Paths that carry less than this part of what they began with are ended by roulette.
constexpr float kRouletteBelow = 0.5f;

double exponential(Rng& rng) {
    return -std::log1p(-rng.next_double());
}

float largest(const Rgb& c) {
    return std::max({c.x, c.y, c.z});
}

void add(PathSum& sum, int order, const Rgb& radiance) {
    sum[std::min(order, kPathOrders - 1)] += radiance;
}

void note(PathStatistics& statistics, const TracedVertex& vertex) {
    if (statistics.vertices) [[unlikely]]
        statistics.vertices->push_back(vertex);
}

// Ends the path, or makes up for those that ended. False: ended.
bool survives(Rgb& throughput, float begin, Rng& rng) {
    const float part = largest(throughput) / begin;
    if (part >= kRouletteBelow)
        return true;
    if (!(rng.next() < part))
        return false;
    throughput /= part;
    return true;
}

}  // namespace

dvec3 sample_henyey_greenstein(const dvec3& forward, float mean_cosine, Rng& rng) {
    const double g = mean_cosine, u = rng.next_double();
    double cosine = 1.0 - 2.0 * u;
    if (std::abs(g) > 1e-4) {
        // 1 - cos from terms of one sign, so that the peak at |g| -> 1 keeps its shape.
        const double a = std::abs(g), ratio = (1.0 - a) * (1.0 + a) / (1.0 - a + 2.0 * a * u);
        cosine = std::clamp((1.0 + a * a - ratio * ratio) / (2.0 * a), -1.0, 1.0);
        cosine = g > 0.0 ? cosine : -cosine;
    }
    const double sine = std::sqrt(std::max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    const double angle = 2.0 * 3.14159265358979323846 * rng.next_double();
    // Two axes across `forward` (Duff et al., Building an Orthonormal Basis, Revisited, JCGT 2017).
    const double sign = std::copysign(1.0, forward.z), a = -1.0 / (sign + forward.z), b = forward.x * forward.y * a;
    const dvec3 x(1.0 + sign * forward.x * forward.x * a, sign * b, -sign * forward.x);
    const dvec3 y(b, sign + forward.y * forward.y * a, -forward.y);
    return glm::normalize(cosine * forward + sine * (std::cos(angle) * x + std::sin(angle) * y));
}

struct PathTracer::Vertex {
    dvec3 position;     // local [m]
    dvec3 arriving;     // the path's direction of travel
    Rgb throughput;     // with the albedo of this scattering
    float light_lines;  // how many are drawn toward the fire: a probability
    int order;          // scatterings with this one
};

PathTracer::PathTracer(const Medium& medium, const TracingSettings& settings, int bounces)
    : settings_(settings), bounces_(bounces), field_(medium), fire_(field_), lines_(field_, settings_) {}

void PathTracer::trace(const Ray& ray, double place, Rng& rng, PathSum& sum, PathStatistics& statistics) const {
    if (fire_.empty())
        return;
    if (settings_.emission == EmissionEstimator::Collision)
        trace_plain(ray, rng, sum, statistics);
    else
        trace_lines(ray, place, rng, sum, statistics);
}

// The line toward the fire; with the balance heuristic its weight cancels all but both densities in the denominator.
Rgb PathTracer::light_from_fire(const Vertex& vertex, Rng& rng) const {
    const Ray line{vertex.position, fire_.sample(vertex.position, rng)};
    const Rgb seen = lines_.follow_line(line, rng);
    if (seen == Rgb(0.0f))
        return seen;
    const double phase =
        henyey_greenstein(static_cast<float>(glm::dot(vertex.arriving, line.direction)), field_.mean_cosine());
    return float(phase / (vertex.light_lines * fire_.pdf(line) + phase)) * seen;
}

void PathTracer::trace_lines(const Ray& camera_ray, double place, Rng& rng, PathSum& sum,
                             PathStatistics& statistics) const {
    thread_local CameraLine seen;
    lines_.follow_camera(camera_ray, rng, seen);
    add(sum, 0, seen.radiance);
    note(statistics, {0, camera_ray.origin, Rgb(1.0f), seen.radiance, Rgb(0.0f)});
    if (bounces_ == 0 || !(seen.opacity() > 0.0))
        return;
    const Rgb arriving(static_cast<float>(seen.opacity() / kFirstCollisions));
    for (int i = 0; i < kFirstCollisions; ++i) {
        ++statistics.paths;
        const Collision first = lines_.choose(seen, (i + place) / kFirstCollisions);
        trace_from(vertex_at(camera_ray, first, arriving, 1), rng, sum, statistics);
    }
}

void PathTracer::trace_from(Vertex vertex, Rng& rng, PathSum& sum, PathStatistics& statistics) const {
    const float begin = largest(vertex.throughput);
    while (survives(vertex.throughput, begin, rng)) {
        ++statistics.scatterings;
        Rgb from_fire(0.0f), along_segment(0.0f);
        if (vertex.light_lines > 0.0f && rng.next() < vertex.light_lines) {
            from_fire = vertex.throughput * light_from_fire(vertex, rng);
            add(sum, vertex.order, from_fire);
        }
        const Ray ray{vertex.position, sample_henyey_greenstein(vertex.arriving, field_.mean_cosine(), rng)};
        LineResult line;
        if (bounces_ < 0 || vertex.order < bounces_)
            line = lines_.follow_path(ray, rng);
        else
            line.radiance = lines_.follow_line(ray, rng);
        if (line.radiance != Rgb(0.0f)) {
            along_segment = share_of_phase(vertex, ray) * vertex.throughput * line.radiance;
            add(sum, vertex.order, along_segment);
        }
        note(statistics, {vertex.order, vertex.position, vertex.throughput, along_segment, from_fire});
        if (!line.collision)
            return;
        vertex = vertex_at(ray, *line.collision, vertex.throughput, vertex.order + 1);
    }
}

PathTracer::Vertex PathTracer::vertex_at(const Ray& ray, const Collision& c, const Rgb& arriving, int order) const {
    Vertex v{ray.origin + ray.direction * c.distance, ray.direction, arriving * field_.albedo(c.brick, c.position),
             0.0f, order};
    if (settings_.light_sampling && field_.extinction(c.brick, c.position) * fire_.radius() < kThickToFire)
        v.light_lines = kLightLines;
    return v;
}

float PathTracer::share_of_phase(const Vertex& vertex, const Ray& ray) const {
    if (vertex.light_lines == 0.0f)
        return 1.0f;
    const double phase =
        henyey_greenstein(static_cast<float>(glm::dot(vertex.arriving, ray.direction)), field_.mean_cosine());
    return static_cast<float>(phase / (vertex.light_lines * fire_.pdf(ray) + phase));
}

// The plain tracker: emission at every tentative collision, absorption or scattering at real ones. Where only emission
// is, tentative collisions must be made.
void PathTracer::trace_plain(Ray ray, Rng& rng, PathSum& sum, PathStatistics& statistics) const {
    ++statistics.paths;
    Rgb throughput(1.0f);
    for (int order = 0;; ++order) {
        std::optional<Collision> collision;
        note(statistics, {order, ray.origin, throughput, Rgb(0.0f), Rgb(0.0f)});
        walk_bricks(field_.bricks(), field_.enter(ray), [&](const CellSegment& s) {
            const bool burns = field_.burns(s.brick);
            const double per_cell = glm::length(s.direction) / 4.0;
            const double majorant =
                std::max<double>(field_.majorant(s.brick), burns && field_.has_emission() ? per_cell : 0.0);
            if (majorant <= 0.0)
                return true;
            for (double t = s.begin + exponential(rng) / majorant; t < s.end; t += exponential(rng) / majorant) {
                const vec3 p = point_in_brick(s, t);
                const float sigma = field_.extinction(s.brick, p);
                Rgb glow(0.0f);
                if (burns && field_.has_source())
                    glow += sigma * field_.source(s.brick, p);
                if (burns && field_.has_emission())
                    glow += field_.emission(s.brick, p);
                const Rgb gathered = throughput * glow / float(majorant);
                add(sum, order, gathered);
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
        const Rgb albedo = field_.albedo(collision->brick, collision->position);
        const float scatter = largest(throughput * albedo) / std::max(largest(throughput), 1e-30f);
        if (!(rng.next_double() < scatter))
            return;
        throughput *= albedo / scatter;
        ++statistics.scatterings;
        ray = {ray.origin + ray.direction * collision->distance,
               sample_henyey_greenstein(ray.direction, field_.mean_cosine(), rng)};
    }
}

}  // namespace brisance
