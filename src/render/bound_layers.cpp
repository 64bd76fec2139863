#include "render/bound_layers.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "render/draw.h"
#include "shot/check_shot.h"

namespace brisance {

namespace {

constexpr const char* kBounded = "SS_bounded";
constexpr const char* kResidual = "SS_residual";
constexpr const char* kMap = "bound";

// A light that all but touches a surface takes away more than a float holds.
constexpr double kMost = 1e30;

bool compensates(const Shot& shot) {
    return shot.virtual_lights.compensation != BoundCompensation::None;
}

Layer* layer_named(Image& image, const char* name) {
    const auto found =
        std::find_if(image.layers.begin(), image.layers.end(), [&](const Layer& l) { return l.name == name; });
    return found == image.layers.end() ? nullptr : &*found;
}

double sum_of_luminance(const Layer& colours) {
    double sum = 0.0;
    for (std::size_t i = 0; i + 2 < colours.pixels.size(); i += 3)
        sum += luminance(Rgb(colours.pixels[i], colours.pixels[i + 1], colours.pixels[i + 2]));
    return sum;
}

// Rounding must not leave a part below 0.
Layer split(const Layer& all, Layer& residual) {
    Layer bounded = all;
    bounded.name = kBounded;
    for (std::size_t i = 0; i < all.pixels.size(); ++i) {
        residual.pixels[i] = std::clamp(residual.pixels[i], 0.0f, std::max(all.pixels[i], 0.0f));
        bounded.pixels[i] -= residual.pixels[i];
    }
    return bounded;
}

// From luminances shown and lost to the share that is lost.
void make_shares(Layer& map) {
    std::vector<float> shares(map.pixels.size() / 2);
    for (std::size_t p = 0; p < shares.size(); ++p) {
        const double shown = map.pixels[2 * p], lost = map.pixels[2 * p + 1];
        shares[p] = lost > 0.0 ? float(lost / (shown + lost)) : 0.0f;
    }
    map.channels = {kMap};
    map.pixels = std::move(shares);
}

}  // namespace

bool has_bound_layers(const Shot& shot, const Plan& plan) {
    return shot.output.bound_layers && !why_no_virtual_lights(shot, plan);
}

void check_bound_layers(const Shot& shot, const Plan& plan, Progress& progress) {
    if (const std::string reason = why_no_bound_layers(shot); !reason.empty())
        throw Error(ExitCode::Usage, reason);
    if (!shot.output.bound_layers)
        return;
    if (const std::optional<std::string> reason = why_no_virtual_lights(shot, plan))
        progress.warning("bound-layers", "output.layers.bound: no layers of it are written: " + *reason);
    else if (!compensates(shot))
        progress.notice(
            "virtual_lights.compensation=none brings nothing back: SS itself is what is bounded, and SS_bounded and "
            "SS_residual are left out");
}

void add_bound_sums(Image& image, const Shot& shot, const BoundAccount& found) {
    const std::size_t pixels = found.residual().size();
    if (compensates(shot)) {
        Layer residual{kResidual, {"R", "G", "B"}, false, std::vector<float>(3 * pixels)};
        for (std::size_t p = 0; p < pixels; ++p)
            for (int c = 0; c < 3; ++c)
                residual.pixels[3 * p + std::size_t(c)] = found.residual()[p][c];
        image.layers.push_back(std::move(residual));
    }
    Layer map{kMap, {"shown", "lost"}, false, std::vector<float>(2 * pixels)};
    for (std::size_t p = 0; p < pixels; ++p) {
        map.pixels[2 * p] = float(std::min(found.shown()[p], kMost));
        map.pixels[2 * p + 1] = float(std::min(found.lost()[p], kMost));
    }
    image.layers.push_back(std::move(map));
}

void finish_bound_layers(Image& image, const BoundTally& costs, Statistics& statistics) {
    StageCost stage{"bound of virtual lights, in processor time of the shading", 0.0, 0, {}};
    if (Layer* const residual = layer_named(image, kResidual)) {
        const Layer& all = image.layer(name_of(Cell::SS));
        Layer bounded = split(all, *residual);
        const double shown = sum_of_luminance(all);
        stage.detail["residual_share_of_SS"] = shown > 0.0 ? sum_of_luminance(*residual) / shown : 0.0;
        image.layers.insert(image.layers.begin() + (residual - image.layers.data()), std::move(bounded));
    }
    make_shares(*layer_named(image, kMap));
    // The clock's own cost is taken off, which may leave less than nothing.
    const double lights = std::max(costs.light_seconds, 0.0), rest = std::max(costs.compensation_seconds, 0.0);
    stage.detail["bounded_lights_cpu_seconds"] = lights;
    stage.detail["rays_from_there_cpu_seconds"] = std::max(costs.ray_seconds, 0.0);
    stage.detail["compensation_cpu_seconds"] = rest;
    stage.detail["compensation_share_of_time"] = lights + rest > 0.0 ? rest / (lights + rest) : 0.0;
    statistics.stages.push_back(std::move(stage));
}

}  // namespace brisance
