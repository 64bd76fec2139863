#include "forecast/mean_escape.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "scattering/escape_rays.h"

namespace brisance {

namespace {

constexpr std::size_t kRays = 2048;

// The additive recurrence in five dimensions that spreads best: negative powers of the root of x^6 = x + 1 (Roberts).
constexpr std::array<double, 5> kRecurrence = {0.8812714616335696, 0.7766393890897682, 0.6844301295853426,
                                               0.6031687406857282, 0.5315553977157913};

double spread(std::size_t ray, int dimension) {
    const double x = 0.5 + double(ray + 1) * kRecurrence[dimension];
    return x - std::floor(x);
}

// A node's share of a trilinear field lies under its hat: distributed as 1 - |x| on [-1, 1].
double under_hat(double u) {
    return u < 0.5 ? std::sqrt(2.0 * u) - 1.0 : 1.0 - std::sqrt(2.0 * (1.0 - u));
}

std::vector<float> scattering_coefficients(const Medium& medium) {
    std::vector<float> out(medium.extinction.size());
    parallel_for(
        out.size(),
        [&](std::size_t i) {
            out[i] = medium.extinction[i] > 0.0f ? medium.extinction[i] * luminance(medium.albedo_at(i)) : 0.0f;
        },
        4096);
    return out;
}

}  // namespace

double mean_escape(const Medium& medium) {
    const std::vector<std::size_t> starts = systematic_picks(scattering_coefficients(medium), kRays);
    if (starts.empty())
        return 1.0;
    const ExtinctionPyramid pyramid(medium, 1);
    EscapeRays rays(pyramid, nullptr, starts.size());
    for (std::size_t r = 0; r < starts.size(); ++r) {
        const vec3 offset(under_hat(spread(r, 0)), under_hat(spread(r, 1)), under_hat(spread(r, 2)));
        rays.set(r, vec3(medium.lattice.node(starts[r]) - medium.reference_node) + offset,
                 uniform_sphere_direction(spread(r, 3), spread(r, 4)));
    }
    const std::vector<float> collided = rays.collision_probabilities();
    double sum = 0.0;
    for (std::size_t r = 0; r < starts.size(); ++r)
        sum += 1.0 - collided[r];
    return sum / double(starts.size());
}

}  // namespace brisance
