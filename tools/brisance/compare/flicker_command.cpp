#include "compare/flicker_command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>

#include "compare/text_table.h"
#include "core/error.h"
#include "core/parallel.h"
#include "load_shot.h"
#include "metrics/differences.h"
#include "metrics/layers.h"
#include "render/input/frame_input.h"
#include "render/render_frame.h"
#include "render/still_variants.h"

namespace brisance {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMove = 0.125;        // voxels, along each axis
const dvec3 kMoveOfLattices(3, 5, 7);  // voxels: bricks and the levels of hierarchies lie elsewhere in the smoke
constexpr int kPadding = 29;           // voxels: no multiple of the lattices' bricks
constexpr int kOtherSeed = 104729;

struct Variant {
    std::string name;
    Shot shot;
};

struct LayerChange {
    std::string layer;   // "" is the picture
    double share = 0.0;  // of the layer in the picture, by their norms
    double change = 0.0;
};

struct VariantChange {
    std::string name;
    bool same_bits = false;
    std::vector<LayerChange> layers;
};

FrameFile frame_of(const Shot& shot, const FlickerOptions& options) {
    const std::vector<FrameFile> frames =
        resolve_frames(shot, options.frames.empty() ? std::nullopt : std::optional(parse_frames(options.frames)));
    if (frames.size() == 1)
        return frames.front();
    std::vector<int> numbers;
    for (const FrameFile& frame : frames)
        numbers.push_back(frame.frame);
    throw Error(ExitCode::Usage, fmt::format("flicker looks at one frame, and there are {}: choose one with -f",
                                             describe_frames(numbers)));
}

// With the camera and the size of all pictures fixed.
Shot held(Shot shot, const CameraSettings& camera, int width) {
    shot.camera = camera;
    shot.camera_given = true;
    if (shot.camera.width > width) {
        shot.camera.height = std::max(1, static_cast<int>(std::lround(double(camera.height) * width / camera.width)));
        shot.camera.width = width;
    }
    shot.certify.belief = 0.0;
    shot.certify.enabled = false;
    return shot;
}

std::vector<Variant> variants_of(const Shot& shot, const FrameInput& input) {
    std::vector<Variant> variants = {{"rendered again", shot}};
    if (input.medium.lattice.brick_count() > 0) {
        variants.push_back(
            {fmt::format("moved by {:g} voxel", kMove), moved(shot, dvec3(kMove * double(input.medium.spacing)))});
        variants.push_back({"moved by 3, 5, 7 voxels", moved(shot, kMoveOfLattices * double(input.medium.spacing))});
        variants.push_back({fmt::format("{} more voxels of padding", kPadding), padded(shot, input.medium, kPadding)});
    }
    variants.push_back({"other seeds", reseeded(shot, kOtherSeed)});
    return variants;
}

double norm(const Picture& picture) {
    double square = 0.0;
    for (const Rgb& pixel : picture.pixels)
        square += double(glm::dot(pixel, pixel));
    return std::sqrt(square);
}

VariantChange change_of(const std::string& name, const Image& still, const Image& variant) {
    VariantChange result{name, true, {}};
    const std::vector<std::string> there = picture_layers(variant);
    const double whole = norm(picture_of(still, {""}).picture);
    for (const std::string& layer : picture_layers(still)) {
        if (std::find(there.begin(), there.end(), layer) == there.end())
            continue;
        const Picture before = picture_of(still, {layer}).picture, after = picture_of(variant, {layer}).picture;
        result.same_bits = result.same_bits && before.pixels == after.pixels;
        result.layers.push_back(
            {layer, whole > 0.0 ? norm(before) / whole : 0.0, measure_differences(after.pixels, before.pixels).rrmse});
    }
    return result;
}

std::string shown(double value) {
    return value == 0.0 ? "0" : fmt::format("{:.3g} %", 100.0 * value);
}

std::string text_of(const std::vector<VariantChange>& changes, double error) {
    std::vector<std::vector<std::string>> rows = {{"change", "of lighting.error"}, {"share of the picture", ""}};
    for (const LayerChange& layer : changes.front().layers) {
        rows[0].push_back(layer.layer.empty() ? "beauty" : layer.layer);
        rows[1].push_back(shown(layer.share));
    }
    for (const VariantChange& change : changes) {
        rows.push_back({change.name,
                        change.same_bits ? "same bits" : fmt::format("{:.2g}", change.layers.front().change / error)});
        for (const LayerChange& layer : changes.front().layers) {
            const auto found = std::ranges::find(change.layers, layer.layer, &LayerChange::layer);
            rows.back().push_back(found == change.layers.end() ? "-" : shown(found->change));
        }
    }
    return text_table(rows, 1) + fmt::format("each relative to its layer (rRMSE); lighting.error={:g}\n", error);
}

std::string json_of(const std::vector<VariantChange>& changes, double error) {
    Json json = {{"schema_version", 1}, {"lighting_error", error}, {"variants", Json::array()}};
    for (const VariantChange& change : changes) {
        Json entry = {{"variant", change.name}, {"same_bits", change.same_bits}, {"layers", Json::array()}};
        for (const LayerChange& layer : change.layers)
            entry["layers"].push_back({{"layer", layer.layer.empty() ? "beauty" : layer.layer},
                                       {"share", layer.share},
                                       {"change", layer.change}});
        json["variants"].push_back(entry);
    }
    return json.dump(2) + "\n";
}

}  // namespace

