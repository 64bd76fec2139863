// How the diffusion equation is closed and when its solution is good enough.
#pragma once

namespace brisance {

struct DiffusionSettings {
    // Whether the flux is limited to what light can carry, |F| <= fluence. Without, a constant of diffusion is only
    // bounded by a mean free path of the medium's diagonal.
    bool flux_limiter = true;
    double tolerance = 1e-5;        // Convergence::residual
    double first_tolerance = 1e-3;  // the same, before the limiter has settled
    int most_iterations = 200;      // of conjugate gradients, for one colour and one limiter
    double most_change = 1e-3;      // of the fluence by the last limiter, root mean square over root mean square
    int most_limiters = 30;
};

}  // namespace brisance
