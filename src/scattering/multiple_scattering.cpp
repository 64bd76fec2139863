#include "scattering/multiple_scattering.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "lighting_grid/light_clusters.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/phase.h"
#include "medium/sh.h"
#include "scattering/coarse_operator.h"

namespace brisance {

namespace {

constexpr std::size_t kSeriesEscapeRays = std::size_t{1} << 16;
constexpr int kMostBounces = 96;
constexpr double kDark = 1e-6;  // of the power scattered once: bounces below it are left to the tail

// What is known of the bounces still to come, colour by colour: the geometric series of the last ratio of successive
// bounces' power, and how much of it the drift of that ratio leaves unknown.
class SeriesTail {
public:
    explicit SeriesTail(const ScatteredLight& first) : last_(total(first.intensity)), sum_(last_) {}

    void add(const ScatteredLight& bounce) {
        const dvec3 now = total(bounce.intensity);
        before_last_drift_ = drift_;
        for (int c = 0; c < 3; ++c) {
            const double ratio = last_[c] > 0.0 ? now[c] / last_[c] : 0.0;
            drift_[c] = std::abs(ratio - ratio_[c]);
            ratio_[c] = ratio;
        }
        last_ = now;
        sum_ += now;
    }

    double ratio() const { return std::max({ratio_.x, ratio_.y, ratio_.z}); }

    // Of the last bounce's light: the sum of all that follow.
    dvec3 factor() const {
        dvec3 f(0.0);
        for (int c = 0; c < 3; ++c)
            if (ratio_[c] > 0.0 && ratio_[c] < 1.0)
                f[c] = ratio_[c] / (1.0 - ratio_[c]);
        return f;
    }

    // Of the scattered power (luminance), that of the bounces still to come.
    double share() const {
        const double tail = luminance(Rgb(factor() * last_));
        return tail > 0.0 ? tail / (luminance(Rgb(sum_)) + tail) : 0.0;
    }

