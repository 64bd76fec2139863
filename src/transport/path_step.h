// A path from the camera, or from any other receiver of light: one step from a vertex to the next, and the whole path.
//
// At each vertex two techniques estimate direct light. Next-event estimation samples a line toward the fire, whose
// emission is integrated along the whole line [1], and a point on an emitter, which the light tree chooses. The
// direction in which the path continues is sampled from the phase function or the BSDF; it collects the emission of the
// medium along its segment, and that of the surface or the background at the end. The balance heuristic weights what
// both techniques can find [2, section 9.2.2.1].
//
// Paths differ in what else their vertices gather, in what the medium does along a segment, and in when they end. A
// PathReader answers these questions, and sums up the light.
//
// [1] Simon, Hanika, Zirr, Dachsbacher, Line Integration for Rendering Heterogeneous Emissive Volumes, EGSR 2017.
// [2] Veach, Robust Monte Carlo Methods for Light Transport Simulation, 1997.
#pragma once

#include <concepts>
#include <optional>
#include <utility>

#include "transport/direct_light.h"
#include "transport/roulette.h"

namespace brisance {

// A vertex at which a path scatters, before its next direction is sampled.
struct PathState {
    PathVertex vertex;
    Rgb throughput;    // includes the albedo of a vertex in the medium; excludes the BSDF of one on a surface
    float fire_lines;  // probability that next-event estimation samples a line toward the fire
    int order;         // scatterings of the path, this one included
};

PathState state_in_medium(const DirectLight& scene, const Ray& ray, const Collision& collision,
                          const Rgb& throughput_before, int order);
PathState state_on_surface(const DirectLight& scene, const SurfacePoint& point, const dvec3& arriving,
                           const Rgb& throughput, int order);

// What the medium does to a segment of a path.
struct SegmentMedium {
    Rgb emission{0.0f};                  // along the segment, seen from its start [W/(m^2 sr)]
    Rgb scattered{0.0f};                 // light of emitters that it scatters once, if the reader gathers it here
    std::optional<Collision> collision;  // the next vertex, if a free flight ends before the segment does
    float transmittance = 1.0f;          // weight of all light from the segment's end; 1 after a free flight
};

// What a path gathers at one vertex, and the segment that leaves it. Radiance is [W/(m^2 sr)].
struct PathStep {
    // Scattered at the vertex toward the path's origin, for a throughput of 1.
    Rgb from_own_lights{0.0f};  // the lights of the reader
    Rgb from_fire{0.0f};        // next-event estimation, weighted against the sampled direction
    Rgb from_emitters{0.0f};    // likewise
    // Along the sampled direction; nothing if the vertex absorbs the path.
    std::optional<PathVertex::Sample> sample;
    RaySegment segment;
    SegmentMedium medium;
    float emission_weight = 1.0f;  // balance heuristic for medium.emission
    Rgb at_end{0.0f};              // emission at the segment's end, weighted likewise
    Rgb leaving{0.0f};             // throughput of the light that arrives along the segment
};

template <class R>
concept PathReader = requires(R& reader, const PathState& state, const PathStep& step, PathState& next, Rng& rng) {
    // Scattered light of the lights that the reader holds itself, for a throughput of 1 [W/(m^2 sr)].
    { reader.own_lights(state, rng) } -> std::same_as<Rgb>;
    // Of the fire by a line toward it, which the state has lines for, weighted against the sampled direction, for a
    // throughput of 1 [W/(m^2 sr)].
    { reader.from_fire(state, rng) } -> std::same_as<Rgb>;
    // Whether the vertex gathers direct light of emitters and background, by either technique.
    { reader.gathers_emitters(state) } -> std::same_as<bool>;
    // `step` has its segment. What else is on the segment, and where it collides.
    { reader.medium_along(state, step, rng) } -> std::same_as<SegmentMedium>;
    // Sums up the light of one vertex.
    { reader.gather(state, step) } -> std::same_as<void>;
    // Whether the path has a vertex beyond this one.
    { reader.continues(state) } -> std::same_as<bool>;
    // At the next vertex: may change its throughput. False ends the path there.
    { reader.arrive(state, step, next) } -> std::same_as<bool>;
    // Whether roulette must be able to end the path here although it has lost no throughput.
    { reader.is_long(state) } -> std::same_as<bool>;
    // The direction in which the path goes on; none: the vertex absorbs it.
    { reader.direction(state, rng) } -> std::same_as<std::optional<PathVertex::Sample>>;
};

// The answers of a plain path; a reader derives from it and hides what it does otherwise.
class PlainPath {
public:
    explicit PlainPath(const DirectLight& scene) : scene_(scene) {}

