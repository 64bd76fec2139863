#include "render/believe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/cpu_clock.h"
#include "core/stopwatch.h"
#include "forecast/costs.h"
#include "forecast/expected_errors.h"
#include "render/correct_frame.h"

namespace brisance {

namespace {

// Beyond those of certify.seed: no certificate shares samples with what was believed before it.
constexpr int kSeed = (1 << 30) + 1;

constexpr std::size_t kFirstPixels = 128;
constexpr std::size_t kFewestSamples = 1024, kMaximumSamples = 1 << 18;
// Fewer draws do not show how large errors differ from pixel to pixel; more are of no use to an error.
constexpr double kLeastDraws = 32.0, kMostDraws = 2048.0;
// Standard deviation of (I - R)^2 over draws, over its mean.
constexpr double kSpreadOfDraws = 2.7;

// So many samples in all err least in the squared error where each draw has so many (certify.cpp), if the picture's
// error is the expected one.
std::size_t draws_for(std::size_t samples, double noise_square, double error) {
    const double each = 1.0 + std::sqrt(2.0) * noise_square / (kSpreadOfDraws * error * error);
    return static_cast<std::size_t>(std::clamp(double(samples) / each, kLeastDraws, kMostDraws));
}

std::optional<Certificate> survey(const Image& image, const DrawInput& input, const Statistics& statistics,
                                  double expected, Progress& progress) {
    const double of_grid = grid_seconds(as_solved(input.shot, statistics), CountedMedium(input.medium), input.plan,
                                        input.camera.settings());
    const double seconds = input.shot.certify.belief * of_grid - tracer_seconds(input.medium);
    if (!(seconds > 0.0))
        return std::nullopt;
    const CertifiedScene scene = certified_scene(input);
    const MomentTracers tracers = tracers_of(scene);
    const PathPilot pilot = trace_pilot(tracers.tracer(0), tracers.camera(0), kFirstPixels);
    const double left = seconds - pilot_seconds(pilot, kFirstPixels);
    const auto samples = static_cast<std::size_t>(
        std::clamp(left / std::max(pilot.lit_ray_seconds(), 1e-9), 0.0, double(kMaximumSamples)));
    if (samples < kFewestSamples)
        return std::nullopt;
    return certify(image, scene, tracers, {draws_for(samples, pilot.square_error, expected), samples, kSeed}, progress);
}

const CertifiedError* sampled(const std::optional<Certificate>& survey, const std::string& cell) {
    for (std::size_t k = 0; survey && k < survey->errors.size(); ++k)
        if (survey->errors[k].cell == cell)
            return &survey->errors[k];
    return nullptr;
}

Belief believe_lights(const Image& image, const DrawInput& input, const Statistics& statistics,
                      const Correction& correction, Progress& progress) {
    const std::vector<ExpectedError> expected =
        expected_errors(image, {input.shot, input.medium, input.plan}, statistics,
                        [&](ExpectedError& e) { e = error_left(e, correction); });
    Belief out;
    std::optional<Certificate> samples;
    if (expected[0].error > 0.0 && input.shot.certify.belief > 0.0 && correction.layers.empty())
        samples = survey(image, input, statistics, expected[0].error, progress);
    if (samples) {
        out.samples = samples->samples;
        out.pixels = samples->pixels;
    }
    for (const ExpectedError& e : expected)
        out.errors.push_back(believed_error(e, sampled(samples, e.cell)));
    return out;
}

// Half the halves' difference over their mean, over all pixels.
BelievedError standard_error(const Layer& a, const Layer& b) {
    double noise = 0.0, norm = 0.0;
    for (std::size_t p = 0; p + 2 < a.pixels.size(); p += a.channels.size())
        for (std::size_t c = 0; c < 3; ++c) {
            noise += std::pow(double(a.pixels[p + c]) - b.pixels[p + c], 2);
            norm += std::pow(double(a.pixels[p + c]) + b.pixels[p + c], 2);
        }
    const double error = norm > 0.0 ? std::sqrt(noise / norm) : 0.0;
    return {a.name, error, {error, error}, error};
}

Belief believe_paths(const std::vector<Image>& halves, const Plan& plan) {
    Belief out;
    const std::vector<std::string> cells = plan.cells();
    for (const Layer& layer : halves[0].layers)
        if (layer.name.empty() || std::find(cells.begin(), cells.end(), layer.name) != cells.end())
            out.errors.push_back(standard_error(layer, halves[1].layer(layer.name)));
    return out;
}

// The error asked for, and its key; none: there is none.
std::pair<double, const char*> error_asked(const Shot& shot) {
    if (shot.method == RenderMethod::Path)
        return {shot.tracing.error, "tracing.error"};
    return {shot.lighting.error, "lighting.error"};
}

}  // namespace

CertifiedScene certified_scene(const DrawInput& input) {
    return {input.medium,
            input.camera,
            input.surroundings,
            input.shot.tracing,
            input.shot.scattering.bounces,
            input.plan.emission || input.plan.emitters,
            input.moments()};
}

Belief believe(const RenderedFrame& frame, const DrawInput& input, const Shot& shot, const Correction& correction,
               StageCost& cost, Progress& progress) {
    progress.stage("believed error");
    const Stopwatch watch;
    const double cpu = process_cpu_seconds();
    Belief out = frame.halves.size() == 2 ? believe_paths(frame.halves, input.plan)
                                          : believe_lights(frame.image, input, frame.statistics, correction, progress);
    cost = {
        "believed error", watch.seconds(), 0, {{"samples", out.samples}, {"cpu_seconds", process_cpu_seconds() - cpu}}};
    progress.notice("believed error: " + out.line());
    const auto [asked, key] = error_asked(shot);
    // As numbers of the shot: 0.02 is no more than 0.02f.
    if (asked > 0.0 && static_cast<float>(out.errors[0].error) > static_cast<float>(asked))
        progress.warning("error", fmt::format("{}={:.3g} is not reached: the picture is believed to have an error of "
                                              "{:.2g} %",
                                              key, asked, 100.0 * out.errors[0].error));
    return out;
}

}  // namespace brisance
