// Path extension: the light that virtual lights hold where a ray ends, and how the path continues from there.
//
// A surface that the path reaches sees smoke that is lit already (lit_smoke.h): a walk through dense smoke beside a
// fire meets its bright core rarely, and is what most noise of light between surfaces came from. Lines toward the fire
// see all of that light, too: by the path's own segments alone, what smoke scatters made most of the rest.
//
// A receiver that shares its light with others around cannot tell mirror images at later surfaces apart: they move by
// the angle under which these others lie apart. Lobes that are narrower are widened to it. Else fire that is met by
// chance behind a window or a puddle is a bright grain, which no line toward the fire finds (A. Kaplanyan, C.
// Dachsbacher, Path Space Regularization for Holistic and Robust Light Transport, EG 2013). What is shared shrinks with
// the samples of a pixel, and so does this.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/cpu_clock.h"
#include "transport/emitters_along_ray.h"
#include "transport/path_step.h"
#include "virtual_lights/kinds/bounded_geometry.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

namespace {

bool goes_straight_on(const PathVertex& vertex, const PathVertex::Sample& sample) {
    return sample.delta && glm::dot(sample.wi, vertex.arriving()) > 1.0 - 1e-12;
}

// Where a mirror's image moves by `angle` [rad], facets lean by up to half of it. Light that passes through stays as it
// is: panes must not blur what is behind them.
std::optional<SurfacePoint> widened(const SurfacePoint& point, double angle) {
    const SurfaceMaterial& m = point.material;
    const double roughness = std::sqrt(0.5 * angle);
    if (m.roughness >= roughness || !needs_energy_tables(m) || m.transmission > 0.0f)
        return std::nullopt;
    SurfacePoint out = point;
    out.material.roughness = static_cast<float>(roughness);
    return out;
}

// Points on every segment through smoke at which lamps are sampled.
constexpr int kLampPoints = 2;

}  // namespace

Rgb VirtualLights::lamps_on(const RaySegment& segment, Rng& rng) const {
    thread_local RayMedium seen;
    seen.look(scene_.field(), segment.ray, segment.end);
    return emitters_along_ray(scene_, seen, segment.ray, kLampPoints, rng);
}

double VirtualLights::share_kept(const PathVertex& vertex, const RaySegment& segment) const {
    const VirtualLightSettings& s = set_->settings();
    if (s.compensation != BoundCompensation::Exact)
        return 1.0;
    const dvec3 offset = segment.point->position - vertex.position();
    const double cosine = std::abs(glm::dot(segment.point->geometric_normal, segment.ray.direction));
    return kept_by_bound(s, vertex.lit(), segment.ray.direction, cosine, glm::dot(offset, offset));
}

// What a path finds out about the bound of point lights, for a BoundTally; nothing, and at no cost, without one.
class BoundWatch {
public:
    explicit BoundWatch(BoundTally* tally) : tally_(tally), since_(tally ? thread_cpu_seconds() : 0.0) {}

    void light(const Rgb& found) {
        if (tally_)
            tally_->residual += compensation_ * found;
    }

    // Bounded lights at a vertex that no compensation has led to, by gather().
    template <class Gather>
    BoundedLight lights(bool receiver, const Gather& gather) {
        if (!tally_ || compensation_ > 0.0f)
            return gather();
        count(tally_->ray_seconds);
        const BoundedLight found = gather();
        count(tally_->light_seconds);
        if (receiver) {
            tally_->shown += luminance(found);
            tally_->lost += found.lost;
        }
        return found;
    }

    // Of the light where a ray ends, lights hold a share and give `kept` of that: the path goes on for the rest.
    void goes_on(double held, double kept) {
        if (!tally_ || !(held > kept))
            return;
        if (compensation_ == 0.0f)
            count(tally_->ray_seconds);
        compensation_ += (1.0f - compensation_) * float((held - kept) / (1.0 - kept));
    }

    void end() {
        if (tally_)
            count(compensation_ > 0.0f ? tally_->compensation_seconds : tally_->ray_seconds);
    }

private:
    void count(double& seconds) {
        const double now = thread_cpu_seconds();
        seconds += now - since_ - cost_of_thread_clock();
        since_ = now;
    }

    BoundTally* tally_;
    double since_;
    float compensation_ = 0.0f;  // of the path's throughput, what it goes on with for the rest
};

// A path from a receiver over surfaces, until virtual lights hold what they reflect. The receiver itself gathers only
// what surfaces reflect toward it; later vertices gather all light.
class VirtualLights::ExtendedPath : public PlainPath {
public:
    ExtendedPath(const VirtualLights& lights, const Shading& how, const LitSmoke* smoke)
        : PlainPath(lights.scene_),
          lights_(lights),
          panes_(how.panes),
          smoke_(smoke),
          reservoir_(how.reservoir),
          lights_apart_(how.lights_apart),
          bound_(how.bound),
          blur_(how.blur),
          lamps_along_(scene_.has_emitters() && aims_at_lamps(scene_) && !scene_.field().bricks().empty()) {}

    Rgb own_lights(const PathState& state, Rng& rng) {
        if (!lights_.samples_lights() || state.vertex.only_delta() || apart(state))
            return Rgb(0.0f);
        return bound_
            .lights(state.order == 1,
                    [&]() -> BoundedLight {
                        if (reservoir_ && state.order == 1)
                            return lights_.reservoirs()->fill(state.vertex, *reservoir_, rng);
                        return lights_.from_lights(state.vertex, rng);
                    })
            .light;
    }

