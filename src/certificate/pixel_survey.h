// Estimates sums over all pixels of a picture from a few pixels drawn at random: survey sampling.
//
// Pixels are drawn in proportion to a size that should resemble the summed quantity, two in each of many strata. A
// drawn value is weighted by the inverse of its probability (Hansen and Hurwitz, On the Theory of Sampling from Finite
// Populations, 1943). Nothing is assumed of the values, so neither the estimates nor their variances have a bias.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace brisance {

// Strata are stretches of equal size along a Z-order curve through the picture, because neighbours are alike.
class PixelSurvey {
public:
    struct Draw {
        std::size_t pixel;
        double weight;  // one over the expected number of draws of the pixel
    };

    // `size`: at least 0, one for each pixel; pixels of size 0 are never drawn. `draws` is made even.
    PixelSurvey(const std::vector<double>& size, int width, std::size_t draws, std::uint64_t seed);

    // Draws 2 h and 2 h + 1 belong to stratum h and are independent of each other and of all others. There are none
    // when all sizes are 0.
    const std::vector<Draw>& draws() const { return draws_; }

private:
    std::vector<Draw> draws_;
};

// Two quantities summed over the pixels, from their values at a survey's draws, weights included.
struct SurveyedSums {
    double a = 0.0, b = 0.0;
    double aa = 0.0, ab = 0.0, bb = 0.0;  // variances and covariance of the sums
    std::size_t strata = 0;
    double largest_share = 0.0;  // of `aa`, the greatest from one stratum
    // Of `aa`, about: `strata` where differences are normally distributed, down to 1 where one stratum makes all of it.
    // After F. E. Satterthwaite, An Approximate Distribution of Estimates of Variance Components, Biometrics 1946, such
    // that both ends are right.
    double degrees_of_freedom = 0.0;
};

SurveyedSums surveyed_sums(const std::vector<double>& a, const std::vector<double>& b);

struct Interval {
    double low = 0.0;
    double high = 0.0;
};

// The probability with which an interval holds the truth, as far as sums over many draws are normally distributed. Half
// the interval's width, in standard errors, is a quantile of Student's t.
constexpr double kConfidence = 0.95;
double half_width(std::size_t degrees_of_freedom);

}  // namespace brisance
