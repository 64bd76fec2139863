#include "forecast/machine_speed.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/parallel.h"
#include "core/stopwatch.h"

namespace brisance {

namespace {

constexpr int kSide = 32, kSteps = 1 << 16, kRuns = 5;
constexpr double kTaskSeconds = 0.6e-3;  // of one core of the machine that forecasts are in (costs.h)

// Transmittance along a winding ray through a small grid.
float march(const std::vector<float>& extinction, float start) {
    float sum = 0.0f, x = start;
    for (int k = 0; k < kSteps; ++k) {
        x += 0.61803398875f;
        const auto i = static_cast<std::size_t>(x * kSide) % (extinction.size() - 1);
        const float part = x - std::floor(x);
        sum += std::exp(-(extinction[i] + part * (extinction[i + 1] - extinction[i])));
    }
    return sum;
}

}  // namespace

double machine_speed() {
    const std::vector<float> extinction(std::size_t(kSide) * kSide * kSide, 0.5f);
    const std::size_t tasks = 4 * static_cast<std::size_t>(thread_count());
    std::vector<float> out(tasks);
    double best = 1e300;
    for (int run = 0; run < kRuns; ++run) {
        const Stopwatch watch;
        parallel_for(tasks, [&](std::size_t t) { out[t] = march(extinction, 0.1f * float(t)); });
        best = std::min(best, watch.seconds());
    }
    // The sum is used, so that no compiler leaves the work out.
    const bool finite = std::all_of(out.begin(), out.end(), [](float v) { return std::isfinite(v); });
    return finite ? kTaskSeconds * double(tasks) / best : 1.0;
}

}  // namespace brisance
