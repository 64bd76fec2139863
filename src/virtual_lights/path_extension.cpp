// Path extension: what virtual lights hold of the surface at the end of a ray, and the path beyond it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "transport/emitters_along_ray.h"
#include "transport/path_step.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

namespace {

bool goes_straight_on(const PathVertex& vertex, const PathVertex::Sample& sample) {
    return sample.delta && glm::dot(sample.wi, vertex.arriving()) > 1.0 - 1e-12;
}

// Points on every segment through smoke at which the light of lamps is estimated.
constexpr int kLampPoints = 2;

// The factor that replaces one base colour by another.
Rgb recoloured(const Rgb& to, const Rgb& from) {
    return {from.x > 0.0f ? to.x / from.x : 0.0f, from.y > 0.0f ? to.y / from.y : 0.0f,
            from.z > 0.0f ? to.z / from.z : 0.0f};
}

}  // namespace

LightShares VirtualLights::shares_at(const SurfaceHit& hit, const SurfacePoint& point) const {
    if (settings_.flux != LightFlux::Gathered || !holds_light(point.material))
        return {};
    const int material = scene_.surroundings()->scene().meshes[hit.mesh].material;
    return cover_.shares(point.position, lit_normal(point), material);
}

bool VirtualLights::hold_base(const SurfaceHit& hit, const SurfacePoint& point) const {
    return settings_.flux == LightFlux::Own ? holds_light(point.material) && !lights_.empty()
                                            : speaking_for(hit, point) > 0;
}

VirtualLights::Seen VirtualLights::seen_by(const RaySegment& segment) const {
    return {segment, shares_at(*segment.hit, *segment.point)};
}

// What one of the lights adds to the radiance seen.
Rgb VirtualLights::reflected(const Seen& seen, int share) const {
    const VirtualLight& light = lights_[seen.shares.light[share]];
    const SurfaceMaterial& there = seen.segment.point->material;
    if (light.profile < 0)
        return light.irradiance * there.base_colour * (seen.shares.weight[share] / std::numbers::pi_v<float>);
    const Rgb radiance = seen.shares.weight[share] * profiles_.radiance(light, -seen.segment.ray.direction);
    const bool metal = there.metallic == 1.0f && light.material.metallic == 1.0f;
    return metal ? radiance * recoloured(there.base_colour, light.material.base_colour) : radiance;
}

// The probability that a path ends in the lights at the end of its ray: by how many of them lie in the ray's footprint.
double VirtualLights::termination_probability(const Seen& seen, double pdf) const {
    if (settings_.flux == LightFlux::Own)  // photons have left lights on every surface that can hold them
        return holds_light(seen.segment.point->material) ? 1.0 : 0.0;
    if (seen.shares.count == 0)
        return 0.0;
    if (!settings_.extension)
        return 1.0;  // sampling spheres and points has found all that such surfaces reflect
    double area = 0.0;
    for (int i = 0; i < seen.shares.count; ++i)
        area += seen.shares.weight[i] * lights_[seen.shares.light[i]].area;
    const RaySegment& segment = seen.segment;
    const double cosine = std::abs(glm::dot(segment.point->geometric_normal, segment.ray.direction));
    const double n = segment.end * segment.end / (pdf * cosine * area);
    if (!(n < settings_.n_max))  // pdf * cosine of 0 as well
        return 1.0;
    return std::clamp((n - settings_.n_min) / (settings_.n_max - settings_.n_min), 0.0, 1.0);
}

// The radiance of all lights that share the end of a ray that `vertex` sampled, weighted against sampling the lights.
Rgb VirtualLights::at_end_of_ray(const PathVertex& vertex, const Seen& seen, double pdf) const {
    Rgb sum(0.0f);
    if (!draws_rays(settings_.sampling))
        return sum;
    for (int i = 0; i < seen.shares.count; ++i) {
        const std::size_t light = seen.shares.light[i];
        const double other = choice_.by_lights()
                                 ? choice_.probability(vertex.lit(), light) *
                                       pdf_toward(lights_[light], vertex.lit(), seen.segment.ray.direction)
                                 : 0.0;
        sum += reflected(seen, i) * float(pdf / (pdf + other));
    }
    return sum;
}

