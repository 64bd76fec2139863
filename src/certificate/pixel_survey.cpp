#include "certificate/pixel_survey.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/rng.h"

namespace brisance {

namespace {

// Pixels that may be drawn, along a Z-order curve through the picture.
class ZOrder {
public:
    ZOrder(const std::vector<double>& size, int width)
        : size_(size), columns_(std::size_t(width)), rows_(columns_ > 0 ? size.size() / columns_ : 0) {
        add_square(0, 0, std::bit_ceil(std::max(columns_, rows_)));
    }
    const std::vector<std::size_t>& pixels() const { return pixels_; }

private:
    void add_square(std::size_t x, std::size_t y, std::size_t side) {
        if (x >= columns_ || y >= rows_)
            return;
        if (side == 1) {
            if (size_[y * columns_ + x] > 0.0)
                pixels_.push_back(y * columns_ + x);
            return;
        }
        const std::size_t half = side / 2;
        for (const std::size_t down : {std::size_t{0}, half})
            for (const std::size_t right : {std::size_t{0}, half})
                add_square(x + right, y + down, half);
    }

    const std::vector<double>& size_;
    std::size_t columns_, rows_;
    std::vector<std::size_t> pixels_;
};

}  // namespace

PixelSurvey::PixelSurvey(const std::vector<double>& size, int width, std::size_t draws, std::uint64_t seed) {
    const ZOrder curve(size, width);
    const std::vector<std::size_t>& order = curve.pixels();
    std::vector<double> upto(order.size());
    double total = 0.0;
    for (std::size_t k = 0; k < order.size(); ++k)
        upto[k] = total += size[order[k]];
    if (!(total > 0.0))
        return;
    const std::size_t strata = (std::max<std::size_t>(draws, 2) + 1) / 2;
    for (std::size_t i = 0; i < 2 * strata; ++i) {
        Rng rng(Stream::Certificate, seed << 32 | i);
        const std::size_t stratum = i / 2;
        const double at = (static_cast<double>(stratum) + rng.next_double()) / static_cast<double>(strata) * total;
        // The first pixel whose running sum exceeds `at`; its size is never 0.
        auto found = std::upper_bound(upto.begin(), upto.end(), at);
        if (found == upto.end())
            found = std::lower_bound(upto.begin(), upto.end(), total);
        const std::size_t pixel = order[static_cast<std::size_t>(found - upto.begin())];
        draws_.push_back({pixel, total / (size[pixel] * 2.0 * static_cast<double>(strata))});
    }
}

SurveyedSums surveyed_sums(const std::vector<double>& a, const std::vector<double>& b) {
    SurveyedSums s;
    s.strata = a.size() / 2;
    double largest = 0.0, fourth = 0.0;
    for (std::size_t i = 0; i + 1 < a.size(); i += 2) {
        s.a += a[i] + a[i + 1];
        s.b += b[i] + b[i + 1];
        // The difference of two independent draws has the variance of their sum.
        const double da = a[i] - a[i + 1], db = b[i] - b[i + 1];
        s.aa += da * da;
        s.ab += da * db;
        s.bb += db * db;
        largest = std::max(largest, da * da);
        fourth += da * da * da * da;
    }
    s.largest_share = s.aa > 0.0 ? largest / s.aa : 0.0;
    // A third of the strata makes it, by that count, where differences are normally distributed: their fourth moment is
    // three times the square of the second.
    const double strata_that_make_it = fourth > 0.0 ? s.aa * s.aa / fourth : double(s.strata);
    s.degrees_of_freedom = std::min(double(s.strata), 3.0 * strata_that_make_it - 2.0);
    return s;
}

double half_width(std::size_t degrees_of_freedom) {
    constexpr double z = 1.959963984540054;
    const double nu = static_cast<double>(std::max<std::size_t>(degrees_of_freedom, 1));
    // The Cornish-Fisher expansion is within two thousandths from ten degrees of freedom on.
    return z + (z * z * z + z) / (4.0 * nu) + z * (5.0 * z * z * z * z + 16.0 * z * z + 3.0) / (96.0 * nu * nu);
}

}  // namespace brisance
