// How building and asking the hierarchy grow with the number of lights: 10^4 to 10^7, a dense cube.
#include <benchmark/benchmark.h>

#include "core/parallel.h"
#include "core/rng.h"
#include "fires.h"
#include "lighting_grid/voxel_lights.h"

namespace brisance::benchmarks {
namespace {

void make_lights(benchmark::State& state) {
    const Fire& fire = fire_of(side_for(state.range(0)));
    for (auto _ : state)
        benchmark::DoNotOptimize(voxel_lights(fire.medium).data());
    state.counters["threads"] = thread_count();
}

void build_grid(benchmark::State& state) {
    const Fire& fire = fire_of(side_for(state.range(0)));
    const int levels = automatic_levels(fire.medium);
    for (auto _ : state)
        benchmark::DoNotOptimize(build_lighting_grid(fire.medium, fire.intensity, nullptr, levels).levels.data());
    state.counters["levels"] = levels;
    state.counters["threads"] = thread_count();
}

// Blocks of 64 neighbouring points, here and there in the fire: without shadows, so that the hierarchy alone is seen.
void gather_points(benchmark::State& state) {
    const ThreadLimit one(1);
    const int side = side_for(state.range(0));
    const Fire& fire = fire_of(side);
    Receivers receivers;
    Rng rng(Stream::EscapeRay, 7);
    for (int b = 0; b < 16; ++b) {
        const float x = rng.next(), y = rng.next(), z = rng.next();
        const vec3 corner = vec3(x, y, z) * float(side - 4);
        std::vector<vec3> points;
        points.reserve(64);
        for (int i = 0; i < 64; ++i)
            points.push_back(fire.medium.local_from_index *
                             (corner + vec3(i >> 4, i >> 2 & 3, i & 3) - vec3(fire.medium.reference_node)));
        receivers.add_block(points, {});
    }
    LightingSettings settings;
    settings.shadows = ShadowMethod::None;
    settings.alpha = static_cast<float>(state.range(1));
    const LightField field = fire.field(settings);
    const GridLevel bottom = bottom_level(field);
    Progress silent;
    double evaluations = 0.0;
    for (auto _ : state) {
        std::vector<LevelCost> costs;
        benchmark::DoNotOptimize(gather_at_points(field, bottom, receivers, 0.0f, costs, silent).fluence.data());
        double seconds = 0.0;
        evaluations = 0.0;
        for (const LevelCost& cost : costs) {
            seconds += cost.gather_seconds;
            evaluations += double(cost.evaluations);
        }
        state.SetIterationTime(seconds);
    }
    const double points = double(receivers.size());
    state.counters["points/s"] = benchmark::Counter(points, benchmark::Counter::kIsIterationInvariantRate);
    state.counters["lights/point"] = evaluations / points;
}

BENCHMARK(make_lights)
    ->ArgName("lights")
    ->RangeMultiplier(10)
    ->Range(10000, 10000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(build_grid)
    ->ArgName("lights")
    ->RangeMultiplier(10)
    ->Range(10000, 10000000)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK(gather_points)
    ->ArgNames({"lights", "alpha"})
    ->ArgsProduct({{10000, 100000, 1000000, 10000000}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseManualTime();

}  // namespace
}  // namespace brisance::benchmarks
