#include "correction/correct.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr Stream kCorrection = stream_of("correction/samples");

// The first survey's, beyond those of certify.seed and of believed errors: neither shares pixels with the other.
constexpr std::uint64_t kSeed = (1u << 30) + 2;

// Draws whose light is kept before it is summed.
constexpr std::size_t kDrawsAtOnce = 1 << 16;
// Of one survey: more samples are several.
constexpr std::size_t kDrawsOfSurvey = 1 << 22;

// In one task.
constexpr std::size_t kPixelsAtOnce = 1 << 14;

// Of a band the light is mostly in so many octaves of the weight. Each has to be told from chance by itself.
constexpr double kOctavesOfLight = 3.0;

// Degrees of freedom of what they measure: sums over many pixels are nearly normal.
constexpr std::size_t kStrata = 64;

std::size_t pixels_of(const Image& image) {
    return std::size_t(image.width) * std::size_t(image.height);
}

// Between even and the layer's luminance: errors are neither the same in the dark as in the light, nor in proportion to
// it. 0 where there is no light, or none that is known.
std::vector<float> weights_of(const EstimatedLayer& layer, std::size_t pixels) {
    std::vector<float> out(pixels, 0.0f);
    parallel_for(
        pixels,
        [&](std::size_t p) {
            if (const float shown = luminance(Rgb(layer.pixel(p))); std::isfinite(shown) && shown > 0.0f)
                out[p] = std::sqrt(shown * std::sqrt(shown));  // power 3/4
        },
        kPixelsAtOnce);
    return out;
}

// What is seen directly errs along the edges of pixels alone. Samples measure it, and leave it as it is.
bool is_seen_directly(const EstimatedLayer& layer) {
    return layer.layer->name == name_of(Cell::V) || layer.layer->name == name_of(Cell::A);
}

// What is sampled at surfaces has noise, which is not smooth, and rare bright paths look as if something were missing:
// SS of a corridor of mirrors erred by 13 % after a correction, and by less than 7.2 % without. SV and SM have the
// errors of the lattices that light them.
bool is_sampled(const EstimatedLayer& layer) {
    return layer.layer->name == name_of(Cell::SS) || layer.layer->name == name_of(Cell::SA);
}

// By which pixels are drawn: the root of the luminance that is corrected.
std::vector<double> sizes_of(const std::vector<EstimatedLayer>& layers, std::size_t pixels) {
    std::vector<const EstimatedLayer*> corrected;
    for (const EstimatedLayer& layer : layers)
        if (!is_seen_directly(layer))
            corrected.push_back(&layer);
    std::vector<double> out(pixels, 0.0);
    parallel_for(
        pixels,
        [&](std::size_t p) {
            for (const EstimatedLayer* layer : corrected)
                if (const double shown = luminance(Rgb(layer->pixel(p))); std::isfinite(shown) && shown > 0.0)
                    out[p] += shown;
            out[p] = std::sqrt(out[p]);
        },
        kPixelsAtOnce);
    return out;
}

// The cells but for those that are sampled at surfaces, or the beauty alone.
std::vector<EstimatedLayer> measured_layers(const Image& image, bool surroundings) {
    std::vector<EstimatedLayer> out = estimated_layers(image, surroundings);
    if (out.size() > 1)
        out.erase(out.begin());
    std::erase_if(out, is_sampled);
    return out;
}

// Layers that show parts of a cell: orders of scattering.
bool is_part_of(const std::string& cell, const std::string& layer) {
    if (cell == name_of(Cell::MV))
        return layer == "bounce1";
    return cell == name_of(Cell::MM) && layer.starts_with("bounce") && layer != "bounce1";
}

// Adds the residual to a layer, without making light negative, and what that adds to the beauty, too. Parts of the
// layer grow with it.
void add_residual(const std::vector<Rgb>& residual, const std::string& name, Image& image) {
    Layer &layer = image.layer(name), &beauty = image.layer("");
    std::vector<Layer*> parts;
    for (Layer& other : image.layers)
        if (is_part_of(name, other.name))
            parts.push_back(&other);
    parallel_for(
        residual.size(),
        [&](std::size_t p) {
            for (std::size_t c = 0; c < 3; ++c) {
                float& shown = layer.pixels[p * layer.channels.size() + c];
                const float before = shown, after = std::max(shown + residual[p][int(c)], 0.0f);
                if (!(before > 0.0f))
                    continue;
                shown = after;
                if (&layer != &beauty)
                    beauty.pixels[p * beauty.channels.size() + c] += after - before;
                for (Layer* part : parts)
                    part->pixels[p * part->channels.size() + c] *= after / before;
            }
        },
        4096);
}

