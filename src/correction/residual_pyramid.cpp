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

// A pixel of a level stands for so many of the finest. Summed in a fixed order.
ResidualBand energy_of(const Level& band, double pixels) {
    std::vector<ResidualBand> rows(std::size_t(band.square.height));
    for_rows(band.square.height, [&](int y) {
        for (int x = 0; x < band.square.width; ++x) {
            const Rgb &a = band.estimates[0].row(y)[x], &b = band.estimates[1].row(y)[x];
            const Rgb noise = 0.5f * (a - b);
            const double own = double(band.square.row(y)[x]) * glm::dot(noise, noise);
            rows[std::size_t(y)].residual += double(band.square.row(y)[x]) * glm::dot(a, b);
            rows[std::size_t(y)].noise += own;
            // Of noise with a variance s of each estimate, a b has the variance s^2, and (a - b)^4 / 16 the mean
            // 3 s^2 / 4.
            rows[std::size_t(y)].variance += 4.0 / 3.0 * own * own;
        }
    });
    ResidualBand sum;
    for (const ResidualBand& row : rows) {
        sum.residual += pixels * row.residual;
        sum.noise += pixels * row.noise;
        sum.variance += pixels * pixels * row.variance;
    }
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

// The error of the picture in a band, relative to its light there, if pixels err alike.
double relative_error(const Level& band, const ResidualBand& energy, double pixels) {
    std::vector<double> rows(std::size_t(band.square.height), 0.0);
    for_rows(band.square.height, [&](int y) {
        for (int x = 0; x < band.square.width; ++x)
            rows[std::size_t(y)] += double(band.square.row(y)[x]) * band.square.row(y)[x];
    });
    const double light = pixels * std::accumulate(rows.begin(), rows.end(), 0.0);
    return light > 0.0 ? std::sqrt(std::max(energy.residual, 0.0) / light) : 0.0;
}

// Samples have heavy tails: one bright path would leave a grain where the picture is dark. A pixel of a band is
// therefore taken to err by no more than a few times what all do, the less so the better the band is known.
void add_band(Plane<Rgb>& sum, const Level& band, const ResidualBand& energy, double pixels) {
    constexpr double kMost = 4.0;
    const double gain = energy.gain(), most = kMost * relative_error(band, energy, pixels) / (1.0 - gain);
    for_rows(sum.height, [&](int y) {
        for (int x = 0; x < sum.width; ++x) {
            const float weight = band.weight.row(y)[x];
            const Rgb known = 0.5f * float(gain) * (band.estimates[0].row(y)[x] + band.estimates[1].row(y)[x]);
            const float limit = weight > 0.0f ? float(most) * band.square.row(y)[x] / weight : 0.0f;
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

double ResidualBand::gain() const {
    return residual > 0.0 ? residual / (residual + noise) : 0.0;
}

double ResidualBand::left(double samples) const {
    return residual > 0.0 ? residual * noise / (samples * residual + noise) : 0.0;
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
        const Plane<float>& weight = levels[k].weight;
        if (k + 1 < levels.size())
            sum = expanded(sum, weight.width, weight.height);
        pixels /= 4.0;
        add_band(sum, levels[k], out.bands[k], pixels);
    }
    out.values = std::move(sum.values);
    for (std::size_t p = 0; p < out.values.size(); ++p)
        out.values[p] *= levels[0].weight.values[p];
    return out;
}

}  // namespace brisance
