// Sample elimination of 1.2 million points of a surface: to a tenth, and to a hundredth of them.
#include <benchmark/benchmark.h>

#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "core/rng.h"
#include "elimination/eliminate.h"

namespace brisance::benchmarks {
namespace {

constexpr std::size_t kPoints = 1'200'000;

// Uniform radii by the textbook's algorithm, in parallel, and in parallel by stages; adaptive radii by stages.
enum Way { OneByOne, OneStage, Stages, Adaptive };

std::vector<vec3> points_on_sphere() {
    Rng rng(Stream::Points, 1);
    std::vector<vec3> points(kPoints);
    for (vec3& p : points) {
        const double z = 2.0 * rng.next_double() - 1.0, phi = 2.0 * 3.141592653589793 * rng.next_double();
        const double r = std::sqrt(1.0 - z * z);
        p = vec3(dvec3(r * std::cos(phi), r * std::sin(phi), z));
    }
    return points;
}

void eliminate_points(benchmark::State& state) {
    static const std::vector<vec3> points = points_on_sphere();
    const Way way = static_cast<Way>(state.range(1));
    EliminationSettings settings;
    settings.measure = 4.0 * 3.141592653589793;
    settings.radius = way == Adaptive ? EliminationRadius::Adaptive : EliminationRadius::Uniform;
    settings.one_by_one = way == OneByOne;
    if (way == OneByOne || way == OneStage)
        settings.stage_ratio = std::numeric_limits<double>::infinity();
    const ThreadLimit limit(static_cast<int>(state.range(2)));
    for (auto _ : state)
        benchmark::DoNotOptimize(eliminate(points, static_cast<std::size_t>(state.range(0)), settings).index.data());
    state.counters["threads"] = thread_count();
}

BENCHMARK(eliminate_points)
    ->ArgNames({"survivors", "way", "threads"})
    ->ArgsProduct({{kPoints / 10, kPoints / 100}, {OneStage, Stages, Adaptive}, {1, 0}})
    ->ArgsProduct({{kPoints / 10, kPoints / 100}, {OneByOne}, {1}})
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->UseRealTime();

}  // namespace
}  // namespace brisance::benchmarks
