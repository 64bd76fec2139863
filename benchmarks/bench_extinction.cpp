// Samples of the extinction, and rays of shadow maps. All on one core.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "core/rng.h"
#include "fires.h"
#include "shadows/shadow_kernels.h"
#include "shadows/shadow_maps.h"

namespace brisance::benchmarks {
namespace {

// Short segments scattered through the medium, up to 8 nodes long and sampled twice a node.
void short_segments(benchmark::State& state) {
    const ThreadLimit one(1);
    const Fire& fire = fire_of(100);
    constexpr std::size_t kSegments = 4096;
    const int level = static_cast<int>(state.range(0));
    const float extent = 100.0f / float(1 << level);
    std::vector<float> begin[3], end[3], metres(kSegments, 1.0f), depths(kSegments);
    Rng rng(Stream::EscapeRay, 1);
    for (int a = 0; a < 3; ++a)
        for (std::size_t i = 0; i < kSegments; ++i) {
            begin[a].push_back(rng.next() * extent);
            end[a].push_back(begin[a].back() + (rng.next() - 0.5f) * 16.0f / std::sqrt(3.0f));
        }
    const Segments segments{{begin[0].data(), begin[1].data(), begin[2].data()},
                            {end[0].data(), end[1].data(), end[2].data()},
                            metres.data(),
                            kSegments};
    for (auto _ : state) {
        segment_optical_depths(fire.pyramid.view(level), segments, 0.5f, depths.data());
        benchmark::DoNotOptimize(depths.data());
    }
    state.counters["segments/s"] = benchmark::Counter(double(kSegments), benchmark::Counter::kIsIterationInvariantRate);
}

// Points only: one sample each.
void single_samples(benchmark::State& state) {
    const ThreadLimit one(1);
    const Fire& fire = fire_of(100);
    constexpr std::size_t kPoints = 1 << 16;
    std::vector<float> at[3], metres(kPoints, 1.0f), values(kPoints);
    Rng rng(Stream::EscapeRay, 2);
    for (auto& axis : at)
        for (std::size_t i = 0; i < kPoints; ++i)
            axis.push_back(rng.next() * 100.0f);
    const Segments points{
        {at[0].data(), at[1].data(), at[2].data()}, {at[0].data(), at[1].data(), at[2].data()}, metres.data(), kPoints};
    for (auto _ : state) {
        segment_optical_depths(fire.pyramid.view(0), points, 1.0f, values.data());
        benchmark::DoNotOptimize(values.data());
    }
    state.counters["samples/s"] = benchmark::Counter(double(kPoints), benchmark::Counter::kIsIterationInvariantRate);
}

// Texel rays of the maps of one level, for lights from the middle of it.
void shadow_map_rays(benchmark::State& state) {
    const ThreadLimit one(1);
    const Fire& fire = fire_of(100);
    const GridLevel& level = fire.grid.levels.at(static_cast<std::size_t>(state.range(0)) - 1);
    ShadowMapLayout layout;
    layout.resolution = 16 << std::min(level.level - 1, 3);
    layout.near_distance = level.spacing;
    layout.far_distance = 4.0f * level.spacing;
    const std::size_t count = std::min<std::size_t>(64 >> std::min(level.level, 5), level.size());
    LargeVector<std::uint16_t> maps;
    for (auto _ : state) {
        build_shadow_maps(fire.pyramid, level, fire.weight, nullptr, layout, (level.size() - count) / 2, count, maps);
        benchmark::DoNotOptimize(maps.data());
    }
    state.counters["rays/s"] = benchmark::Counter(double(count) * layout.resolution * layout.resolution,
                                                  benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(short_segments)->ArgName("level")->Arg(0)->Arg(2);
BENCHMARK(single_samples);
BENCHMARK(shadow_map_rays)->ArgName("level")->DenseRange(1, 4)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace brisance::benchmarks
