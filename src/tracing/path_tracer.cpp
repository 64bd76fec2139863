#include "tracing/path_tracer.h"

#include <algorithm>
#include <cmath>

#include "medium/phase.h"

namespace brisance {

namespace {

// Paths that carry less than this are ended by roulette.
constexpr float kRouletteBelow = 0.25f;

double exponential(Rng& rng) {
    return -std::log1p(-rng.next_double());
}

float largest(const Rgb& c) {
    return std::max({c.x, c.y, c.z});
}

void add(PathSum& sum, int order, const Rgb& radiance) {
    sum[std::min(order, kPathOrders - 1)] += radiance;
}

// Ends the path, or makes up for those that ended. False: ended.
bool survives(Rgb& throughput, Rng& rng) {
    const float most = largest(throughput);
    if (most >= kRouletteBelow)
        return true;
    if (!(rng.next_double() * kRouletteBelow < most))
        return false;
    throughput *= kRouletteBelow / most;
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
    dvec3 position;
    dvec3 arriving;  // the path's direction of travel
};

PathTracer::PathTracer(const Medium& medium, const TracingSettings& settings, int bounces)
    : settings_(settings), bounces_(bounces), field_(medium), fire_(field_), lines_(field_, settings_) {}

void PathTracer::trace(const Ray& ray, double place, Rng& rng, PathSum& sum, PathStatistics& statistics) const {
    ++statistics.paths;
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
    const Rgb seen = lines_.follow(line, false, rng).radiance;
    if (seen == Rgb(0.0f))
        return seen;
    const double phase =
        henyey_greenstein(static_cast<float>(glm::dot(vertex.arriving, line.direction)), field_.mean_cosine());
    return float(phase / (fire_.pdf(line) + phase)) * seen;
}

void PathTracer::trace_lines(const Ray& camera_ray, double place, Rng& rng, PathSum& sum,
                             PathStatistics& statistics) const {
    Ray ray = camera_ray;
    LineResult line = lines_.follow_camera(ray, place, rng);
    add(sum, 0, line.radiance);
    Rgb throughput(static_cast<float>(line.weight));
    for (int order = 1; line.collision && (bounces_ < 0 || order <= bounces_); ++order) {
        throughput *= field_.albedo(line.collision->brick, line.collision->position);
        if (!survives(throughput, rng))
            return;
        ++statistics.scatterings;
        const Vertex vertex{local_of(ray, *line.collision), ray.direction};
        if (settings_.light_sampling)
            add(sum, order, throughput * light_from_fire(vertex, rng));
        ray = {vertex.position, sample_henyey_greenstein(vertex.arriving, field_.mean_cosine(), rng)};
        line = lines_.follow(ray, bounces_ < 0 || order < bounces_, rng);
        if (line.radiance == Rgb(0.0f))
            continue;
        float share = 1.0f;
        if (settings_.light_sampling) {
            const double phase =
                henyey_greenstein(static_cast<float>(glm::dot(vertex.arriving, ray.direction)), field_.mean_cosine());
            share = static_cast<float>(phase / (fire_.pdf(ray) + phase));
        }
        add(sum, order, share * throughput * line.radiance);
    }
}

// The plain tracker: emission at every tentative collision, absorption or scattering at real ones. Where only emission
// is, tentative collisions must be made.
void PathTracer::trace_plain(Ray ray, Rng& rng, PathSum& sum, PathStatistics& statistics) const {
    Rgb throughput(1.0f);
    for (int order = 0;; ++order) {
        std::optional<Collision> collision;
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
                add(sum, order, throughput * glow / float(majorant));
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
        ray = {local_of(ray, *collision), sample_henyey_greenstein(ray.direction, field_.mean_cosine(), rng)};
    }
}

}  // namespace brisance
