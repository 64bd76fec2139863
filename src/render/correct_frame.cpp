#include "render/correct_frame.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/cpu_clock.h"
#include "core/stopwatch.h"
#include "forecast/correction_plan.h"
#include "forecast/expected_errors.h"
#include "render/believe.h"

namespace brisance {

namespace {

// Of the time that samples may take: the first ones, which tell how many are needed.
constexpr double kFirst = 1.0 / 12.0;
// Of the error asked for: a little less is aimed at, since the samples' own error is known by chance.
constexpr double kAim = 0.95;

// A layer's error before the correction: what the model expects, and what the samples measured.
ExpectedError before(ExpectedError error, const CorrectedLayer& layer) {
    const CertifiedError found = layer.before();
    const BelievedError measured = believed_error(error, &found);
    if (error.spread > 0.0 && measured.interval.low > 0.0) {
        error.error = measured.error;
        error.spread = std::log(measured.interval.high / measured.interval.low) / (2.0 * kHalfWidthOfModel);
    }
    return error;
}

// Of a corrected layer, by the error model: its error, and its part of the picture's squared error. The first samples
// are too few to tell it better: where they have heavy tails, they find too little most of the time.
struct LayerError {
    double error = 0.0, square_of_picture = 0.0;
};

std::vector<LayerError> layer_errors(const Correction& correction, const RenderedFrame& frame, const DrawInput& input) {
    std::vector<LayerError> out;
    for (const CorrectedLayer& layer : correction.layers) {
        double own = 0.0;
        const auto alone = [&](ExpectedError& e) { e.error = e.cell == layer.name ? own = e.error : 0.0; };
        const double error =
            expected_errors(frame.image, {input.shot, input.medium, input.plan}, frame.statistics, alone)[0].error;
        out.push_back({own > 0.0 ? own : error, error * error});
    }
    return out;
}

// How many times the samples that there are leave no more than `wanted`; at most `most`.
double samples_for(double wanted, const Correction& correction, const std::vector<LayerError>& errors, double most) {
    const auto square_left = [&](double samples) {
        double sum = 0.0;
        for (std::size_t k = 0; k < errors.size(); ++k)
            if (errors[k].error > 0.0)
                sum += errors[k].square_of_picture *
                       std::pow(correction.layers[k].left(errors[k].error, samples) / errors[k].error, 2);
        return sum;
    };
    double enough = most, too_few = 1.0;
    if (!(square_left(most) < wanted * wanted))
        return most;
    for (int step = 0; step < 30; ++step) {
        const double middle = std::sqrt(too_few * enough);
        (square_left(middle) < wanted * wanted ? enough : too_few) = middle;
    }
    return enough;
}

void sample(Corrector& corrector, const RenderedFrame& frame, const DrawInput& input, const Shot& asked,
            Progress& progress) {
    if (asked.correction.samples > 0) {
        corrector.sample(static_cast<std::size_t>(asked.correction.samples), progress);
        return;
    }
    const Shot solved = as_solved(input.shot, frame.statistics);
    const std::size_t most =
        samples_of_share(most_of_correction(asked, input.plan), solved, CountedMedium(input.medium), input.plan,
                         input.camera, input.surroundings);
    const auto first = static_cast<std::size_t>(kFirst * double(most));
    if (first == 0)
        return;
    corrector.sample(first, progress);
    const Correction first_look = corrector.measured();
    const double times = samples_for(kAim * asked.lighting.error, first_look, layer_errors(first_look, frame, input),
                                     double(most) / double(first));
    if (const double more = (times - 1.0) * double(first); more >= 2.0)
        corrector.sample(static_cast<std::size_t>(more), progress);
}

void note(const Correction& correction, StageCost& cost) {
    cost.detail["samples"] = correction.samples;
    for (const CorrectedLayer& layer : correction.layers) {
        nlohmann::ordered_json gains = nlohmann::ordered_json::array();
        for (const ResidualBand& band : layer.bands)
            gains.push_back(band.gain());
        cost.detail[layer.name.empty() ? "picture" : layer.name] = {
            {"error_found", layer.found()}, {"left_of_that", layer.left(0.0)}, {"gains", gains}};
    }
}

}  // namespace

ExpectedError error_left(ExpectedError error, const Correction& correction) {
    const CorrectedLayer* const layer = correction.of(error.cell);
    if (!layer)
        return error;
    error = before(error, *layer);
    error.error = layer->left(error.error);
    return error;
}

bool may_be_corrected(const Shot& asked, const Plan& plan) {
    return asked.correction.samples > 0 || most_of_correction(asked, plan) > 0.0;
}

Correction correct_frame(RenderedFrame& frame, const DrawInput& input, const Shot& asked, Progress& progress) {
    progress.stage("correction");
    const Stopwatch watch;
    const double cpu = process_cpu_seconds();
    const MomentTracers tracers = tracers_of(certified_scene(input));
    Corrector corrector(frame.image, tracers, input.surroundings != nullptr);
    sample(corrector, frame, input, asked, progress);
    const Correction correction = corrector.correct();
    if (correction.not_finite > 0)
        progress.warning("correction",
                         fmt::format("{} samples were not finite and are left out", correction.not_finite));
    StageCost cost{"correction",
                   watch.seconds(),
                   tracers.bytes() + Corrector::bytes_of(frame.image.width, frame.image.height,
                                                         correction.layers.size(), correction.samples),
                   {}};
    note(correction, cost);
    cost.detail["cpu_seconds"] = process_cpu_seconds() - cpu;
    frame.statistics.stages.push_back(std::move(cost));
    return correction;
}

}  // namespace brisance