    // Where lamps are estimated along segments, vertices in the medium would count their light twice. Estimates there
    // have less noise: hardly any collision lies in the beam of a lamp nearby.
    bool gathers_emitters(const PathState& state) const {
        return state.order > 1 && !(lamps_along_ && !state.vertex.on_surface());
    }

    // Lit smoke lies around the fire: a line there sees both, as the state's own segment does.
    Rgb from_fire(const PathState& state, Rng& rng) const {
        if (!smoke_)
            return PlainPath::from_fire(state, rng);
        const auto line = scene_.line_toward_fire(state.vertex, state.fire_lines, rng);
        return line ? line->weight * seen_along(line->ray, line->end, rng).emission : Rgb(0.0f);
    }

    SegmentMedium medium_along(const PathState& state, const PathStep& step, Rng& rng) {
        receiver_lit_ = state.order == 1 ||
                        (receiver_lit_ && panes_ == Panes::Sampled && goes_straight_on(state.vertex, *step.sample));
        if (receiver_lit_)
            return transmitted_along(state, step.segment, rng);
        if (smoke_)
            return seen_along(step.segment.ray, step.segment.end, rng);
        const Rgb lamps = lamps_along_ ? lights_.lamps_on(step.segment, rng) : Rgb(0.0f);
        SegmentMedium medium = PlainPath::medium_along(state, step, rng);
        medium.scattered = lamps;
        return medium;
    }

    void gather(const PathState& state, const PathStep& step) {
        ++vertices_;
        add(state.throughput * step.from_own_lights);
        add(state.throughput * step.from_fire);
        add(state.throughput * step.from_emitters);
        if (step.sample) {
            const Rgb light = step.medium.scattered + step.medium.emission * step.emission_weight;
            add(state.throughput * step.sample->weight * light);
        }
        add(step.leaving * step.at_end);
    }

    // On a surface the virtual lights take over what they hold; the path continues with the rest.
    bool arrive(const PathState& state, const PathStep& step, PathState& next) {
        if (state.order == 1)
            first_end_ = step.segment.end;
        if (step.medium.collision)
            return true;
        if (blur_ > 0.0)
            if (const std::optional<SurfacePoint> wide = widened(*step.segment.point, blur_))
                next = state_on_surface(scene_, *wide, step.segment.ray.direction, next.throughput, next.order);
        if (step.sample->delta)
            return true;
        const Seen seen = lights_.seen_by(step.segment);
        const LightSet::Ending held = lights_.ending(seen, step.sample->pdf);
        const double share_kept = lights_.share_kept(state.vertex, step.segment), kept = held.path * share_kept;
        const auto given = static_cast<float>(held.light * share_kept);
        if (given > 0.0f && !apart(state))
            add(next.throughput * given * lights_.at_end_of_ray(state.vertex, seen, step.sample->pdf));
        bound_.goes_on(held.path, kept);
        next.throughput *= 1.0f - static_cast<float>(kept);
        return true;
    }

    // Here in the medium as well: the path serves one receiver among many, and need not be long.
    bool is_long(const PathState& state) const { return state.order - 1 > kManyScatterings; }

    void end() { bound_.end(); }

    const Rgb& sum() const { return sum_; }
    int vertices() const { return vertices_; }
    const std::optional<double>& first_end() const { return first_end_; }  // of the first ray, on a surface [m]

private:
    // Whether others light that vertex by the lights.
    bool apart(const PathState& state) const { return lights_apart_ && state.order == 1; }

    void add(const Rgb& light) {
        sum_ += light;
        bound_.light(light);
    }

    // All light of the smoke counts as emission: the balance heuristic weights it between lines and segments.
    SegmentMedium seen_along(const Ray& ray, double end, Rng& rng) const {
        const LitSmoke::Light seen = smoke_->along(ray, end, rng);
        return {seen.emission + seen.scattered, Rgb(0.0f), std::nullopt, seen.transmittance};
    }

    // The receiver has been lit by the medium along this segment already.
    SegmentMedium transmitted_along(const PathState& state, const RaySegment& segment, Rng& rng) const {
        SegmentMedium medium;
        if (segment.hit || state.order > 1)
            medium.transmittance = float(scene_.lines().transmittance(segment.ray, segment.end, rng));
        return medium;
    }

    const VirtualLights& lights_;
    Panes panes_;
    const LitSmoke* smoke_;      // null: paths walk through the smoke
    LightReservoir* reservoir_;  // of the receiver; null: it gathers its light at once
    bool lights_apart_;          // from the receiver
    BoundWatch bound_;
    double blur_;               // of the receiver
    bool lamps_along_;          // estimate lamps along segments, not at vertices in the medium
    bool receiver_lit_ = true;  // by the medium along the current segment
    Rgb sum_{0.0f};
    int vertices_ = 0;
    std::optional<double> first_end_;
};

Rgb VirtualLights::shade(const PathVertex& vertex, Rng& rng, const Shading& how) const {
    if (!shines_)
        return Rgb(0.0f);
    const bool walks = how.walks > 0.0f && rng.next() < how.walks;
    ExtendedPath path(*this, how, walks ? nullptr : how.smoke);
    walk_path(scene_, {vertex, Rgb(1.0f), 0.0f, 1}, path, rng);
    path.end();
    if (how.vertices)
        *how.vertices += path.vertices();
    if (how.distance && path.first_end())
        *how.distance = *path.first_end();
    return path.sum();
}

}  // namespace brisance
