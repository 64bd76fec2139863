#include "stability/run_cases.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/stopwatch.h"
#include "forecast/plan.h"

namespace brisance::stability {

namespace {

// Of what collides, scaled, and what independent rays see escape: a coarse lattice knows the smoke's edge no better.
constexpr double kMostImbalance = 0.01;
constexpr double kStandardErrors = 4.0;

RenderedFrame rendered_once(const Scene& scene, const Method& method, int seed, std::optional<int> paths) {
    Shot shot = scene.shot;
    method.apply_to(shot, seed, paths);
    Progress silent;
    return render_medium(by_its_method_alone(std::move(shot)), scene.medium, silent, scene.surroundings.get());
}

void set_mean(Image& image, const std::vector<Image>& pictures) {
    for (std::size_t l = 0; l < image.layers.size(); ++l)
        for (std::size_t i = 0; i < image.layers[l].pixels.size(); ++i) {
            double sum = 0.0;
            for (const Image& picture : pictures)
                sum += picture.layers[l].pixels[i];
            image.layers[l].pixels[i] = static_cast<float>(sum / double(pictures.size()));
        }
}

RenderedFrame rendered(const Case& c, const Scene& scene, const Method& method) {
    const std::optional<int> paths = c.paths_of(method);
    RenderedFrame frame = rendered_once(scene, method, 0, paths);
    if (!method.shares_noise())
        return frame;
    frame.halves = {frame.image};
    for (int seed = 1; seed < c.pictures; ++seed)
        frame.halves.push_back(rendered_once(scene, method, seed, paths).image);
    set_mean(frame.image, frame.halves);
    return frame;
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

bool owns_a_cell(const Method& method, const Scene& scene) {
    if (!method.shares_noise())
        return true;
    Shot shot = scene.shot;
    method.apply_to(shot, 0);
    return plan_cells(shot, scene.medium, scene.surroundings.get()).scattering_method;
}

std::optional<int> Case::paths_of(const Method& method) const {
    const auto found = paths.find(method.base());
    return found == paths.end() ? std::nullopt : std::optional(found->second);
}

const Limit* Case::limit_of(const Method& method) const {
    const auto found = tolerance.limits.find(method.base());
    return found == tolerance.limits.end() ? nullptr : &found->second;
}

std::optional<double> Case::tolerance_of(const Method& method) const {
    if (const Limit* const limit = limit_of(method))
        return limit->tolerance;
    return method.is_path() ? tolerance.path : tolerance.lighting_grid;
}

std::optional<Result> run_case(const Case& c, const Method& method) {
    Result result;
    result.name = c.name;
    result.method = method.name();
    result.tolerance = c.tolerance_of(method).value_or(0.0);
    result.limit = c.limit_of(method) != nullptr;
    const Stopwatch watch;
    try {
        const Scene scene = c.scene();
        if (!owns_a_cell(method, scene))
            return std::nullopt;
        const Render render = [&c](const Scene& s, const Method& m) { return rendered(c, s, m); };
        const RenderedFrame frame = render(scene, method);
        result.seconds = watch.seconds();
        result.finite = all_finite(frame.image);
        read_balances(frame.statistics, result);
        result.measured = c.measure(scene, frame, method, render);
    } catch (const std::exception& error) {
        result.seconds = watch.seconds();
        result.trouble = error.what();
    }
    return result;
}

std::vector<Case> all_cases() {
    std::vector<Case> all;
    for (const auto& family : {depth_cases, albedo_cases, phase_cases, contrast_cases, emission_cases, scale_cases,
                               lattice_cases, shadow_cases, camera_cases, light_cases, surface_cases}) {
        std::vector<Case> cases = family();
        std::move(cases.begin(), cases.end(), std::back_inserter(all));
    }
    return all;
}

}  // namespace brisance::stability
