#include "peaks.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "peaks.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace brisance::benchmarks {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 16>;

// Chains that hide the latency of each. Returns how many operations that were, and a value that depends on all.
double multiply_adds(std::size_t rounds, float& out) {
    constexpr int kChains = 12;
    const D d;
    using V = hn::Vec<D>;
    const V factor = hn::Set(d, 0.999f), term = hn::Set(d, 0.001f);
    V chain[kChains];
    for (int k = 0; k < kChains; ++k)
        chain[k] = hn::Set(d, 0.1f * float(k));
    for (std::size_t r = 0; r < rounds; ++r)
        for (int k = 0; k < kChains; ++k)
            chain[k] = hn::MulAdd(chain[k], factor, term);
    for (int k = 0; k < kChains; ++k)
        out += hn::GetLane(hn::SumOfLanes(d, chain[k]));
    return 2.0 * kChains * double(rounds) * double(hn::Lanes(d));
}

// Four gathers that wait for nothing, of a table of 1024 words.
double gathers(std::size_t rounds, const std::int32_t* table, std::int32_t& out) {
    const hn::RebindToSigned<D> d;
    const auto mask = hn::Set(d, 1023), step = hn::Set(d, 37);
    auto at = hn::Iota(d, 0);
    auto sum = hn::Zero(d);
    for (std::size_t r = 0; r < rounds; ++r)
        for (int k = 0; k < 4; ++k) {
            at = hn::And(hn::Add(at, step), mask);
            sum = hn::Add(sum, hn::GatherIndex(d, table, at));
        }
    out += hn::GetLane(hn::SumOfLanes(d, sum));
    return 4.0 * double(rounds) * double(hn::Lanes(d));
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance::benchmarks
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brisance::benchmarks {

HWY_EXPORT(multiply_adds);
HWY_EXPORT(gathers);

namespace {

// The best of some short runs: others had the core for a while.
template <class Run>
double best_rate(const Run& run) {
    double best = 0.0;
    for (int k = 0; k < 7; ++k) {
        const auto begin = std::chrono::steady_clock::now();
        const double done = run();
        best = std::max(best, done / std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    }
    return best;
}

}  // namespace

double peak_flops() {
    volatile float kept = 0.0f;
    return best_rate([&] {
        float out = 0.0f;
        const double done = HWY_DYNAMIC_DISPATCH(multiply_adds)(2'000'000, out);
        kept = out;
        return done;
    });
}

double peak_gathered() {
    std::vector<std::int32_t> table(1024, 1);
    volatile std::int32_t kept = 0;
    return best_rate([&] {
        std::int32_t out = 0;
        const double done = HWY_DYNAMIC_DISPATCH(gathers)(300'000, table.data(), out);
        kept = out;
        return done;
    });
}

}  // namespace brisance::benchmarks
#endif
