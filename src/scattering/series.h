// The sum of all orders of scattering on a coarse lattice.
//
// Orders are computed one by one while that pays: successive ones settle on the operator's first eigenvector, so that
// the tail becomes the geometric series of their ratio, colour by colour. Where light is scattered hundreds of times
// before it escapes, the ratio settles too slowly; the sum x is then the solution of x = first + K x, which Anderson
// mixing [1] finds from there: each step costs one bounce, and a window of them acts as GMRES does on a linear
// operator. The bounce is applied to sums of light, never to differences, so that its limiters (nothing turns negative)
// hold.
// [1] D. G. Anderson, Iterative Procedures for Nonlinear Integral Equations, Journal of the ACM 12(4), 1965;
//     H. Walker, P. Ni, Anderson Acceleration for Fixed-Point Iterations, SIAM J. Numer. Anal. 49(4), 2011.
#pragma once

#include <functional>

#include "gathering/settings.h"
#include "scattering/multiple_scattering.h"

namespace brisance {

// Hands every order's source function (light scattered twice, three times, ...) to `take`, what lies beyond the last
// of them as a whole at the end. Where settings.bounces is finite, exactly `single_orders` orders and no tail. Fills the
// series' part of `costs`.
void sum_orders(CoarseOperator& op, Departure first, const ScatteringSettings& settings, int single_orders,
                ScatteringCosts& costs, Progress& progress, const std::function<void(const NodeRadiance&)>& take);

}  // namespace brisance
