#include "scattering/multiple_scattering.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/parallel.h"
#include "gathering/sh.h"
#include "lights/voxel_lights.h"
#include "medium/phase.h"
#include "scattering/coarse_operator.h"

namespace brisance {

namespace {

constexpr std::size_t kEscapeRays = std::size_t{1} << 18;
constexpr int kMostBounces = 96;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double power(const std::vector<Rgb>& lights) {
    return luminance(Rgb(total(lights)));
}

// Level on which the series is solved: the finest with at most this many nodes that scatter.
constexpr std::size_t kMostCoarseNodes = 120000;

int choose_level(const ExtinctionPyramid& pyramid, int wish) {
    const int last = pyramid.level_count() - 1;
    if (wish >= 0)
        return std::min(wish, last);
    int level = 0;
    const auto lit = [&](int l) {
        const auto& nodes = pyramid.nodes(l);
        return std::size_t(std::count_if(nodes.begin(), nodes.end(), [](float e) { return e > 0.0f; }));
    };
    while (level < last && lit(level) > kMostCoarseNodes)
        ++level;
    return level;
}

// Runs the series on the coarse lattice and hands every order's light (scattered twice, three times, ...) to `take`,
// the extrapolated tail last.
template <class Take>
void run_series(CoarseOperator& op, const ScatteredLight& first, const ScatteringSettings& settings,
                ScatteringCosts& costs, Progress& progress, const Take& take) {
    ScatteredLight lights = first;
    const double start = power(first.intensity);
    double previous = start, ratio = 0.0, sum = start;
    const int wanted = settings.bounces < 0 ? kMostBounces : settings.bounces - 2;
    for (int k = 0; k < wanted && previous > 0.0; ++k) {
        BounceBalance balance;
        balance.order = k + 1;
        balance.emitted = previous / start;
        lights = op.bounce(lights, balance, costs.levels, progress);
        costs.balances.push_back(balance);
        take(lights, 1.0f);
        ++costs.bounces;
        const double now = power(lights.intensity);
        const double drift = std::abs(now / previous - ratio);
        ratio = now / previous;
        previous = now;
        sum += now;
        if (settings.bounces >= 0)
            continue;
        // The tail is now * ratio / (1 - ratio); a ratio still drifting leaves about this much of it unknown.
        const double room = std::max(1.0 - ratio, 1e-6);
        costs.remainder = now * drift / (room * room) / sum;
        progress.fraction(std::min(1.0, settings.remainder / std::max(costs.remainder, 1e-9)));
        if (costs.remainder < settings.remainder || now < 1e-6 * start)
            break;
    }
    costs.tail_ratio = ratio;
    if (settings.bounces < 0 && ratio > 0.0 && ratio < 1.0) {
        const double tail = ratio / (1.0 - ratio);
        costs.tail_share = tail * previous / (sum + tail * previous);
        take(lights, static_cast<float>(tail));
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
    const std::size_t n = mask.size();
    for (auto* field : {&gathered.fluence, &gathered.scattered, &gathered.moments})
        for (std::size_t c = 0; c * n < field->size(); ++c)
            sharpen_interpolant(lattice, mask, std::span<float>(*field).subspan(c * n, n));
    for (auto* field : {&gathered.fluence, &gathered.scattered})
        for (float& v : *field)
            v = std::max(v, 0.0f);
}

Rgb close_balance(const ExtinctionPyramid& pyramid, const std::vector<Rgb>& lights, const std::vector<Rgb>& fluence,
                  BounceBalance& balance) {
    const EscapeEstimate escape = estimate_escape(pyramid, lights, kEscapeRays);
    const dvec3 emitted = total(lights);
    const dvec3 hit = collided(pyramid.medium(), fluence);
    const double y = luminance(Rgb(emitted));
    balance.collided = y > 0.0 ? luminance(Rgb(hit)) / y : 0.0;
    balance.escaped = y > 0.0 ? luminance(Rgb(escape.fraction * emitted)) / y : 0.0;
    balance.escape_error = escape.standard_error;
    balance.scale = balance.collided > 0.0 ? (1.0 - balance.escaped) / balance.collided : 1.0;
    Rgb scale(1.0f);
    for (int c = 0; c < 3; ++c)
        if (hit[c] > 0.0)
            scale[c] = static_cast<float>((1.0 - escape.fraction[c]) * emitted[c] / hit[c]);
    return scale;
}

std::vector<ScatteredLight> solve_scattering(const ScatteringInput& input, ScatteringCosts& costs, Progress& progress) {
    const ExtinctionPyramid& pyramid = *input.pyramid;
    const Medium& medium = pyramid.medium();
    std::vector<ScatteredLight> orders;
    orders.push_back(scattered_light(medium, *input.first, *input.needed));
    if (input.settings.bounces == 2 || !(power(orders[0].intensity) > 0.0))
        return orders;

    auto start = std::chrono::steady_clock::now();
    costs.lattice_level = choose_level(pyramid, input.settings.lattice_level);
    CoarseOperator op(pyramid, costs.lattice_level, input.lighting, input.settings.alpha);
    costs.coarse_nodes = op.active_nodes();
    costs.operator_seconds = seconds_since(start);

    start = std::chrono::steady_clock::now();
    const ScatteredLight first = op.restricted(orders[0], medium.lattice);
    ScatteredLight sum = first;
    sum.add(first, -1.0f);
    run_series(op, first, input.settings, costs, progress, [&](const ScatteredLight& light, float factor) {
        if (!input.separate_orders)
            return sum.add(light, factor);
        ScatteredLight scaled = light;
        scaled.add(light, factor - 1.0f);
        orders.push_back(op.spread_to_fine(scaled, medium));
    });
    if (!input.separate_orders)
        orders[0].add(op.spread_to_fine(sum, medium), 1.0f);
    costs.series_seconds = seconds_since(start);
    costs.bytes = op.bytes();
    return orders;
}

LightField HierarchyLights::field(const ExtinctionPyramid& pyramid, float alpha, const LightingSettings& settings,
                                  ShadowMapCache* cache) const {
    return {&pyramid,
            &light.intensity,
            light.directional.empty() ? nullptr : &light.directional,
            &grid,
            &weight,
            alpha,
            settings,
            cache};
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

}  // namespace brisance