    Rgb own_lights(const PathState&, Rng&) const { return Rgb(0.0f); }
    Rgb from_fire(const PathState& state, Rng& rng) const {
        return scene_.from_fire(state.vertex, state.fire_lines, rng);
    }
    bool gathers_emitters(const PathState&) const { return true; }
    SegmentMedium medium_along(const PathState&, const PathStep& step, Rng& rng) const;
    bool continues(const PathState&) const { return true; }
    bool arrive(const PathState&, const PathStep&, PathState&) const { return true; }
    std::optional<PathVertex::Sample> direction(const PathState& state, Rng& rng) const {
        return state.vertex.sample(rng);
    }
    // Surfaces may reflect everything for ever; the medium lets paths out.
    bool is_long(const PathState& state) const { return state.vertex.on_surface() && state.order > kManyScatterings; }

protected:
    const DirectLight& scene_;
};

namespace detail {

template <PathReader Reader>
void sample_lights(const DirectLight& scene, const PathState& state, Reader& reader, Rng& rng, PathStep& step) {
    step.from_own_lights = reader.own_lights(state, rng);
    if (state.fire_lines > 0.0f && (state.fire_lines == 1.0f || rng.next() < state.fire_lines))
        step.from_fire = reader.from_fire(state, rng);
    if (reader.gathers_emitters(state) && scene.has_emitters() && !state.vertex.only_delta())
        step.from_emitters = scene.from_emitters(state.vertex, rng);
}

template <PathReader Reader>
void follow_segment(const DirectLight& scene, const PathState& state, Reader& reader, Rng& rng, PathStep& step) {
    const PathVertex::Sample& sample = *step.sample;
    step.segment = scene.segment_along(state.vertex.leaving(sample.wi));
    step.medium = reader.medium_along(state, step, rng);
    step.leaving = state.throughput * sample.weight * step.medium.transmittance;
    if (step.medium.emission != Rgb(0.0f) && !sample.delta)
        step.emission_weight = scene.weight_of_sample(state.fire_lines, step.segment.ray, sample.pdf);
    if (scene.surroundings() && !step.medium.collision && reader.gathers_emitters(state))
        step.at_end = scene.at_end(step.segment, sample.pdf, sample.delta, &state.vertex);
}

}  // namespace detail

// Gathers the light at one vertex and samples the segment to the next.
template <PathReader Reader>
PathStep step_from(const DirectLight& scene, const PathState& state, Reader& reader, Rng& rng) {
    PathStep step;
    detail::sample_lights(scene, state, reader, rng, step);
    step.sample = reader.direction(state, rng);
    if (step.sample)
        detail::follow_segment(scene, state, reader, rng, step);
    reader.gather(state, step);
    return step;
}

// The vertex at the end of the step; none where the path leaves the scene or is absorbed.
std::optional<PathState> next_state(const DirectLight& scene, const PathState& state, const PathStep& step);

// The path after `state`. Russian roulette ends it by the throughput that it has lost since then.
template <PathReader Reader>
void walk_path(const DirectLight& scene, PathState state, Reader& reader, Rng& rng) {
    const float begin = largest(state.throughput);
    while (survives(state.throughput, begin, reader.is_long(state), rng)) {
        const PathStep step = step_from(scene, state, reader, rng);
        if (!reader.continues(state))
            return;
        std::optional<PathState> next = next_state(scene, state, step);
        if (!next || !reader.arrive(state, step, *next))
            return;
        state = *next;
    }
}

}  // namespace brisance
