#include "stability/run_cases.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/stopwatch.h"

namespace brisance::stability {

namespace {

constexpr double kMostImbalance = 0.005;  // after scaling
constexpr double kStandardErrors = 4.0;

RenderedFrame rendered(const Scene& scene, RenderMethod method) {
    Shot shot = scene.shot;
    shot.method = method;
    Progress silent;
    return render_medium(shot, scene.medium, silent);
}

bool all_finite(const Image& image) {
    return std::all_of(image.layers.begin(), image.layers.end(), [](const Layer& layer) {
        return std::all_of(layer.pixels.begin(), layer.pixels.end(), [](float v) { return std::isfinite(v); });
    });
}

void read_balances(const Statistics& statistics, Result& result) {
    for (const StageCost& stage : statistics.stages) {
        if (!stage.detail.contains("balance"))
            continue;
        for (const auto& flight : stage.detail["balance"]) {
            const double off = flight["collided"].get<double>() + flight["escaped"].get<double>() - 1.0;
            const double noise = flight["escape_standard_error"].get<double>();
            // Written so that NaN counts as out of balance.
            if (!(std::abs(flight["sum"].get<double>() - 1.0) <= kMostImbalance + kStandardErrors * noise))
                result.balanced = false;
            if (!result.imbalance || !(std::abs(off) <= std::abs(*result.imbalance)))
                result.imbalance = off;
        }
    }
}

}  // namespace

bool Result::passed() const {
    return trouble.empty() && finite && balanced && measured.error <= tolerance + kStandardErrors * measured.noise;
}

std::string method_name(RenderMethod method) {
    return method == RenderMethod::Path ? "path" : "lighting_grid";
}

Result run_case(const Case& c, RenderMethod method) {
    Result result;
    result.name = c.name;
    result.method = method;
    result.tolerance = c.tolerance.of(method).value_or(0.0);
    const Stopwatch watch;
    try {
        const Scene scene = c.scene();
        const RenderedFrame frame = rendered(scene, method);
        result.seconds = watch.seconds();
        result.finite = all_finite(frame.image);
        read_balances(frame.statistics, result);
        result.measured = c.measure(scene, frame, method, rendered);
    } catch (const std::exception& error) {
        result.seconds = watch.seconds();
        result.trouble = error.what();
    }
    return result;
}

std::vector<Case> all_cases() {
    std::vector<Case> all;
    for (const auto& family : {depth_cases, albedo_cases, phase_cases, contrast_cases, emission_cases, scale_cases,
                               lattice_cases, shadow_cases, camera_cases, light_cases}) {
        std::vector<Case> cases = family();
        std::move(cases.begin(), cases.end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace brisance::stability
