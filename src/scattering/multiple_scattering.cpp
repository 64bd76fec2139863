#include "scattering/multiple_scattering.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "gathering/sh.h"
#include "lights/voxel_lights.h"
#include "medium/phase.h"
#include "scattering/coarse_operator.h"
#include "scattering/series.h"

namespace brisance {

namespace {

constexpr std::size_t kEscapeRays = std::size_t{1} << 18;

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
    if (balance.collided > 0.0)
        balance.scale = luminance(Rgb(escape.collided * emitted)) / y / balance.collided;
    Rgb scale(1.0f);
    for (int c = 0; c < 3; ++c)
        if (hit[c] > 0.0)
            scale[c] = static_cast<float>(escape.collided[c] * emitted[c] / hit[c]);
    return scale;
}

ScatteringSolution solve_scattering(const ScatteringInput& input, ScatteringCosts& costs, Progress& progress) {
    const ExtinctionPyramid& pyramid = *input.pyramid;
    const Medium& medium = pyramid.medium();
    ScatteringSolution out;
    out.lights.push_back(scattered_light(medium, scattered_source(medium, *input.first, *input.needed)));
    if (input.settings.bounces == 2 || !(power(out.lights[0].intensity) > 0.0))
        return out;

    Stopwatch watch;
    costs.lattice_level = choose_level(pyramid, input.settings.lattice_level);
    CoarseOperator op(pyramid, costs.lattice_level, input.lighting, input.settings.alpha);
    costs.coarse_nodes = op.active_nodes();
    costs.operator_seconds = watch.seconds();

    watch = Stopwatch();
    const bool at_nodes = costs.lattice_level == 0 && medium.mean_cosine == 0.0f && !input.as_lights;
    const int single_orders = at_nodes ? input.settings.bounces - 1 : input.settings.bounces - 2;
    std::vector<NodeRadiance> orders;
    sum_orders(op, op.restricted(out.lights[0], medium.lattice), input.settings, single_orders, costs, progress,
               [&](const NodeRadiance& order) {
                   if (input.separate_orders || orders.empty())
                       orders.push_back(order);
                   else
                       orders[0].add(order, Rgb(1.0f));
               });
    if (at_nodes) {
        out.lights.clear();
        out.sources = std::move(orders);
    } else {
        for (const NodeRadiance& order : orders) {
            ScatteredLight light = op.spread_to_fine(order, medium);
            if (input.separate_orders)
                out.lights.push_back(std::move(light));
            else
                out.lights[0].add(light, 1.0f);
        }
        if (costs.lattice_level == 0)
            out.node_scale = op.node_scale();
    }
    costs.series_seconds = watch.seconds();
    costs.bytes = op.bytes();
    return out;
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
