// The inner loops of gathering: light evaluations per second on one core.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "fires.h"
#include "gathering/far_kernels.h"
#include "medium/phase.h"
#include "near_field/first_level.h"
#include "near_field/near_field.h"
#include "peaks.h"

namespace brisance::benchmarks {
namespace {

// The nodes of one brick in the middle of the fire, in groups of 4 x 2 x 2.
Receivers brick_receivers(const Medium& medium) {
    const ivec3 first = medium.lattice.first_node(medium.lattice.brick_count() / 2);
    std::vector<vec3> points;
    for (int k = 0; k < BrickLattice::kNodes; ++k) {
        const int sub = k >> 4, in = k & 15;
        points.push_back(medium.local_of_node(
            first + ivec3((sub >> 4) * 4 + (in >> 2), (sub >> 2 & 3) * 2 + (in >> 1 & 1), (sub & 3) * 2 + (in & 1))));
    }
    Receivers receivers;
    receivers.add_block(points, {});
    return receivers;
}

// Floating-point operations of an evaluation by far_kernels.cpp: isotropic lights above the finest level, fluence
// alone. A fused multiply-add counts as two; comparisons, conversions and integers do not count.
constexpr double kFlopsUnshadowed = 36.0, kFlopsWithMaps = 87.0;
// 32-bit words that an evaluation gathers from a map: two distances of each of four texels.
constexpr double kGathered = 4.0;

// What part of the roofs the kernel reaches.
void hold_against_roofs(benchmark::State& state, std::uint64_t evaluations, bool maps) {
    static const double flops = peak_flops(), gathered = peak_gathered();
    const auto part = [&](double of_each, double peak) {
        return benchmark::Counter(double(evaluations) * of_each / peak, benchmark::Counter::kIsRate);
    };
    state.counters["of peak flops"] = part(maps ? kFlopsWithMaps : kFlopsUnshadowed, flops);
    if (maps)
        state.counters["of peak gathers"] = part(kGathered, gathered);
}

void roofs(benchmark::State& state) {
    const ThreadLimit one(1);
    for (auto _ : state) {
        state.counters["flops/s"] = peak_flops();
        state.counters["gathered/s"] = peak_gathered();
    }
    state.SetLabel(gather_instruction_set());
}

// Level 1 or higher, with the lights that a block of nodes listens to at alpha = 2.
void far_kernel(benchmark::State& state, FarLights::Shadow shadow) {
    const ThreadLimit one(1);
    const Fire& fire = fire_of(100);
    const GridLevel& level = fire.grid.levels.at(static_cast<std::size_t>(state.range(0)) - 1);
    const Receivers receivers = brick_receivers(fire.medium);
    const Box& bounds = receivers.blocks()[0].bounds;
    FarLights lights{};
    lights.radius = 2.0f * level.spacing;
    lights.ball = std::cbrt(3.0f / (4.0f * kPi)) * fire.medium.spacing;
    std::vector<std::uint32_t> list;
    for (std::uint32_t i = 0; i < level.size(); ++i) {
        const vec3 nearest = glm::clamp(level.position[i], bounds.low, bounds.high);
        if (glm::length(nearest - level.position[i]) < 2.0f * lights.radius)
            list.push_back(i);
    }
    lights.list = list;
    lights.position = level.position.data();
    lights.intensity = level.intensity.data();
    lights.shadow = shadow;
    lights.layout.near_distance = 0.5f * lights.radius;
    lights.layout.far_distance = 2.0f * lights.radius;
    LargeVector<std::uint16_t> maps;
    if (shadow == FarLights::Shadow::Maps) {
        lights.list_base = list.front();
        build_shadow_maps(fire.pyramid, level, fire.weight, nullptr, lights.layout, list.front(),
                          list.back() - list.front() + 1, maps);
        lights.maps = maps.data();
    }
    const PackedExtinction fine = fire.pyramid.view(0);
    lights.extinction = &fine;
    lights.index_from_local = fire.medium.index_from_local;
    lights.step_nodes = 0.5f;
    std::vector<float> fluence(3 * receivers.size(), 0.0f);
    std::uint64_t evaluations = 0;
    for (auto _ : state) {
        evaluations += gather_far(lights, receivers, receivers.blocks()[0],
                                  {receivers.size(), fluence.data(), nullptr, nullptr, 0.0f});
        benchmark::DoNotOptimize(fluence.data());
    }
    state.counters["evaluations/s"] = benchmark::Counter(double(evaluations), benchmark::Counter::kIsRate);
    state.counters["lights"] = double(list.size());
    if (shadow != FarLights::Shadow::Exact)
        hold_against_roofs(state, evaluations, shadow == FarLights::Shadow::Maps);
    state.SetLabel(gather_instruction_set());
}

void near_stencil(benchmark::State& state, bool shadows) {
    const ThreadLimit one(1);
    const Fire& fire = fire_of(40);
    const float alpha = static_cast<float>(state.range(0));
    const NearField near(fire.medium.local_from_index, alpha * fire.medium.spacing, shadows);
    Gathered out;
    out.resize(fire.medium.lattice.node_count(), false, false);
    for (auto _ : state) {
        near.gather({&fire.medium.lattice, &fire.medium.extinction, &fire.intensity, nullptr, std::nullopt, ivec3(0)},
                    out);
        benchmark::DoNotOptimize(out.fluence.data());
    }
    state.counters["evaluations/s"] =
        benchmark::Counter(double(near.separations()) * double(fire.medium.lattice.node_count()),
                           benchmark::Counter::kIsIterationInvariantRate);
    state.counters["separations"] = double(near.separations());
}

// Level 1 at all nodes, without maps.
void first_level(benchmark::State& state) {
    const ThreadLimit one(1);
    const Fire& fire = fire_of(60);
    const FirstLevel level(fire.medium.local_from_index, 2.0f * fire.grid.levels.front().spacing);
    const std::vector<std::uint8_t> needed(fire.medium.lattice.node_count(), 1);
    Gathered out;
    out.resize(needed.size(), false, false);
    std::uint64_t evaluations = 0;
    for (auto _ : state) {
        evaluations +=
            level.gather({&fire.pyramid, &fire.medium.extinction, &fire.grid.levels.front(), std::nullopt, 0.0f},
                         {&fire.medium.lattice, &needed, false}, out);
        benchmark::DoNotOptimize(out.fluence.data());
    }
    state.counters["evaluations/s"] = benchmark::Counter(double(evaluations), benchmark::Counter::kIsRate);
}

BENCHMARK(roofs)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(far_kernel, unshadowed, FarLights::Shadow::None)->ArgName("level")->Arg(1)->Arg(2);
BENCHMARK_CAPTURE(far_kernel, maps, FarLights::Shadow::Maps)->ArgName("level")->Arg(1)->Arg(2);
BENCHMARK_CAPTURE(far_kernel, exact, FarLights::Shadow::Exact)->ArgName("level")->Arg(1);
BENCHMARK(first_level)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(near_stencil, unshadowed, false)->ArgName("alpha")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(near_stencil, shadowed, true)->ArgName("alpha")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace brisance::benchmarks
