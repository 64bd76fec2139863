#include "scattering/bounce_balance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/rng.h"
#include "lighting_grid/footprint.h"
#include "lighting_grid/voxel_lights.h"
#include "scattering/balance.h"
#include "scattering/escape_rays.h"

namespace brisance {

namespace {

constexpr std::size_t kEscapeBatches = 32;
constexpr std::size_t kCollisionRays = std::size_t{1} << 16;
constexpr std::size_t kEscapeRays = std::size_t{1} << 15;
constexpr double kGatherError = 0.03;  // of a gather's collisions, typically
constexpr int kStarts = 64;            // nodes that stand for a hat
// Sets the random numbers of measurements apart from those of the table, whose keys do without this bit.
constexpr std::uint64_t kMeasurement = std::uint64_t{1} << 63;

// Inverse-variance weight of the rays' estimate against the gather's, where the two differ by `difference`, relative: a
// gather errs by some percent, or by what the rays' noise does not explain.
double weight_of_rays(double difference, double noise) {
    const double variance = std::max(kGatherError * kGatherError, difference * difference - 4.0 * noise * noise);
    return variance / (variance + noise * noise);
}

// What rays say collides over what was gathered, per colour.
Rgb factor_of(const CollisionEstimate& marched, const dvec3& emitted, const dvec3& gathered) {
    const double y = luminance(Rgb(emitted));
    Rgb factor(1.0f);
    if (!(y > 0.0))
        return factor;
    const double collided = luminance(Rgb(gathered)) / y, expected = luminance(Rgb(marched.fraction * emitted)) / y;
    if (!(collided > 0.0) || !(expected > 0.0))
        return factor;
    const double weight = weight_of_rays(collided / expected - 1.0, marched.standard_error / expected);
    for (int c = 0; c < 3; ++c)
        if (gathered[c] > 0.0)
            factor[c] = static_cast<float>(1.0 + weight * (marched.fraction[c] * emitted[c] / gathered[c] - 1.0));
    return factor;
}

// A ray from a light.
struct Start {
    std::size_t light;
    vec3 direction;  // unit, of local space
};

// One batch of rays: systematic over the lights from a random offset, in directions of Roberts' sequence from a random
// one. Every ray by itself is distributed as one that is drawn at random.
std::vector<Start> draw_batch(const std::vector<double>& cumulative, std::size_t rays, Rng& rng) {
    const double offset = rng.next_double(), turn_u = rng.next_double(), turn_v = rng.next_double();
    std::vector<Start> starts;
    std::size_t light = 0;
    for (std::size_t r = 0; r < rays; ++r) {
        const double goal = (double(r) + offset) / double(rays) * cumulative.back();
        while (light + 1 < cumulative.size() && cumulative[light] <= goal)
            ++light;
        starts.push_back({light, uniform_sphere_direction(glm::fract(turn_u + double(r) * 0.7548776662466927),
                                                          glm::fract(turn_v + double(r) * 0.5698402909980532))});
    }
    return starts;
}

// Part of the batch's luminance that escapes, over the batch's number of rays.
double escaping_part(const ExtinctionPyramid& pyramid, int level, const ScatteredLight& lights,
                     const std::vector<Start>& starts, Rng& rng) {
    const Medium& medium = pyramid.medium();
    const BrickLattice& lattice = pyramid.lattice(level);
    EscapeRays rays(pyramid, pyramid.occluders(), starts.size());
    FootprintPicker picker(medium, medium.extinction, level);
    std::vector<ivec3> nodes;
    for (std::size_t r = 0; r < starts.size(); ++r) {
        if (r == 0 || starts[r].light != starts[r - 1].light) {
            const ivec3 vertex = lattice.node(starts[r].light);
            nodes = nodes_of_vertex(picker, vertex, level, kStarts);
        }
        const auto pick = std::min(nodes.size() - 1, std::size_t(rng.next_double() * double(nodes.size())));
        rays.set(r, vec3(nodes[pick] - medium.reference_node), starts[r].direction);
    }
    const std::vector<float> collided = rays.collision_probabilities();
    double sum = 0.0;
    for (std::size_t r = 0; r < starts.size(); ++r) {
        const dvec3 toward =
            directional_intensity(lights.intensity, lights.directional, starts[r].light, starts[r].direction);
        sum += luminance(Rgb(toward)) / luminance(lights.intensity[starts[r].light]) * (1.0 - collided[r]);
    }
    return sum / double(starts.size());
}

}  // namespace

EscapeMeasurement measure_escape(const ExtinctionPyramid& pyramid, int level, const ScatteredLight& lights,
                                 std::size_t rays, std::uint64_t key) {
    std::vector<double> cumulative(lights.intensity.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < cumulative.size(); ++i)
        cumulative[i] = sum += std::max(0.0f, luminance(lights.intensity[i]));
    const std::size_t per_batch = rays / kEscapeBatches;
    if (!(sum > 0.0) || per_batch == 0)
        return {};
    std::array<double, kEscapeBatches> batches{};
    parallel_for(kEscapeBatches, [&](std::size_t b) {
        Rng rng(Stream::EscapeRay, kMeasurement | key, b);
        batches[b] = escaping_part(pyramid, level, lights, draw_batch(cumulative, per_batch, rng), rng);
    });
    EscapeMeasurement measured;
    measured.rays = per_batch * kEscapeBatches;
    measured.fraction = std::accumulate(batches.begin(), batches.end(), 0.0) / kEscapeBatches;
    double square = 0.0;
    for (const double b : batches)
        square += (b - measured.fraction) * (b - measured.fraction);
    measured.standard_error = std::sqrt(square / (kEscapeBatches - 1.0) / kEscapeBatches);
    return measured;
}

Rgb energy_balance_factor(const ExtinctionPyramid& pyramid, const ScatteredLight& lights,
                          const std::vector<Rgb>& fluence) {
    return factor_of(estimate_collisions(pyramid, lights.intensity, lights.directional, kCollisionRays),
                     total(lights.intensity), collided_power(pyramid.medium(), fluence));
}

BalanceFactors energy_balance_factors(const ExtinctionPyramid& pyramid, const ScatteredLight& lights,
                                      const std::vector<Rgb>& fluence, const GatheredPart& gathered,
                                      BounceBalance& balance) {
    const dvec3 emitted = total(lights.intensity), collided = collided_power(pyramid.medium(), fluence);
    const double y = luminance(Rgb(emitted));
    if (!(y > 0.0))
        return {};
    const EscapeMeasurement escape = measure_escape(pyramid, 0, lights, kEscapeRays, 0);
    balance.collided = luminance(Rgb(collided)) / y;
    balance.escaped = escape.fraction;
    balance.escaped_error = escape.standard_error;
    BalanceFactors factors;
    Rgb all;
    if (gathered.share.empty()) {
        factors.gathered = factors.rest = all = energy_balance_factor(pyramid, lights, fluence);
    } else {
        const PartlyCollided marched =
            estimate_collisions(pyramid, lights.intensity, lights.directional, kCollisionRays, gathered.share);
        all = factor_of(marched.all, emitted, collided);
        factors.gathered = factor_of(marched.part, emitted, gathered.power);
        const dvec3 here = collided_power(pyramid.medium(), fluence, gathered.share);
        for (int c = 0; c < 3; ++c)
            if (const double rest = collided[c] - here[c]; rest > 0.0)
                factors.rest[c] = float(std::max(0.0, (all[c] * collided[c] - factors.gathered[c] * here[c]) / rest));
    }
    if (balance.collided > 0.0)
        balance.scale = luminance(Rgb(dvec3(all) * collided)) / luminance(Rgb(collided));
    return factors;
}

void SeriesBalance::add(const ScatteredLight& lights, const FlightPower& flight, const ScatteredLight& scattered) {
    if (flights_++ == 0) {
        emitted_ = lights;
        first_ = total_luminance(lights.intensity);
    } else {
        emitted_.add(lights, Rgb(1.0f));
    }
    gathered_ += luminance(Rgb(flight.gathered));
    collided_ += total_luminance(scattered.intensity) + luminance(Rgb(flight.absorbed));
}

BounceBalance SeriesBalance::measure(const ExtinctionPyramid& pyramid, int level, std::size_t rays) const {
    BounceBalance balance;
    balance.first_order = 1;
    balance.last_order = flights_;
    const double y = total_luminance(emitted_.intensity);
    if (!(y > 0.0))
        return balance;
    const EscapeMeasurement escape = measure_escape(pyramid, level, emitted_, rays, 1);
    balance.emitted = y / first_;
    balance.collided = gathered_ / y;
    balance.scale = gathered_ > 0.0 ? collided_ / gathered_ : 1.0;
    balance.escaped = escape.fraction;
    balance.escaped_error = escape.standard_error;
    return balance;
}

}  // namespace brisance