Rgb VirtualLights::lamps_on(const RaySegment& segment, Rng& rng) const {
    thread_local RayMedium seen;
    seen.look(scene_.field(), segment.ray, segment.end);
    return emitters_along_ray(scene_, seen, segment.ray, kLampPoints, rng);
}

// A path from a receiver over surfaces, until virtual lights hold what they reflect. The receiver itself gathers only
// what surfaces reflect toward it; later vertices gather all light.
class VirtualLights::ExtendedPath : public PlainPath {
public:
    ExtendedPath(const VirtualLights& lights, Panes panes)
        : PlainPath(lights.scene_),
          lights_(lights),
          panes_(panes),
          lamps_along_(scene_.has_emitters() && aims_at_lamps(scene_) && !scene_.field().bricks().empty()) {}

    Rgb own_lights(const PathState& state, Rng& rng) const {
        if (!lights_.asks_lights() || state.vertex.only_delta())
            return Rgb(0.0f);
        return lights_.from_lights(state.vertex, rng);
    }

    // Where lamps are estimated along segments, vertices in the medium would count their light twice. Estimates there
    // have less noise: hardly any collision lies in the beam of a lamp nearby.
    bool gathers_emitters(const PathState& state) const {
        return state.order > 1 && !(lamps_along_ && !state.vertex.on_surface());
    }

    SegmentMedium medium_along(const PathState& state, const PathStep& step, Rng& rng) {
        receiver_lit_ = state.order == 1 ||
                        (receiver_lit_ && panes_ == Panes::Asked && goes_straight_on(state.vertex, *step.sample));
        if (receiver_lit_)
            return transmitted_along(state, step.segment, rng);
        const Rgb lamps = lamps_along_ ? lights_.lamps_on(step.segment, rng) : Rgb(0.0f);
        SegmentMedium medium = PlainPath::medium_along(state, step, rng);
        medium.scattered = lamps;
        return medium;
    }

    void gather(const PathState& state, const PathStep& step) {
        ++vertices_;
        sum_ += state.throughput * step.from_own_lights;
        sum_ += state.throughput * step.from_fire;
        sum_ += state.throughput * step.from_emitters;
        sum_ += step.leaving * step.medium.scattered;
        sum_ += step.leaving * step.medium.emission * step.emission_weight;
        sum_ += step.leaving * step.at_end;
    }

    // On a surface the virtual lights take over what they hold; the path continues with the rest.
    bool arrive(const PathState& state, const PathStep& step, PathState& next) {
        if (step.medium.collision || step.sample->delta)
            return true;
        const Seen seen = lights_.seen_by(step.segment);
        const auto ended = static_cast<float>(lights_.termination_probability(seen, step.sample->pdf));
        if (ended > 0.0f)
            sum_ += next.throughput * ended * lights_.at_end_of_ray(state.vertex, seen, step.sample->pdf);
        next.throughput *= 1.0f - ended;
        return true;
    }

    // Here in the medium as well: the path serves one receiver among many, and need not be long.
    bool is_long(const PathState& state) const { return state.order - 1 > kManyScatterings; }

    const Rgb& sum() const { return sum_; }
    int vertices() const { return vertices_; }

private:
    // The receiver has been lit by the medium along this segment already.
    SegmentMedium transmitted_along(const PathState& state, const RaySegment& segment, Rng& rng) const {
        SegmentMedium medium;
        if (segment.hit || state.order > 1)
            medium.transmittance = float(scene_.lines().transmittance(segment.ray, segment.end, rng));
        return medium;
    }

    const VirtualLights& lights_;
    Panes panes_;
    bool lamps_along_;          // estimate lamps along segments, not at vertices in the medium
    bool receiver_lit_ = true;  // by the medium along the current segment
    Rgb sum_{0.0f};
    int vertices_ = 0;
};

Rgb VirtualLights::shade(const PathVertex& vertex, Rng& rng, int* vertices, Panes panes) const {
    if (!shines_)
        return Rgb(0.0f);
    ExtendedPath path(*this, panes);
    walk_path(scene_, {vertex, Rgb(1.0f), 0.0f, 1}, path, rng);
    if (vertices)
        *vertices += path.vertices();
    return path.sum();
}

}  // namespace brisance