// A residual of that square, by band: alike in all octaves of wavelength, give or take as much, and by what the
// samples say of each band. What is missing of it after that is in bands of which little is known. All distributions
// are normal.
std::vector<ResidualEnergy> divided(double square, const std::vector<ResidualBand>& bands) {
    std::vector<ResidualEnergy> out;
    std::vector<double> variances;
    double levels = 0.0, missing = square, doubt = 0.0;
    for (const ResidualBand& band : bands)
        levels += band.levels;
    for (const ResidualBand& band : bands) {
        out.push_back(band.sum());
        double& residual = out.back().residual;
        const double expected = band.levels / levels * square, spread = expected * expected;
        const double weight = spread > 0.0 ? spread / (spread + out.back().variance) : 0.0;
        residual = std::lerp(expected, residual, weight);
        variances.push_back(weight * out.back().variance);
        missing -= residual;
        doubt += variances.back();
    }
    for (std::size_t k = 0; k < out.size(); ++k) {
        const double share = doubt > 0.0 ? variances[k] / doubt : 0.0;
        out[k].residual = std::max(0.0, out[k].residual + share * std::max(0.0, missing));
    }
    return out;
}

}  // namespace

CertifiedError CorrectedLayer::before() const {
    CertifiedError out;
    out.cell = name;
    double residual = 0.0, variance = 0.0;
    for (const ResidualBand& band : bands) {
        const ResidualEnergy sum = band.sum();
        residual += sum.residual;
        variance += sum.variance;
    }
    if (!(square > 0.0))
        return out;
    out.square = residual / square;
    out.error = std::sqrt(std::max(0.0, out.square));
    out.square_deviation = std::sqrt(variance) / square;
    out.degrees_of_freedom = kStrata;
    return out;
}

double CorrectedLayer::found() const {
    double sum = 0.0;
    for (const ResidualBand& band : bands)
        sum += std::max(band.sum().residual, 0.0);
    return square > 0.0 ? std::sqrt(sum / square) : 0.0;
}

double CorrectedLayer::left(double error, double samples) const {
    if (!(square > 0.0) || !corrected)
        return error;
    const std::vector<ResidualEnergy> energies = divided(error * error * square, bands);
    double all = 0.0, left = 0.0;
    for (std::size_t k = 0; k < bands.size(); ++k) {
        ResidualEnergy band = energies[k];
        band.variance *= kOctavesOfLight;
        const double known = samples > 1.0 ? samples * band.known(samples) : bands[k].known();
        const double gain = known > 0.0 ? known / (known + band.noise) : 0.0;
        all += band.residual;
        left += (1.0 - gain) * (1.0 - gain) * band.residual + gain * gain * band.noise / samples;
    }
    return all > 0.0 ? error * std::sqrt(left / all) : error;
}

const CorrectedLayer* Correction::of(const std::string& cell) const {
    const auto found = std::ranges::find(layers, cell, &CorrectedLayer::name);
    return found == layers.end() ? nullptr : &*found;
}

Corrector::Corrector(Image& image, const MomentTracers& tracers, bool surroundings)
    : image_(image), tracers_(tracers), layers_(measured_layers(image, surroundings)) {
    const std::size_t pixels = pixels_of(image);
    const std::vector<Rgb> none(pixels, Rgb(0.0f));
    for (const EstimatedLayer& layer : layers_) {
        squares_.push_back(sum_of_squares(*layer.layer));
        sums_.push_back({image.width, image.height, {none, none}, weights_of(layer, pixels)});
    }
}

