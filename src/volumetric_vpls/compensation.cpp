#include "volumetric_vpls/compensation.h"

#include <algorithm>
#include <cmath>

#include "transport/roulette.h"

namespace brisance {

namespace {

// Of the bounded lights, at a vertex of a path.
constexpr int kLightsAtVertex = 1;

}  // namespace

// A scattering of a path from the camera that gathers all light there is.
struct Compensation::Vertex {
    PathVertex place;
    Rgb throughput;     // with the albedo of this scattering in smoke
    float light_lines;  // how many are drawn toward the fire: a probability
    int order;          // scatterings with this one
};

struct Compensation::Step {
    Rgb gathered{0.0f};  // at the vertex and along the segment [W/(m^2 sr)], of a throughput of 1
    std::optional<PathVertex::Sample> turn;
    RaySegment segment;
    std::optional<Collision> collision;
};

Compensation::Compensation(const DirectLight& scene, const VplSum& lights, const VolumetricVplSettings& settings,
                           int bounces)
    : scene_(scene),
      lights_(lights),
      how_(settings.compensation),
      samples_(settings.compensation_samples),
      bounces_(bounces) {}

bool Compensation::wanted() const {
    return how_ != BiasCompensation::None && lights_.bound().limits() && (bounces_ < 0 || bounces_ >= 2);
}

Rgb Compensation::along_ray(const RayMedium& seen, Rng& rng) const {
    Rgb sum(0.0f);
    if (!wanted() || seen.empty())
        return sum;
    const Segment& camera = seen.segment();
    for (int i = 0; i < samples_; ++i) {
        const double u = seen.sample_flight((i + rng.next_double()) / samples_);
        const std::optional<Collision> smoke = seen.place(u);
        if (!smoke)
            continue;
        const PathVertex place(camera.at(u), camera.direction, scene_.field().mean_cosine());
        sum += scene_.field().albedo(smoke->brick, smoke->position) *
               (how_ == BiasCompensation::Exact ? lost_exactly(place, rng) : lost_locally(place, *smoke, rng));
    }
    return sum * float(seen.opacity() / samples_);
}

Rgb Compensation::at_surface(const PathVertex& place, Rng& rng) const {
    Rgb sum(0.0f);
    if (!wanted())
        return sum;
    const std::optional<Collision> smoke = RayProbe(scene_.field(), {place.position(), place.arriving()}).place(0.0);
    for (int i = 0; i < samples_; ++i) {
        if (how_ == BiasCompensation::Exact)
            sum += lost_exactly(place, rng);
        else if (smoke)
            sum += lost_locally(place, *smoke, rng);
    }
    return sum / float(samples_);
}

// The first flight is made to collide within the bound's radius: few would by chance where smoke is thin.
Rgb Compensation::lost_exactly(const PathVertex& place, Rng& rng) const {
    thread_local RayMedium near;
    const std::optional<PathVertex::Sample> turn = place.sample(rng);
    if (!turn || turn->delta)
        return Rgb(0.0f);
    const Ray ray = place.leaving(turn->wi);
    near.look(scene_.field(), ray, std::min(scene_.segment_along(ray).end, lights_.bound().radius()));
    if (near.empty())
        return Rgb(0.0f);
    const std::optional<Collision> c = near.place(near.sample_flight(rng.next_double()));
    if (!c)
        return Rgb(0.0f);
    const double part = near.opacity() * lights_.bound().part_left_out(c->distance);
    return follow({scene_.in_smoke(ray, *c), turn->weight * scene_.field().albedo(c->brick, c->position) * float(part),
                   scene_.lines_in_smoke(*c), 2},
                  rng);
}

Rgb Compensation::lost_locally(const PathVertex& place, const Collision& smoke, Rng& rng) const {
    const TrackingField& field = scene_.field();
    const double extinction = field.extinction(smoke.brick, smoke.position), radius = lights_.bound().radius();
    const Rgb albedo = field.albedo(smoke.brick, smoke.position);
    const std::optional<PathVertex::Sample> turn = place.sample(rng);
    if (!turn || turn->delta || !(extinction > 0.0))
        return Rgb(0.0f);
    const double chance = -std::expm1(-extinction * radius);
    const double w = -std::log1p(-rng.next_double() * chance) / extinction;
    const Ray ray = place.leaving(turn->wi);
    const PathVertex source(ray.origin + w * ray.direction, ray.direction, field.mean_cosine());
    const Rgb found = gather({source, Rgb(1.0f), scene_.lines_in_smoke(smoke), 2}, rng).gathered;
    const Rgb in_turn = albedo * float(bounces_ == 2 ? 0.0 : lights_.bound().share_left_out(extinction));
    return turn->weight * albedo * float(chance * lights_.bound().part_left_out(w)) * found / (Rgb(1.0f) - in_turn);
}

Compensation::Step Compensation::gather(const Vertex& vertex, Rng& rng) const {
    const PathVertex& place = vertex.place;
    Step step;
    step.gathered = lights_.at(place, vertex.order, kLightsAtVertex, rng);
    if (vertex.light_lines > 0.0f && (vertex.light_lines == 1.0f || rng.next() < vertex.light_lines))
        step.gathered += scene_.from_fire(place, vertex.light_lines, rng);
    if (scene_.has_emitters() && !place.only_delta())
        step.gathered += scene_.from_emitters(place, rng);
    step.turn = place.sample(rng);
    if (!step.turn)
        return step;
    step.segment = scene_.segment_along(place.leaving(step.turn->wi));
    const LineResult line = scene_.lines().follow_path(step.segment.ray, rng, step.segment.end);
    step.collision = line.collision;
    if (line.radiance != Rgb(0.0f))
        step.gathered +=
            step.turn->weight * line.radiance *
            (step.turn->delta ? 1.0f : scene_.share_of_sample(vertex.light_lines, step.segment.ray, step.turn->pdf));
    if (scene_.surroundings() && !line.collision)
        step.gathered += step.turn->weight * scene_.at_end(step.segment, step.turn->pdf, step.turn->delta, &place);
    return step;
}

// To the next vertex; false: what comes from there is in the lights, or nothing does.
bool Compensation::go_on(Vertex& vertex, const Step& step) const {
    if (!step.turn || (bounces_ >= 0 && vertex.order >= bounces_))
        return false;
    const Rgb leaving = vertex.throughput * step.turn->weight;
    if (const std::optional<Collision>& c = step.collision) {
        const double part = step.turn->delta ? 1.0 : lights_.bound().part_left_out(c->distance);
        vertex = {scene_.in_smoke(step.segment.ray, *c),
                  leaving * scene_.field().albedo(c->brick, c->position) * float(part), scene_.lines_in_smoke(*c),
                  vertex.order + 1};
        return part > 0.0;
    }
    if (!step.segment.point)
        return false;
    PathVertex surface(*step.segment.point, step.segment.ray.direction);
    const float lines = scene_.lines_on_surface(surface);
    vertex = {std::move(surface), leaving, lines, vertex.order + 1};
    return true;
}

Rgb Compensation::follow(Vertex vertex, Rng& rng) const {
    Rgb sum(0.0f);
    const float begin = largest(vertex.throughput);
    if (!(begin > 0.0f))
        return sum;
    const auto endless = [&] { return vertex.place.on_surface() && vertex.order > kManyScatterings; };
    while (survives(vertex.throughput, begin, endless(), rng)) {
        const Step step = gather(vertex, rng);
        sum += vertex.throughput * step.gathered;
        if (!go_on(vertex, step))
            break;
    }
    return sum;
}

}  // namespace brisance
