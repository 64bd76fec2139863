#include "volumetric_vpls/compensation.h"

#include <algorithm>
#include <cmath>

#include "transport/path_step.h"

namespace brisance {

namespace {

// Bounded lights sampled at a vertex of a path.
constexpr int kLightsAtVertex = 1;

}  // namespace

// The path after a collision v. It gathers S: direct light, one of the bounded lights, and what their bound removes at
// later collisions.
class Compensation::LostPath : public PlainPath {
public:
    explicit LostPath(const Compensation& of) : PlainPath(of.scene_), lights_(of.lights_), bounces_(of.bounces_) {}

    Rgb own_lights(const PathState& state, Rng& rng) const {
        return lights_.at(state.vertex, state.order, kLightsAtVertex, rng);
    }

    bool continues(const PathState& state) const { return bounces_ < 0 || state.order < bounces_; }

    void gather(const PathState& state, const PathStep& step) {
        Rgb gathered = step.from_own_lights;
        gathered += step.from_fire;
        gathered += step.from_emitters;
        if (step.sample) {
            gathered += step.sample->weight * step.medium.emission * step.emission_weight;
            gathered += step.sample->weight * step.at_end;
        }
        sum_ += state.throughput * gathered;
    }

    // Collisions are weighted by the fraction that the bound removes. The lights do not reach delta lobes.
    bool arrive(const PathState&, const PathStep& step, PathState& next) const {
        if (!step.medium.collision || step.sample->delta)
            return true;
        const double part = lights_.bound().part_left_out(step.medium.collision->distance);
        next.throughput *= float(part);
        return part > 0.0;
    }

    const Rgb& sum() const { return sum_; }

private:
    const VplSum& lights_;
    int bounces_;
    Rgb sum_{0.0f};
};

Compensation::Compensation(const DirectLight& scene, const VplSum& lights, const VolumetricVplSettings& settings,
                           int bounces)
    : scene_(scene),
      lights_(lights),
      how_(settings.compensation),
      samples_(settings.compensation_samples),
      bounces_(bounces) {}

bool Compensation::enabled() const {
    return how_ != BiasCompensation::None && lights_.bound().limits() && (bounces_ < 0 || bounces_ >= 2);
}

Rgb Compensation::along_ray(const RayMedium& seen, Rng& rng) const {
    Rgb sum(0.0f);
    if (!enabled() || seen.empty())
        return sum;
    const Segment& camera = seen.segment();
    for (int i = 0; i < samples_; ++i) {
        const double u = seen.sample_flight((i + rng.next_double()) / samples_);
        const std::optional<Collision> smoke = seen.collision_at(u);
        if (!smoke)
            continue;
        const PathVertex vertex(camera.at(u), camera.direction, scene_.field().mean_cosine());
        sum += scene_.field().albedo(smoke->brick, smoke->position) *
               (how_ == BiasCompensation::Exact ? lost_exactly(vertex, rng) : lost_locally(vertex, *smoke, rng));
    }
    return sum * float(seen.opacity() / samples_);
}

Rgb Compensation::at_surface(const PathVertex& vertex, Rng& rng) const {
    Rgb sum(0.0f);
    if (!enabled())
        return sum;
    const std::optional<Collision> smoke =
        RayProbe(scene_.field(), {vertex.position(), vertex.arriving()}).collision_at(0.0);
    for (int i = 0; i < samples_; ++i) {
        if (how_ == BiasCompensation::Exact)
            sum += lost_exactly(vertex, rng);
        else if (smoke)
            sum += lost_locally(vertex, *smoke, rng);
    }
    return sum / float(samples_);
}

// The first flight is forced to collide within the bound's radius: in thin smoke few would by chance.
Rgb Compensation::lost_exactly(const PathVertex& vertex, Rng& rng) const {
    thread_local RayMedium near;
    const std::optional<PathVertex::Sample> sample = vertex.sample(rng);
    if (!sample || sample->delta)
        return Rgb(0.0f);
    const Ray ray = vertex.leaving(sample->wi);
    near.look(scene_.field(), ray, std::min(scene_.segment_along(ray).end, lights_.bound().radius()));
    if (near.empty())
        return Rgb(0.0f);
    const std::optional<Collision> c = near.collision_at(near.sample_flight(rng.next_double()));
    if (!c)
        return Rgb(0.0f);
    const double part = near.opacity() * lights_.bound().part_left_out(c->distance);
    PathState first = state_in_medium(scene_, ray, *c, sample->weight, 2);
    first.throughput *= float(part);
    return follow(first, rng);
}

Rgb Compensation::lost_locally(const PathVertex& vertex, const Collision& smoke, Rng& rng) const {
    const TrackingField& field = scene_.field();
    const double extinction = field.extinction(smoke.brick, smoke.position), radius = lights_.bound().radius();
    const Rgb albedo = field.albedo(smoke.brick, smoke.position);
    const std::optional<PathVertex::Sample> sample = vertex.sample(rng);
    if (!sample || sample->delta || !(extinction > 0.0))
        return Rgb(0.0f);
    const double chance = -std::expm1(-extinction * radius);
    const double w = -std::log1p(-rng.next_double() * chance) / extinction;
    const Ray ray = vertex.leaving(sample->wi);
    const PathVertex source(ray.origin + w * ray.direction, ray.direction, field.mean_cosine());
    LostPath at_source(*this);
    step_from(scene_, {source, Rgb(1.0f), scene_.fire_lines_in_medium(smoke), 2}, at_source, rng);
    const Rgb in_turn = albedo * float(bounces_ == 2 ? 0.0 : lights_.bound().share_left_out(extinction));
    return sample->weight * albedo * float(chance * lights_.bound().part_left_out(w)) * at_source.sum() /
           (Rgb(1.0f) - in_turn);
}

Rgb Compensation::follow(PathState first, Rng& rng) const {
    LostPath path(*this);
    if (largest(first.throughput) > 0.0f)
        walk_path(scene_, first, path, rng);
    return path.sum();
}

}  // namespace brisance
