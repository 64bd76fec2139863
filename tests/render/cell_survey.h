// How far a picture is from the truth, cell by cell of the ledger, as several independent surveys of unbiased paths
// estimate it.
//
// As in certificate/certify.h, two independent paths x and y of a pixel have the pixel's true value R as their mean, so
// that (I - x)(I - y) has the mean (I - R)^2: the paths' own noise adds nothing to the error. Certificates divide by
// the cell's own truth; here sums are kept as they are, so that a cell that is nearly black can be judged as a part of
// the picture, and several cells together.
#pragma once

#include <string>
#include <vector>

#include "film/image.h"
#include "forecast/plan.h"
#include "render/input/frame_input.h"

namespace brisance::testing {

// Sums over all pixels and channels of a picture I and the truth R: in units of radiance, and of radiance squared.
struct CellSums {
    double difference = 0.0;          // of I - R
    double truth = 0.0;               // of R
    double squared_difference = 0.0;  // of (I - R)^2; below 0 by chance
    double squared_truth = 0.0;       // of R^2

    CellSums& operator+=(const CellSums& other);  // of the layers: no squares of sums
};

struct Measurement {
    double value = 0.0;
    double error = 0.0;  // standard error over the surveys
};

// a / b with the standard error of a ratio of means over independent pairs. Infinite where b is not above 0.
Measurement ratio_of(const std::vector<double>& a, const std::vector<double>& b);

class CellSurvey {
public:
    static constexpr int kSurveys = 8;

    // `picture` has the beauty and a layer for each of `cells`. `samples`: about as many paths as one survey
    // traces, spread over the pixels by what `picture` shows there; a black pixel has a few. The same numbers for any
    // number of threads.
    CellSurvey(const FrameInput& input, const Shot& shot, const Image& picture, std::vector<std::string> cells,
               int samples);

    // Of one cell, or of the picture: "". One entry for each survey.
    const std::vector<CellSums>& of(const std::string& cell) const;

    // Mean error of these cells together, as a part of their truth.
    Measurement mean_error(const std::vector<std::string>& cells) const;

    // Of one cell as a part of `whole`'s truth: mean error, and squared error (rRMSE^2).
    Measurement mean_error(const std::string& cell, const std::string& whole) const;
    Measurement squared_error(const std::string& cell, const std::string& whole) const;

    // Of the truth's mean, as a part of the picture's.
    double share(const std::string& cell) const;

private:
    std::vector<std::string> targets_;         // the picture and its cells
    std::vector<std::vector<CellSums>> sums_;  // by target and survey
};

}  // namespace brisance::testing
