// The radius of a blur that shrinks from pass to pass, so that both bias and noise vanish in the mean of many passes
// (Knaus and Zwicker, Progressive Photon Mapping: A Probabilistic Approach, TOG 2011).
//
// An estimate that is blurred over k dimensions has a variance like r^-k. With r_{i+1}^k = r_i^k (i + alpha) / (i + 1)
// the variance of the mean over n passes vanishes like n^-alpha, and its bias, which grows like r^2, like
// n^(2 (alpha - 1) / k). The sum of variance and squared bias falls fastest where both fall alike: n^(-4 / (4 + k)).
#pragma once

namespace brisance {

// Ratio of the radius of a pass, counted from 0, to that of the first. `alpha` in (0, 1].
double radius_shrunk(int pass, double alpha, int blurred_dimensions = 2);

// The alpha for which variance and squared bias fall alike.
double fastest_alpha(int blurred_dimensions);

}  // namespace brisance
