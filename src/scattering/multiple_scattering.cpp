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

double power(const std::vector<Rgb>& lights) { return luminance(Rgb(total(lights))); }

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

// The sum of orders that leaves for the camera, and how it was reached.
ScatteredLight sum_series(CoarseOperator& op, const ScatteredLight& first, const ScatteringSettings& settings,
                          ScatteringCosts& costs, Progress& progress) {
    ScatteredLight sum = first;
    ScatteredLight lights = first;
    const double start = power(first.intensity);
    double previous = start, ratio = 0.0, drift = 1.0;
    const int wanted = settings.bounces < 0 ? kMostBounces : settings.bounces - 2;
    for (int k = 0; k < wanted && previous > 0.0; ++k) {
        BounceBalance balance;
        balance.order = k + 1;
        balance.emitted = previous / start;
        lights = op.bounce(lights, balance, costs.series_levels, progress);
        costs.balances.push_back(balance);
        sum.add(lights, 1.0f);
        ++costs.bounces;
        const double now = power(lights.intensity);
        drift = std::abs(now / previous - ratio);
        ratio = now / previous;
        previous = now;
        if (settings.bounces >= 0)
            continue;
        // The tail is previous * ratio / (1 - ratio); a ratio still drifting leaves about this much of it unknown.
        const double room = std::max(1.0 - ratio, 1e-6);
        costs.remainder = now * drift / (room * room) / power(sum.intensity);
        if (costs.remainder < settings.remainder || now < 1e-6 * start)
            break;
    }
    costs.tail_ratio = ratio;
    if (settings.bounces < 0 && ratio > 0.0 && ratio < 1.0) {
        const double tail = ratio / (1.0 - ratio);
        costs.tail_share = tail * power(lights.intensity) / power(sum.intensity);
        sum.add(lights, static_cast<float>(tail));
    }
    return sum;
}

}  // namespace

std::vector<Rgb> fluence_at_nodes(const Gathered& gathered, const std::vector<std::uint8_t>& mask) {
    const std::size_t n = mask.size();
    std::vector<Rgb> fluence(n, Rgb(0.0f));
    parallel_for(n, [&](std::size_t i) {
        if (mask[i])
            fluence[i] = {gathered.fluence[i], gathered.fluence[n + i], gathered.fluence[2 * n + i]};
    }, 4096);
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

Gathered multiple_scattering(const ScatteringInput& input, ScatteringCosts& costs, Progress& progress) {
    const ExtinctionPyramid& pyramid = *input.pyramid;
    const Medium& medium = pyramid.medium();
    auto start = std::chrono::steady_clock::now();
    const ScatteredLight fine_first = scattered_light(medium, *input.first, *input.needed);
    costs.lattice_level = choose_level(pyramid, input.settings.lattice_level);
    LightingSettings lighting = input.lighting;
    CoarseOperator op(pyramid, costs.lattice_level, lighting, input.settings.alpha);
    costs.coarse_nodes = op.active_nodes();
    costs.operator_seconds = seconds_since(start);

    start = std::chrono::steady_clock::now();
    // Light scattered once, on the coarse lattice; the sum below starts with it.
    const ScatteredLight first = op.restricted(fine_first, medium.lattice);
    ScatteredLight sum = sum_series(op, first, input.settings, costs, progress);
    costs.series_seconds = seconds_since(start);
    costs.bytes = op.bytes();

    start = std::chrono::steady_clock::now();
    // Orders two and up are known per coarse node as light leaving; the last flight wants them on fine voxels.
    sum.add(first, -1.0f);
    ScatteredLight lights = op.spread_to_fine(sum, medium);
    lights.add(fine_first, 1.0f);
    sharpen_lights(medium.lattice, lights.intensity);

    std::vector<float> weight(lights.intensity.size());
    for (std::size_t i = 0; i < weight.size(); ++i)
        weight[i] = luminance(lights.intensity[i]);
    LightingGrid grid = build_lighting_grid(medium, lights.intensity, &weight, automatic_levels(medium));
    if (!lights.directional.empty())
        set_intensity(grid, medium.lattice, lights.intensity, &lights.directional);
    LightField field{&pyramid, &lights.intensity, lights.directional.empty() ? nullptr : &lights.directional, &grid,
                     &weight, input.settings.alpha, lighting, nullptr};
    Gathered gathered = gather_at_nodes(field, {input.needed, input.toward_camera, false, medium.mean_cosine},
                                        costs.final_levels, progress);
    prepare_interpolation(medium.lattice, *input.needed, gathered);
    if (lighting.energy_balance) {
        BounceBalance balance;
        balance.order = -1;
        balance.emitted = power(lights.intensity) / std::max(power(fine_first.intensity), 1e-300);
        gathered.scale(close_balance(pyramid, lights.intensity, fluence_at_nodes(gathered, *input.needed), balance));
        costs.balances.push_back(balance);
    }
    costs.final_seconds = seconds_since(start);
    return gathered;
}

}  // namespace brisance