void add_flicker_options(CLI::App& command, FlickerOptions& options) {
    command.add_option("SHOT_OR_VDB", options.input, "A shot (JSON), or a .vdb with or without frame token (####)")
        ->required();
    command.add_option("-f,--frame", options.frames, "The frame; without it, the only one on disk");
    command.add_option("--width", options.width, "Of the pictures, at most [pixels]; default 160")
        ->check(CLI::Range(8, 16384));
    command
        .add_option("--fail-above", options.fail_above,
                    "Exit code 1 when the picture of a variant changes by more: 0.01")
        ->check(CLI::NonNegativeNumber)
        ->type_name("VALUE");
    command.add_flag("--json", options.as_json, "As JSON");
}

int run_flicker(const FlickerOptions& options) {
    TextProgress progress(options.progress);
    const ThreadLimit limit(options.threads);
    const Shot given = load_shot(options.input, {options.preset, options.overrides}, progress);
    const FrameFile frame = frame_of(given, options);
    Statistics unused;
    std::vector<Variant> variants;
    Shot shot;
    {
        const FrameInput input = load_frame(given, frame.file, frame.frame, unused, progress);
        shot = held(given, input.camera, options.width);
        variants = variants_of(shot, input);
    }
    progress.begin_frame(frame.frame, frame.file.string(), 0, variants.size() + 1);
    const Image still = render_frame(shot, frame.file, frame.frame, progress).image;
    std::vector<VariantChange> changes;
    for (const Variant& variant : variants) {
        progress.begin_frame(frame.frame, frame.file.string(), changes.size() + 1, variants.size() + 1);
        changes.push_back(
            change_of(variant.name, still, render_frame(variant.shot, frame.file, frame.frame, progress).image));
    }
    progress.finish();
    const double error = given.lighting.error;
    std::fputs((options.as_json ? json_of(changes, error) : text_of(changes, error)).c_str(), stdout);
    ExitCode code = ExitCode::Success;
    for (const VariantChange& change : changes)
        if (options.fail_above >= 0.0 && !(change.layers.front().change <= options.fail_above)) {
            fmt::print(stderr, "brisance: {}: the picture changes by {:.4g}, above {:g}\n", change.name,
                       change.layers.front().change, options.fail_above);
            code = ExitCode::RenderFailed;
        }
    return static_cast<int>(code);
}

}  // namespace brisance
