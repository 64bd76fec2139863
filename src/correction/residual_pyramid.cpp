#include "correction/residual_pyramid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "core/parallel.h"

namespace brisance {

namespace {

// The coarsest level has fewer rows or columns than this: nothing is left to blur.
constexpr int kCoarsest = 4;

// Octaves of the weight's square that are told apart, below the largest.
constexpr std::size_t kOctaves = 16;

// A residual is known as far as it exceeds so many standard deviations.
constexpr double kDeviations = 2.0;

// Bands overlap: but for the finest, each holds less of the residual, and more of the noise, than the picture loses or
// gains by it. Ratios of residuals of any wavelength from 4 pixels to 64 (1.4 to 1.6) and of white noise.
constexpr double kResidualOfOverlap = 1.5, kNoiseOfOverlap = 0.58;

template <class T>
struct Plane {
    int width = 0, height = 0;
    std::vector<T> values;
    Plane() = default;
    Plane(int w, int h) : width(w), height(h), values(std::size_t(w) * std::size_t(h), T(0.0f)) {}
    T* row(int y) { return values.data() + std::size_t(y) * std::size_t(width); }
    const T* row(int y) const { return values.data() + std::size_t(y) * std::size_t(width); }
};

template <class Body>
void for_rows(int rows, const Body& body) {
    parallel_for(
        std::size_t(rows), [&](std::size_t y) { body(static_cast<int>(y)); }, 8);
}

int half_of(int size) {
    return (size + 1) / 2;
}

// Binomial weights over five pixels, nothing beyond the border; every second pixel.
template <class T>
Plane<T> reduced(const Plane<T>& from) {
    constexpr float kBinomial[] = {1.0f / 16.0f, 4.0f / 16.0f, 6.0f / 16.0f, 4.0f / 16.0f, 1.0f / 16.0f};
    Plane<T> narrow(half_of(from.width), from.height), out(half_of(from.width), half_of(from.height));
    for_rows(narrow.height, [&](int y) {
        for (int x = 0; x < narrow.width; ++x)
            for (int k = -2; k <= 2; ++k)
                if (const int at = 2 * x + k; at >= 0 && at < from.width)
                    narrow.row(y)[x] += kBinomial[k + 2] * from.row(y)[at];
    });
    for_rows(out.height, [&](int y) {
        for (int k = -2; k <= 2; ++k)
            if (const int at = 2 * y + k; at >= 0 && at < from.height)
                for (int x = 0; x < out.width; ++x)
                    out.row(y)[x] += kBinomial[k + 2] * narrow.row(at)[x];
    });
    return out;
}

// The inverse of halving: a smooth curve near the values of the coarse level, by the same weights.
template <class T>
Plane<T> expanded(const Plane<T>& from, int width, int height) {
    const auto between = [](int x, int count, const auto& at) {
        const int i = std::min(x / 2, count - 1), next = std::min(i + 1, count - 1);
        if (x % 2 == 1)
            return 0.5f * (at(i) + at(next));
        return 0.75f * at(i) + 0.125f * (at(std::max(i - 1, 0)) + at(next));
    };
    Plane<T> wide(width, from.height), out(width, height);
    for_rows(wide.height, [&](int y) {
        for (int x = 0; x < width; ++x)
            wide.row(y)[x] = between(x, from.width, [&](int i) { return from.row(y)[i]; });
    });
    for_rows(height, [&](int y) {
        for (int x = 0; x < width; ++x)
            out.row(y)[x] = between(y, from.height, [&](int i) { return wide.row(i)[x]; });
    });
    return out;
}

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

// Of one of the band's pixels, which stands for `pixels` of the finest level.
ResidualEnergy energy_at(const Level& band, int x, int y, double pixels) {
    const Rgb &a = band.estimates[0].row(y)[x], &b = band.estimates[1].row(y)[x];
    const Rgb half = 0.5f * (a - b);
    const double square = band.square.row(y)[x], noise = pixels * square * glm::dot(half, half);
    // Of noise with a variance s of each estimate, a b has the variance s^2, and (a - b)^4 / 16 the mean 3 s^2 / 4.
    return {pixels * square * glm::dot(a, b), noise, 4.0 / 3.0 * noise * noise, pixels * square};
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
    ResidualBand sum{none, pixels > 1.0 ? kNoiseOfOverlap / kResidualOfOverlap : 1.0};
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
        gains.push_back(float(octave.gain(1.0, energy.noise_counts)));
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

std::vector<Level> pyramid(NoisyResidual residual) {
    std::vector<Level> levels(1);
    for (int k = 0; k < 2; ++k) {
        levels[0].estimates[k] = Plane<Rgb>(residual.width, residual.height);
        levels[0].estimates[k].values = std::move(residual.estimates[k]);
    }
    levels[0].weight = Plane<float>(residual.width, residual.height);
    levels[0].square = levels[0].weight;
    levels[0].weight.values = std::move(residual.weight);
    std::ranges::transform(levels[0].weight.values, levels[0].square.values.begin(), [](float w) { return w * w; });
    while (std::min(levels.back().weight.width, levels.back().weight.height) >= kCoarsest)
        levels.push_back(reduced(levels.back()));
    for (Level& level : levels)
        divide_by_weight(level);
    return levels;
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
    return residual > 0.0 ? std::max(residual - chance / residual, 0.0) : 0.0;
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
    return out;
}

double ResidualBand::left(double samples) const {
    double left = 0.0, noise = 0.0;
    for (const ResidualEnergy& octave : octaves) {
        const double gain = octave.gain(samples, noise_counts);
        left += (1.0 - gain) * (1.0 - gain) * octave.residual;
        noise += gain * gain * octave.noise / samples;
    }
    return std::max(left, 0.0) + noise;
}

double ResidualBand::gain() const {
    const double all = sum().residual;
    return all > 0.0 ? std::clamp(1.0 - left() / all, 0.0, 1.0) : 0.0;
}

SmoothResidual smooth_residual(NoisyResidual residual) {
    std::vector<Level> levels = pyramid(std::move(residual));
    SmoothResidual out;
    double pixels = 1.0;
    for (std::size_t k = 0; k < levels.size(); ++k, pixels *= 4.0) {
        if (k + 1 < levels.size())
            subtract(levels[k], levels[k + 1]);
        out.bands.push_back(energy_of(levels[k], pixels));
    }
    Plane<Rgb> sum(levels.back().weight.width, levels.back().weight.height);
    for (std::size_t k = levels.size(); k-- > 0;) {
        if (k + 1 < levels.size())
            sum = expanded(sum, levels[k].weight.width, levels[k].weight.height);
        add_band(sum, levels[k], out.bands[k]);
    }
    out.values = std::move(sum.values);
    for (std::size_t p = 0; p < out.values.size(); ++p)
        out.values[p] *= levels[0].weight.values[p];
    return out;
}

}  // namespace brisance
