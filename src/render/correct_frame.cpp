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

// The first samples, which tell how many are needed: of the time that samples may take, and at least of the picture's.
// Fewer know so little that more never seem to help. No more than so many where an error of 0.02 is asked for, as they
// may be enough.
constexpr double kFirst = 1.0 / 12.0, kFirstOfPicture = 0.4, kMostFirst = 32768.0, kErrorOfMostFirst = 0.02;
// Of the error asked for: what samples leave is believed to be 0.75 to 1 times what certificates find
// (docs/numbers.md).
constexpr double kAim = 0.85;

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

// Of a corrected layer: its error before that, and its part of the picture's squared error.
struct LayerError {
    double error = 0.0, square_of_picture = 0.0;
};

const ExpectedError* of_cell(const std::vector<ExpectedError>& expected, const std::string& cell) {
    const auto found = std::ranges::find(expected, cell, &ExpectedError::cell);
    return found == expected.end() ? nullptr : &*found;
}

std::vector<LayerError> layer_errors(const Correction& correction, const std::vector<ExpectedError>& expected,
                                     const Image& image) {
    const double all = sum_of_squares(image.layer(""));
    std::vector<LayerError> out;
    for (const CorrectedLayer& layer : correction.layers) {
        const ExpectedError* const e = of_cell(expected, layer.name);
        const double error = e && all > 0.0 ? before(*e, layer).error : 0.0;
        out.push_back({error, error > 0.0 ? error * error * layer.square / all : 0.0});
    }
    return out;
}

// Where even the most samples do not reach the wanted error: what fewer may leave, over what the most would.
constexpr double kHardlyMore = 1.05;

// Of the picture's squared error, what no samples find: that of cells which are not corrected.
double square_beside(const Correction& correction, const std::vector<ExpectedError>& expected, const Image& image) {
    const double all = sum_of_squares(image.layer(""));
    double sum = 0.0;
    for (const Layer& layer : image.layers)
        if (const ExpectedError* const e = layer.name.empty() ? nullptr : of_cell(expected, layer.name);
            e && !correction.of(layer.name) && all > 0.0)
            sum += e->error * e->error * sum_of_squares(layer) / all;
    return sum;
}

// How many times the samples that there are leave no more than `wanted`; at most `most`. `beside`: square_beside().
double samples_for(double wanted, const Correction& correction, const std::vector<LayerError>& errors, double beside,
                   double most) {
    const auto square_left = [&](double samples) {
        double sum = beside;
        for (std::size_t k = 0; k < errors.size(); ++k)
            if (errors[k].error > 0.0)
                sum += errors[k].square_of_picture *
                       std::pow(correction.layers[k].left(errors[k].error, samples) / errors[k].error, 2);
        return sum;
    };
    const double square = std::max(wanted * wanted, kHardlyMore * kHardlyMore * square_left(most));
    double enough = most, too_few = 1.0;
    for (int step = 0; step < 30; ++step) {
        const double middle = std::sqrt(too_few * enough);
        (square_left(middle) < square ? enough : too_few) = middle;
    }
    return enough;
}

// The largest error that the model and the samples hold for likely together.
BelievableError believable_by(const std::vector<ExpectedError>& expected) {
    return [&](const CorrectedLayer& layer) {
        const CertifiedError found = layer.before();
        const ExpectedError* const e = of_cell(expected, layer.name);
        return e ? believed_error(*e, &found).interval.high : found.error;
    };
}

std::size_t first_of(std::size_t most, double share, double error) {
    const double wanted = std::clamp(kFirstOfPicture / share, kFirst, 1.0) * double(most);
    const double enough = kMostFirst * std::pow(kErrorOfMostFirst / error, 2.0);
    return std::min(most, static_cast<std::size_t>(std::clamp(wanted, kFewestCorrections, enough)));
}

void sample(Corrector& corrector, const MomentTracers& tracers, const RenderedFrame& frame, const DrawInput& input,
            const Shot& asked, const std::vector<ExpectedError>& expected, Progress& progress) {
    if (asked.correction.samples > 0) {
        corrector.sample(static_cast<std::size_t>(asked.correction.samples), progress);
        return;
    }
    const Shot solved = as_solved(input.shot, frame.statistics);
    const double share = most_of_correction(asked, input.plan);
    // Lattices count on samples, however little time the picture takes.
    const std::size_t most = std::max(
        static_cast<std::size_t>(kFewestCorrections),
        samples_of_share(share, solved, CountedMedium(input.medium), input.plan, tracers.tracer(0), tracers.camera(0)));
    const std::size_t first = first_of(most, share, asked.lighting.error);
    corrector.sample(first, progress);
    const Correction first_look = corrector.measured(believable_by(expected));
    const double times =
        samples_for(kAim * asked.lighting.error, first_look, layer_errors(first_look, expected, frame.image),
                    square_beside(first_look, expected, frame.image), double(most) / double(first));
    if (const double more = (times - 1.0) * double(first); more >= 2.0)
        corrector.sample(static_cast<std::size_t>(more), progress);
}

void note(const Correction& correction, StageCost& cost) {
    cost.detail["samples"] = correction.samples;
    for (const CorrectedLayer& layer : correction.layers) {
        nlohmann::ordered_json gains = nlohmann::ordered_json::array(), squares = gains;
        for (const ResidualBand& band : layer.bands) {
            gains.push_back(band.gain());
            squares.push_back(layer.square > 0.0 ? band.sum().residual / layer.square : 0.0);
        }
        cost.detail[layer.name.empty() ? "picture" : layer.name] = {{"corrected", layer.corrected},
                                                                    {"error_found", layer.found()},
                                                                    {"left_of_that", layer.left(layer.found())},
                                                                    {"square_errors_found", squares},
                                                                    {"gains", gains}};
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
    const std::vector<ExpectedError> expected =
        expected_errors(frame.image, {input.shot, input.medium, input.plan}, frame.statistics);
    sample(corrector, tracers, frame, input, asked, expected, progress);
    const Correction correction = corrector.correct(believable_by(expected));
    if (asked.correction.samples > 0 && correction.samples == 0)
        progress.warning("correction",
                         "correction.samples has no effect: the picture shows no light that is corrected");
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