// Draws 2 h and 2 h + 1 of a survey are independent, and each estimate has one of them: twice the weight.
void Corrector::add(const PixelSurvey::Draw& draw, bool second, const PathSum& found) {
    const Rgb light = std::accumulate(found.begin(), found.end(), Rgb(0.0f));
    if (!std::isfinite(light.x + light.y + light.z)) {
        ++not_finite_;
        return;
    }
    for (std::size_t k = 0; k < layers_.size(); ++k)
        sums_[k].estimates[second][draw.pixel] +=
            Rgb(2.0 * draw.weight * (layers_[k].seen(found) - layers_[k].pixel(draw.pixel)));
}

void Corrector::sample(std::size_t samples, Progress& progress) {
    for (std::size_t done = 0; done < samples; done += kDrawsOfSurvey)
        survey(std::min(samples - done, kDrawsOfSurvey),
               [&](std::size_t drawn) { progress.fraction(std::min(1.0, double(done + drawn) / double(samples))); });
}

void Corrector::survey(std::size_t samples, const std::function<void(std::size_t)>& drawn) {
    const PixelSurvey survey(sizes_of(layers_, pixels_of(image_)), image_.width, samples, kSeed + surveys_);
    const std::vector<PixelSurvey::Draw>& draws = survey.draws();
    std::vector<PathSum> found(std::min(draws.size(), kDrawsAtOnce));
    for (std::size_t begin = 0; begin < draws.size(); begin += kDrawsAtOnce) {
        const std::size_t some = std::min(draws.size() - begin, kDrawsAtOnce);
        parallel_for(
            some,
            [&](std::size_t i) {
                Rng rng(kCorrection, surveys_ << 32 | (begin + i));
                found[i] = tracers_.sample(draws[begin + i].pixel, rng);
            },
            64);
        for (std::size_t i = 0; i < some; ++i) {
            const PixelSurvey::Draw& draw = draws[begin + i];
            add({draw.pixel, double(draws.size()) * draw.weight}, (begin + i) % 2 == 1, found[i]);
        }
        drawn(begin + some);
    }
    samples_ += draws.size();
    ++surveys_;
    for (NoisyResidual& sum : sums_)
        sum.divisor = sum.samples = double(samples_);
}

CorrectedLayer Corrector::of(std::size_t layer, std::vector<ResidualBand> bands) const {
    return {layers_[layer].layer->name, std::move(bands), squares_[layer], !is_seen_directly(layers_[layer])};
}

// Keeps a reference.
Believable Corrector::believable_square(std::size_t layer, const BelievableError& believable) const {
    if (!believable)
        return {};
    return [this, layer, &believable](const std::vector<ResidualBand>& bands) {
        return squares_[layer] * std::pow(believable(of(layer, bands)), 2.0);
    };
}

Correction Corrector::measured(const BelievableError& believable) const {
    Correction out{samples_, not_finite_, {}};
    for (std::size_t k = 0; k < layers_.size() && samples_ > 0; ++k)
        out.layers.push_back(of(k, residual_bands(sums_[k], believable_square(k, believable))));
    return out;
}

Correction Corrector::correct(const BelievableError& believable) {
    Correction out{samples_, not_finite_, {}};
    for (std::size_t k = 0; k < layers_.size() && samples_ > 0; ++k) {
        const Believable square = believable_square(k, believable);
        if (is_seen_directly(layers_[k])) {
            out.layers.push_back(of(k, residual_bands(sums_[k], square)));
            continue;
        }
        SmoothResidual residual = smooth_residual(sums_[k], square);
        out.layers.push_back(of(k, std::move(residual.bands)));
        add_residual(residual.values, layers_[k].layer->name, image_);
    }
    return out;
}

std::uint64_t Corrector::bytes_of(int width, int height, std::size_t layers, std::size_t samples) {
    // Of each layer two estimates and a weight; of one, their pyramid and copies while it is made; the survey's order
    // and running sums.
    constexpr std::uint64_t kLayer = 2 * sizeof(Rgb) + sizeof(float),
                            kPyramid = 2 * (3 * sizeof(Rgb) + 3 * sizeof(float)), kSurvey = 4 * sizeof(double);
    return std::uint64_t(width) * std::uint64_t(height) * (layers * kLayer + kPyramid + kSurvey) +
           std::min(samples, kDrawsOfSurvey) * sizeof(PixelSurvey::Draw) + kDrawsAtOnce * sizeof(PathSum);
}

}  // namespace brisance
