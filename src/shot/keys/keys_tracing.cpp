#include "shot/keys/keys.h"

namespace brisance {

void add_tracing_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "method",
        "lighting_grid: noise-free, fast; path: the unbiased reference path tracer; auto: whichever is likely to reach "
        "lighting.error sooner, one for all frames",
        choice<RenderMethod>({{"lighting_grid", RenderMethod::LightingGrid},
                              {"path", RenderMethod::Path},
                              {"auto", RenderMethod::Automatic}}),
        [](Shot & s) -> auto& { return s.method; }));
    keys.push_back(make_key(
        "seconds",
        "wall time for a frame with all but its certificate [s]: replaces lighting.error, lighting.alpha, "
        "scattering.alpha and correction.samples=auto, or sets tracing.seconds, so that the error is least; none: the "
        "shot's own settings",
        or_word(real(above(0.0)), "none", 0.0), [](Shot & s) -> auto& { return s.seconds; }));
    keys.push_back(make_key(
        "tracing.seed", "other seeds draw other random numbers: independent renders of one picture", whole(0, 1 << 30),
        [](Shot & s) -> auto& { return s.tracing.seed; }));
    keys.push_back(make_key(
        "tracing.samples",
        "camera rays per pixel, each the start of several paths; none: until tracing.seconds or tracing.error; method "
        "auto does not use it",
        or_word(whole(2, 1 << 30), "none", 0), [](Shot & s) -> auto& { return s.tracing.samples; }));
    keys.push_back(make_key(
        "tracing.seconds", "stops after this time, when every pixel has had equally many paths [s]",
        or_word(real(above(0.0)), "none", 0.0), [](Shot & s) -> auto& { return s.tracing.seconds; }));
    keys.push_back(make_key(
        "tracing.error", "stops when the picture's relative standard error is this small",
        or_word(real({0.0, 1.0, true}), "none", 0.0), [](Shot & s) -> auto& { return s.tracing.error; }));
    keys.push_back(make_key(
        "tracing.checkpoint_seconds", "between checkpoints, where --checkpoint keeps one [s]", real(at_least(0.0)),
        [](Shot & s) -> auto& { return s.tracing.checkpoint_seconds; }));
    keys.push_back(make_key(
        "tracing.emission", "line: along the whole of every segment; collision: the plain tracker, slow",
        choice<EmissionEstimator>({{"line", EmissionEstimator::Line}, {"collision", EmissionEstimator::Collision}}),
        [](Shot & s) -> auto& { return s.tracing.emission; }));
    keys.push_back(make_key(
        "tracing.light_sampling", "lines toward the fire where the smoke is thin, with multiple importance sampling",
        flag(), [](Shot & s) -> auto& { return s.tracing.light_sampling; }));
    keys.push_back(make_key(
        "tracing.free_flight", "how the next scattering is found",
        choice<FreeFlight>({{"exact", FreeFlight::Exact}, {"null_collision", FreeFlight::NullCollision}}),
        [](Shot & s) -> auto& { return s.tracing.free_flight; }));
    keys.push_back(make_key(
        "tracing.transmittance", "through smoke that does not burn",
        choice<TransmittanceEstimator>({{"exact", TransmittanceEstimator::Exact},
                                        {"ray_march", TransmittanceEstimator::RayMarch},
                                        {"ratio", TransmittanceEstimator::Ratio}}),
        [](Shot & s) -> auto& { return s.tracing.transmittance; }));
    keys.push_back(make_key(
        "tracing.denoising_radius",
        "for comparison: the finished picture is filtered over so many pixels, as in compositing, which biases it; 0: "
        "not",
        whole(0, 64), [](Shot & s) -> auto& { return s.tracing.denoising_radius; }));
}

}  // namespace brisance