    // Of each colour's power, what is unknown; the worst. By chance a ratio can stand still for once, so that the
    // larger of its last two steps counts.
    double remainder() const {
        double worst = 0.0;
        for (int c = 0; c < 3; ++c) {
            const double room = std::max(1.0 - ratio_[c], 1e-6);
            const double drift = std::max(drift_[c], before_last_drift_[c]);
            if (sum_[c] > 0.0)
                worst = std::max(worst, last_[c] * drift / (room * room) / sum_[c]);
        }
        return worst;
    }

private:
    dvec3 last_, sum_;
    dvec3 ratio_{0.0}, drift_{0.0}, before_last_drift_{1.0};
};

// Runs the series on the coarse lattice and hands every order's light (scattered twice, three times, ...) to `take`,
// the extrapolated tail last. `bounces`: how many are computed one by one; 0: as the settings say.
template <class Take>
void run_series(CoarseOperator& op, const ScatteredLight& first, const ScatteringSettings& settings, int bounces,
                SeriesBalance& balance, ScatteringCosts& costs, Progress& progress, const Take& take) {
    const bool endless = settings.bounces < 0;
    const int wanted = bounces > 0 ? bounces : endless ? kMostBounces : settings.bounces - 2;
    const double start = total_luminance(first.intensity);
    ScatteredLight lights = first;
    SeriesTail tail(first);
    for (double left = start; costs.bounces < wanted && left > (endless ? kDark * start : 0.0);) {
        FlightPower flight;
        ScatteredLight scattered = op.bounce(lights, flight, costs.levels, progress);
        balance.add(lights, flight, scattered);
        lights = std::move(scattered);
        left = total_luminance(lights.intensity);
        tail.add(lights);
        take(lights, Rgb(1.0f));
        ++costs.bounces;
        if (!endless)
            continue;
        costs.remainder = tail.remainder();
        progress.fraction(std::min(1.0, settings.remainder / std::max(costs.remainder, 1e-9)));
        if (bounces == 0 && costs.remainder < settings.remainder)
            break;
    }
    costs.tail_ratio = tail.ratio();
    if (!endless || tail.share() == 0.0)
        return;
    costs.tail_share = tail.share();
    take(lights, Rgb(tail.factor()));
}

// The series on one level's lattice: light scattered twice or more often, one entry in all or one per order. `once`:
// light scattered once. `bounces` as above.
std::vector<ScatteredLight> solve_series(const ScatteringInput& input, const ScatteredLight& once, int level,
                                         int bounces, ScatteringCosts& costs, Progress& progress) {
    const ExtinctionPyramid& pyramid = *input.pyramid;
    const Medium& medium = pyramid.medium();
    Stopwatch watch;
    CoarseOperator op(pyramid, level, input.lighting, input.settings);
    costs.lattice_level = level;
    costs.coarse_nodes = op.active_nodes();
    if (op.cascades())
        costs.cascades = op.cascades()->counts();
    costs.operator_seconds = watch.seconds();

    watch = Stopwatch();
    const ScatteredLight first = op.restricted(once, medium.lattice);
    ScatteredLight sum = first;
    sum.add(first, Rgb(-1.0f));
    std::vector<ScatteredLight> orders;
    SeriesBalance balance;
    run_series(op, first, input.settings, bounces, balance, costs, progress,
               [&](const ScatteredLight& light, const Rgb& factor) {
                   if (!input.separate_orders)
                       return sum.add(light, factor);
                   ScatteredLight scaled = light;
                   scaled.add(light, factor - 1.0f);
                   orders.push_back(op.spread_to_fine(scaled, medium));
               });
    if (!input.separate_orders)
        orders.push_back(op.spread_to_fine(sum, medium));
    costs.series_seconds = watch.seconds();
    if (input.lighting.energy_balance && !balance.empty())
        costs.balance = balance.measure(pyramid, level, kSeriesEscapeRays);
    costs.bytes = op.bytes();
    return orders;
}

// The same by diffusion.
std::vector<ScatteredLight> solve_diffusion(const ScatteringInput& input, const ScatteredLight& once, int level,
                                            ScatteringCosts& costs) {
    const Stopwatch watch;
    DiffusionSettings settings;
    settings.flux_limiter = input.settings.flux_limiter;
    DiffusedLight diffused = diffused_light(*input.pyramid, level, once, settings);
    costs.lattice_level = level;
    costs.coarse_nodes = diffused.nodes;
    costs.diffusion = diffused.counts;
    costs.series_seconds = watch.seconds();
    costs.bytes = diffused.bytes;
    return {std::move(diffused.light)};
}

std::vector<ScatteredLight> solve(const ScatteringInput& input, const ScatteredLight& once, int level, int bounces,
                                  ScatteringCosts& costs, Progress& progress) {
    return input.settings.solver == ScatteringSolver::Diffusion
               ? solve_diffusion(input, once, level, costs)
               : solve_series(input, once, level, bounces, costs, progress);
}

// Moves `share` of the light of `orders` to that of a second solution.
void blend_orders(std::vector<ScatteredLight>& orders, const std::vector<ScatteredLight>& other, float share) {
    for (ScatteredLight& order : orders)
        order.add(order, Rgb(-share));
    for (std::size_t k = 0; k < other.size(); ++k)
        if (k < orders.size()) {
            orders[k].add(other[k], Rgb(share));
        } else {
            orders.push_back(other[k]);
            orders[k].add(other[k], Rgb(share - 1.0f));
        }
}

}  // namespace

std::vector<Rgb> fluence_at_nodes(const Gathered& gathered, const std::vector<std::uint8_t>& mask) {
    const std::size_t n = mask.size();
    std::vector<Rgb> fluence(n, Rgb(0.0f));
    parallel_for(
        n,
        [&](std::size_t i) {
            if (mask[i])
                fluence[i] = {gathered.fluence[i], gathered.fluence[n + i], gathered.fluence[2 * n + i]};
        },
        4096);
    return fluence;
}

void prepare_interpolation(const BrickLattice& lattice, const std::vector<std::uint8_t>& mask, Gathered& gathered) {
    for (const std::span<float> plane : gathered.planes())
        sharpen_interpolant(lattice, mask, plane);
    for (auto* field : {&gathered.fluence, &gathered.scattered})
        for (float& v : *field)
            v = std::max(v, 0.0f);
}

std::vector<ScatteredLight> solve_scattering(const ScatteringInput& input, ScatteringCosts& costs, Progress& progress) {
    std::vector<ScatteredLight> orders{*input.once};
    if (input.settings.bounces == 2 || !(total_luminance(orders[0].intensity) > 0.0))
        return orders;

    const LatticeChoice& lattice = input.lattice;
    std::vector<ScatteredLight> further = solve(input, orders[0], lattice.level, 0, costs, progress);
    if (lattice.share_of_coarser > 0.0f) {
        ScatteringCosts coarser;
        blend_orders(further, solve(input, orders[0], lattice.level + 1, costs.bounces, coarser, progress),
                     lattice.share_of_coarser);
        costs.share_of_coarser = lattice.share_of_coarser;
        costs.operator_seconds += coarser.operator_seconds;
        costs.series_seconds += coarser.series_seconds;
        if (coarser.diffusion && !coarser.diffusion->converged)
            costs.diffusion = coarser.diffusion;
    }
    if (!input.separate_orders)
        orders[0].add(further[0], Rgb(1.0f));
    else
        std::move(further.begin(), further.end(), std::back_inserter(orders));
    return orders;
}

LightField HierarchyLights::field(const ExtinctionPyramid& pyramid, float alpha, const LightingSettings& settings,
                                  ShadowMapCache* cache) const {
    LightField field{&pyramid,
                     &light.intensity,
                     light.directional.empty() ? nullptr : &light.directional,
                     &grid,
                     &weight,
                     alpha,
                     settings,
                     cache,
                     pyramid.occluders()};
    if (of_lamps) {
        field.intensity = nullptr;
        field.directional = nullptr;
        field.bottom = grid.levels.front().level;
    }
    return field;
}

HierarchyLights build_hierarchy(const Medium& medium, ScatteredLight light, int levels) {
    HierarchyLights h;
    h.light = std::move(light);
    h.weight.resize(h.light.intensity.size());
    for (std::size_t i = 0; i < h.weight.size(); ++i)
        h.weight[i] = luminance(h.light.intensity[i]);
    h.grid = build_lighting_grid(medium, h.light.intensity, &h.weight, levels > 0 ? levels : automatic_levels(medium));
    if (!h.light.directional.empty())
        set_intensity(h.grid, medium.lattice, h.light.intensity, &h.light.directional);
    return h;
}

HierarchyLights build_lamps(const Medium& medium, ScatteredLight light, int lamps) {
    HierarchyLights h;
    h.light = std::move(light);
    h.weight.assign(h.light.intensity.size(), 0.0f);
    h.grid.levels.push_back(cluster_lights(medium, h.light.intensity, lamps));
    h.of_lamps = true;
    return h;
}

}  // namespace brisance
