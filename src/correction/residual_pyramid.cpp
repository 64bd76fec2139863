#include "correction/residual_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "correction/plane.h"

namespace brisance {

namespace {

// The coarsest level has fewer rows or columns than this: nothing is left to blur.
constexpr int kCoarsest = 4;

// Octaves of the weight's square that are told apart, below the largest.
constexpr std::size_t kOctaves = 16;

// A sample's noise is some ten times as large as what pictures miss: a band whose pixels have fewer samples would tell
// nothing, and takes time.
constexpr double kFewestSamples = 1.0;

// A residual is known as far as it exceeds so many standard deviations.
constexpr double kDeviations = 2.0;

// Bands overlap: but for the finest, each holds less of the residual, and more of the noise, than the picture loses or
// gains by it. Ratios of residuals of any wavelength from 4 pixels to 64 (1.4 to 1.6) and of white noise. The coarsest
// band has all of what is even.
constexpr double kResidualOfOverlap = 1.5, kNoiseOfOverlap = 0.58;

// One level of the pyramid: sums of the residual and of the weight, then their quotients.
struct Level {
    Plane<Rgb> estimates[2];
    Plane<float> weight, square;  // the mean of the weight's square
};

Level reduced(const Level& from) {
    return {{reduced(from.estimates[0]), reduced(from.estimates[1])}, reduced(from.weight), reduced(from.square)};
}

void divide_by_weight(Level& level) {
    for (Plane<Rgb>& estimate : level.estimates)
        for_rows(estimate.height, [&](int y) {
            for (int x = 0; x < estimate.width; ++x) {
                const float w = level.weight.row(y)[x];
                estimate.row(y)[x] = w > 0.0f ? estimate.row(y)[x] / w : Rgb(0.0f);
            }
        });
}

// Between which octaves of its band's weight a pixel stands.
class Octaves {
public:
    explicit Octaves(const Level& band) : largest_(*std::ranges::max_element(band.square.values)) {}
    // The first of two, and the share of the second.
    std::pair<std::size_t, float> of(float square) const {
        const float octave = square > 0.0f ? std::log2(largest_ / square) : float(kOctaves);
        const float at = std::min(octave, float(kOctaves) - 1.001f);
        const auto first = static_cast<std::size_t>(at);
        return {first, at - float(first)};
    }

private:
    float largest_;
};

// Of a pixel with two estimates, whose weight has so large a square.
ResidualEnergy energy_of(const Rgb& a, const Rgb& b, double square = 1.0) {
    const Rgb half = 0.5f * (a - b);
    const double noise = square * glm::dot(half, half);
    // Of noise with a variance s of each estimate, a b has the variance s^2, and (a - b)^4 / 16 the mean 3 s^2 / 4.
    return {square * glm::dot(a, b), noise, 4.0 / 3.0 * noise * noise, square};
}

// Of one of the band's pixels, which stands for `pixels` of the finest level.
ResidualEnergy energy_at(const Level& band, int x, int y, double pixels) {
    return energy_of(band.estimates[0].row(y)[x], band.estimates[1].row(y)[x], pixels * band.square.row(y)[x]);
}

// Summed in a fixed order.
ResidualBand energy_of(const Level& band, double pixels) {
    const std::vector<ResidualEnergy> none(kOctaves);
    std::vector<std::vector<ResidualEnergy>> rows(std::size_t(band.square.height), none);
    const Octaves octaves(band);
    for_rows(band.square.height, [&](int y) {
        for (int x = 0; x < band.square.width; ++x) {
            const ResidualEnergy energy = energy_at(band, x, y, pixels);
            const auto [first, second] = octaves.of(band.square.row(y)[x]);
            rows[std::size_t(y)][first].add(energy, 1.0 - second);
            rows[std::size_t(y)][first + 1].add(energy, second);
        }
    });
    ResidualBand sum{none};
    for (const std::vector<ResidualEnergy>& row : rows)
        for (std::size_t k = 0; k < row.size(); ++k)
            sum.octaves[k].add(row[k], 1.0);
    return sum;
}

// What the coarser level does not hold.
void subtract(Level& level, const Level& coarser) {
    for (int k = 0; k < 2; ++k) {
        Plane<Rgb>& estimate = level.estimates[k];
        const Plane<Rgb> smooth = expanded(coarser.estimates[k], estimate.width, estimate.height);
        for_rows(estimate.height, [&](int y) {
            for (int x = 0; x < estimate.width; ++x)
                estimate.row(y)[x] -= smooth.row(y)[x];
        });
    }
}

// Samples have heavy tails: one bright path would leave a grain. A pixel is therefore taken to err by no more than a
// few times what those of its octave do, the less so the better they are known.
void add_band(Plane<Rgb>& sum, const Level& band, const ResidualBand& energy) {
    constexpr double kMost = 4.0;
    std::vector<float> gains, limits;
    for (const ResidualEnergy& octave : energy.octaves) {
        gains.push_back(float(octave.gain(1.0, energy.noise_counts / energy.residual_counts)));
        limits.push_back(float(kMost * octave.relative()) / (1.0f - gains.back()));
    }
    const Octaves octaves(band);
    for_rows(sum.height, [&](int y) {
        for (int x = 0; x < sum.width; ++x) {
            const auto [first, second] = octaves.of(band.square.row(y)[x]);
            const auto between = [first = first, second = second](const std::vector<float>& values) {
                return (1.0f - second) * values[first] + second * values[first + 1];
            };
            const Rgb known = 0.5f * between(gains) * (band.estimates[0].row(y)[x] + band.estimates[1].row(y)[x]);
            const float limit = between(limits);
            const float length = glm::length(known);
            sum.row(y)[x] += length > limit ? known * (limit / length) : known;
        }
    });
}

// What is in all levels before the first that is told apart, as one band of which nothing is known: the square of all
// less that in the other bands.
ResidualBand band_before(const ResidualEnergy& all, std::size_t levels, const std::vector<ResidualBand>& bands) {
    ResidualBand out{{all}, 1.0, 1.0, double(levels)};
    for (const ResidualBand& band : bands)
        out.octaves[0].residual -= band.sum().residual;
    out.octaves[0].believed = 0.0;
    return out;
}

// Of the residual itself, not divided into bands.
ResidualEnergy energy_of(const NoisyResidual& residual) {
    const double square = 1.0 / (residual.divisor * residual.divisor);
    std::vector<ResidualEnergy> rows(std::size_t(residual.height));
    for_rows(residual.height, [&](int y) {
        for (std::size_t p = std::size_t(y) * residual.width; p < std::size_t(y + 1) * residual.width; ++p)
            rows[std::size_t(y)].add(energy_of(residual.estimates[0][p], residual.estimates[1][p], square), 1.0);
    });
    ResidualEnergy sum;
    for (const ResidualEnergy& row : rows)
        sum.add(row, 1.0);
    return sum;
}

// No more than so much of what they seem to know.
void believe(double square, std::vector<ResidualBand>& bands) {
    double known = 0.0;
    for (const ResidualBand& band : bands)
        known += band.known();
    if (!(known > square))
        return;
    for (ResidualBand& band : bands)
        for (ResidualEnergy& octave : band.octaves)
            octave.believed = square / known;
}

// The finest level whose pixels have enough samples.
std::size_t first_level(const NoisyResidual& residual) {
    const auto lit = double(std::ranges::count_if(residual.weight, [](float w) { return w > 0.0f; }));
    std::size_t first = 0;
    int shorter = std::min(residual.width, residual.height);
    for (double pixels = 1.0; shorter >= kCoarsest && residual.samples * pixels < kFewestSamples * lit; pixels *= 4.0) {
        shorter = half_of(shorter);
        ++first;
    }
    return first;
}

void divide(Plane<Rgb>& plane, double by) {
    for (Rgb& value : plane.values)
        value /= float(by);
}

Level finest_level(const NoisyResidual& residual) {
    Level out;
    for (int k = 0; k < 2; ++k) {
        out.estimates[k] = Plane<Rgb>(residual.width, residual.height);
        out.estimates[k].values = residual.estimates[k];
    }
    out.weight = Plane<float>(residual.width, residual.height);
    out.square = out.weight;
    out.weight.values = residual.weight;
    std::ranges::transform(residual.weight, out.square.values.begin(), [](float w) { return w * w; });
    return out;
}

// Without the finest, of which only the size is known.
Level second_level(const NoisyResidual& residual) {
    const auto of = [&](const auto& value) {
        return brisance::reduced(residual.width, residual.height, [&](int x, int y) {
            return value(std::size_t(y) * std::size_t(residual.width) + std::size_t(x));
        });
    };
    const auto estimate = [&](int k) { return of([&](std::size_t p) { return residual.estimates[k][p]; }); };
    return {{estimate(0), estimate(1)}, of([&](std::size_t p) { return residual.weight[p]; }), of([&](std::size_t p) {
                return residual.weight[p] * residual.weight[p];
            })};
}

// Of the residual as it is, from a level on; finer ones have a size alone.
std::vector<Level> pyramid(const NoisyResidual& residual, std::size_t first) {
    std::vector<Level> levels;
    if (first == 0) {
        levels.push_back(finest_level(residual));
    } else {
        levels.emplace_back();
        levels[0].weight.width = residual.width;
        levels[0].weight.height = residual.height;
        levels.push_back(second_level(residual));
    }
    for (Plane<Rgb>& estimate : levels.back().estimates)
        divide(estimate, residual.divisor);
    while (std::min(levels.back().weight.width, levels.back().weight.height) >= kCoarsest)
        levels.push_back(reduced(levels.back()));
    for (std::size_t k = first; k < levels.size(); ++k)
        divide_by_weight(levels[k]);
    return levels;
}

// A residual's pyramid from level `first` on, each level less the next, and what its samples say of each.
struct DividedResidual {
    std::vector<Level> levels;
    std::size_t first;
    std::vector<ResidualBand> bands;  // SmoothResidual's
};

DividedResidual divided(const NoisyResidual& residual, const Believable& believable) {
    const std::size_t first = first_level(residual);
    DividedResidual out{pyramid(residual, first), first, {}};
    double pixels = std::pow(4.0, double(first));
    for (std::size_t k = first; k < out.levels.size(); ++k, pixels *= 4.0) {
        if (k + 1 < out.levels.size())
            subtract(out.levels[k], out.levels[k + 1]);
        out.bands.push_back(energy_of(out.levels[k], pixels));
        if (k > first)
            out.bands.back().noise_counts = kNoiseOfOverlap;
        if (k > first && k + 1 < out.levels.size())
            out.bands.back().residual_counts = kResidualOfOverlap;
    }
    if (first > 0)
        out.bands.insert(out.bands.begin(), band_before(energy_of(residual), first, out.bands));
    if (believable)
        believe(believable(out.bands), out.bands);
    return out;
}

}  // namespace

void ResidualEnergy::add(const ResidualEnergy& other, double share) {
    residual += share * other.residual;
    noise += share * other.noise;
    variance += share * other.variance;
    weight += share * other.weight;
}

double ResidualEnergy::known(double samples) const {
    const double chance = kDeviations * kDeviations * variance / (samples * samples);
    return residual > 0.0 ? believed * std::max(residual - chance / residual, 0.0) : 0.0;
}

double ResidualEnergy::gain(double samples, double noise_counts) const {
    const double sure = known(samples);
    return sure > 0.0 ? samples * sure / (samples * sure + noise_counts * noise) : 0.0;
}

double ResidualEnergy::relative() const {
    return weight > 0.0 ? std::sqrt(known() / weight) : 0.0;
}

ResidualEnergy ResidualBand::sum() const {
    ResidualEnergy out;
    for (const ResidualEnergy& octave : octaves)
        out.add(octave, 1.0);
    out.residual *= residual_counts;
    out.variance *= residual_counts * residual_counts;
    out.noise *= noise_counts;
    return out;
}

double ResidualBand::known() const {
    double sum = 0.0;
    for (const ResidualEnergy& octave : octaves)
        sum += residual_counts * octave.known();
    return sum;
}

double ResidualBand::left(double samples) const {
    double left = 0.0, of_noise = 0.0;
    for (const ResidualEnergy& octave : octaves) {
        const double gain = octave.gain(samples, noise_counts / residual_counts);
        left += residual_counts * (1.0 - gain) * (1.0 - gain) * octave.residual;
        of_noise += noise_counts * gain * gain * octave.noise / samples;
    }
    return std::max(left, 0.0) + of_noise;
}

double ResidualBand::gain() const {
    const double all = sum().residual;
    return all > 0.0 ? std::clamp(1.0 - left() / all, 0.0, 1.0) : 0.0;
}

std::vector<ResidualBand> residual_bands(const NoisyResidual& residual, const Believable& believable) {
    return divided(residual, believable).bands;
}

SmoothResidual smooth_residual(const NoisyResidual& residual, const Believable& believable) {
    auto [levels, first, bands] = divided(residual, believable);
    const std::size_t before = first > 0 ? 1 : 0;
    Plane<Rgb> sum(levels.back().weight.width, levels.back().weight.height);
    for (std::size_t k = levels.size(); k-- > 0;) {
        if (k + 1 < levels.size())
            sum = expanded(sum, levels[k].weight.width, levels[k].weight.height);
        if (k >= first)
            add_band(sum, levels[k], bands[k - first + before]);
    }
    SmoothResidual out{std::move(sum.values), std::move(bands)};
    for_rows(residual.height, [&](int y) {
        const std::size_t row = std::size_t(y) * std::size_t(residual.width);
        for (std::size_t p = row; p < row + std::size_t(residual.width); ++p)
            out.values[p] *= residual.weight[p];
    });
    return out;
}

}  // namespace brisance
