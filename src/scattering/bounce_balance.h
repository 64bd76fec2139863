// Whether the energy of a flight is conserved: what is emitted collides or escapes, and both are measured apart.
//
// Collisions come from the fluence that was gathered, times the factor that it was scaled by. Escape comes from rays of
// a random stream of their own, drawn from the light itself. They share nothing with the rays and the table of
// collision probabilities that the factors are made from, so an operator that loses light, or a wrong table, shows as a
// sum that is not 1.
#pragma once

#include <vector>

#include "scattering/coarse_operator.h"

namespace brisance {

// Of one flight or of several together, as fractions of the power that they emit (luminance).
struct BounceBalance {
    int first_order = 0, last_order = 0;  // scatterings before the flights; 0 is the fire's own light
    double emitted = 0.0;                 // this power, relative to the stage's first flight
    double collided = 0.0;                // as gathered
    double scale = 1.0;                   // factor applied to what was gathered
    double escaped = 0.0;                 // measured by independent rays; what ends on surfaces counts, too
    double escaped_error = 0.0;           // its standard error
    double sum() const { return collided * scale + escaped; }  // 1, but for errors
};

// Part of the power (luminance) that leaves the medium or ends on a surface without a collision.
struct EscapeMeasurement {
    double fraction = 0.0;
    double standard_error = 0.0;
    std::size_t rays = 0;  // 0: there was no light
};

// Rays start at the lights in proportion to luminance, in random directions. `level`: the lights stand on the vertices
// of that level of the pyramid, and each is emitted by the fine nodes under its hat, in proportion to hat times
// extinction. `key`: other keys draw other random numbers. The standard error is the spread of independent batches.
EscapeMeasurement measure_escape(const ExtinctionPyramid& pyramid, int level, const ScatteredLight& lights,
                                 std::size_t rays, std::uint64_t key);

// The factor per colour that makes a gather at all nodes conserve energy: what rays say collides, over what was
// gathered. Where hardly any ray meets the medium, rays know the collisions worse than the gather does, and the factor
// stays nearer 1.
Rgb energy_balance_factor(const ExtinctionPyramid& pyramid, const ScatteredLight& lights,
                          const std::vector<Rgb>& fluence);

// What some nodes gathered themselves where others were interpolated.
struct GatheredPart {
    std::vector<float> share;  // per node, the part of its light that was gathered there, in [0, 1]; empty: all
    dvec3 power{0.0};          // collided_power() of that share of what was gathered
};

struct BalanceFactors {
    Rgb gathered{1.0f}, rest{1.0f};
};

// The factors of what was gathered and of the rest, which err differently: rays count the collisions of the gathered
// part by themselves. Fills all of `balance` but its orders and `emitted`.
BalanceFactors energy_balance_factors(const ExtinctionPyramid& pyramid, const ScatteredLight& lights,
                                      const std::vector<Rgb>& fluence, const GatheredPart& gathered,
                                      BounceBalance& balance);

// Sums the power of the flights of a series, to measure all of them by one set of rays.
class SeriesBalance {
public:
    // A flight of `lights`, and the light that it scatters.
    void add(const ScatteredLight& lights, const FlightPower& flight, const ScatteredLight& scattered);
    bool empty() const { return flights_ == 0; }
    int flights() const { return flights_; }

    // As measure_escape. Collisions are the light that was scattered and what was absorbed.
    BounceBalance measure(const ExtinctionPyramid& pyramid, int level, std::size_t rays) const;

private:
    int flights_ = 0;
    ScatteredLight emitted_;
    double first_ = 0.0, gathered_ = 0.0, collided_ = 0.0;  // luminance, over 4 pi [W/sr]
};

}  // namespace brisance
