#include "reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/cell.h"
#include "core/error.h"
#include "film/write_image.h"
#include "metrics/differences.h"
#include "metrics/layers.h"
#include "named_progress.h"
#include "render/render_frame.h"
#include "render_cost.h"
#include "shot/scene_differences.h"
#include "shot/write_shot.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

const char* const kShot = "brisance/shot";

bool has_layer(const Image& image, const std::string& layer) {
    const std::vector<std::string> there = picture_layers(image);
    return std::find(there.begin(), there.end(), layer) != there.end();
}

// A file with one layer alone, whatever its name, is a beauty.
std::optional<Picture> layer_of(const Image& image, const std::string& layer) {
    const std::vector<std::string> there = picture_layers(image);
    if (layer.empty() && there.size() == 1)
        return picture_of(image, there).picture;
    return has_layer(image, layer) ? std::optional(picture_of(image, {layer}).picture) : std::nullopt;
}

void measure_noise(ReportReference& reference) {
    for (const auto& [layer, pictures] : reference.layers)
        if (pictures.second)
            reference.summary.noise[layer] =
                measure_halves(pictures.first.pixels, pictures.first.pixels, pictures.second->pixels).reference_noise;
}

// rRMSE by the variance of each pixel's mean, as the path tracer writes it.
void noise_from_variance(const Image& image, ReportReference& reference) {
    if (!has_layer(image, "variance"))
        return;
    const Picture variance = picture_of(image, {"variance"}).picture;
    double noise = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < variance.pixels.size(); ++i) {
        const dvec3 value(reference.layers.at("").first.pixels[i]), spread(variance.pixels[i]);
        noise += spread.x + spread.y + spread.z;
        norm += glm::dot(value, value);
    }
    if (norm > 0.0 && std::isfinite(noise))
        reference.summary.noise[""] = std::sqrt(noise / norm);
}

struct GivenFile {
    fs::path file;
    Image image;
    ExrMetadata metadata;
};

std::vector<std::string> objections_to(const GivenFile& given, const Shot& shot, int frame) {
    std::vector<std::string> lines;
    const CameraSettings& camera = shot.camera;
    if (given.image.width != camera.width || given.image.height != camera.height)
        lines.push_back(fmt::format("{} is {} x {} pixels, the shot {} x {}", given.file.string(), given.image.width,
                                    given.image.height, camera.width, camera.height));
    const auto stored = given.metadata.text.find(kShot);
    if (stored == given.metadata.text.end())
        return lines;
    for (const std::string& line : scene_differences(stored->second, to_json(shot)))
        // The size has been said.
        if (!line.starts_with("camera.width") && !line.starts_with("camera.height"))
            lines.push_back(fmt::format("{} shows another shot: {}", given.file.string(), line));
    if (given.metadata.frame && *given.metadata.frame != frame)
        lines.push_back(fmt::format("{} is frame {}, not {}", given.file.string(), *given.metadata.frame, frame));
    return lines;
}

void check_given(const std::vector<GivenFile>& given, const Shot& shot, int frame) {
    std::vector<std::string> lines;
    for (const GivenFile& file : given)
        for (const std::string& line : objections_to(file, shot, frame))
            lines.push_back(line);
    if (!lines.empty())
        throw Error(ExitCode::BadData, fmt::format("--reference: {}", fmt::join(lines, "; ")));
}

// The settings of a file that says it was path traced; null for all others.
nlohmann::json tracing_of(const GivenFile& given) {
    const auto stored = given.metadata.text.find(kShot);
    if (stored == given.metadata.text.end())
        return nullptr;
    const auto json = nlohmann::json::parse(stored->second, nullptr, false);
    if (!json.is_object() || json.value("method", "lighting_grid") != "path")
        return nullptr;
    return json.value("tracing", nlohmann::json::object());
}

std::optional<int> seed_of(const GivenFile& given) {
    const nlohmann::json tracing = tracing_of(given);
    return tracing.is_object() ? std::optional(tracing.value("seed", 0)) : std::nullopt;
}

bool is_filtered(const GivenFile& given) {
    const nlohmann::json tracing = tracing_of(given);
    return tracing.is_object() && tracing.value("denoising_radius", 0) > 0;
}

void check_halves(const std::vector<GivenFile>& given, const ReportReference& reference) {
    const Reference& beauty = reference.layers.at("");
    if (!beauty.second)
        return;
    // Half A of one render and half A of another begin with the same paths when they have the same seed.
    const auto half = given[0].metadata.text.find("brisance/half"),
               other = given[1].metadata.text.find("brisance/half");
    const bool same_half = half != given[0].metadata.text.end() && other != given[1].metadata.text.end() &&
                           half->second == other->second && seed_of(given[0]) == seed_of(given[1]);
    if (same_half || beauty.first.pixels == beauty.second->pixels)
        throw Error(ExitCode::BadData,
                    fmt::format("--reference: {} and {} {}: they are no independent halves", given[0].file.string(),
                                given[1].file.string(),
                                same_half ? fmt::format("are both half {}", half->second) : "hold the same pixels"));
}

void notice_origin(const std::vector<GivenFile>& given, ReportReference& reference) {
    for (const GivenFile& file : given) {
        if (!file.metadata.text.contains(kShot)) {
            reference.summary.notices.push_back(fmt::format(
                "{} does not say of which shot it is: that it shows this one is taken on trust", file.file.string()));
            continue;
        }
        if (is_filtered(file))
            reference.summary.notices.push_back(
                fmt::format("{} is filtered (tracing.denoising_radius): it is biased, and errors count its bias",
                            file.file.string()));
        if (const std::optional<int> seed = seed_of(file))
            reference.seeds.insert(*seed);
        else
            reference.summary.notices.push_back(
                fmt::format("{} is no path-traced picture: errors are differences from it, not from the truth",
                            file.file.string()));
    }
}

}  // namespace

const std::vector<std::string>& report_layers() {
    static const std::vector<std::string> layers = [] {
        std::vector<std::string> names = {""};
        names.insert(names.end(), kCellNames.begin(), kCellNames.end());
        return names;
    }();
    return layers;
}

Picture mean_picture(const Reference& reference) {
    Picture mean = reference.first;
    for (std::size_t i = 0; reference.second && i < mean.pixels.size(); ++i)
        mean.pixels[i] = 0.5f * (mean.pixels[i] + reference.second->pixels[i]);
    return mean;
}

ReportReference trace_reference(const Shot& shot, const FrameInput& input, Progress& progress) {
    const CostMeter meter;
    NamedProgress named(progress, "reference");
    const RenderedFrame frame = render_medium(shot, input.medium, named, input.surroundings.get());
    ReportReference reference;
    reference.seeds = {shot.tracing.seed};
    ReferenceSummary& summary = reference.summary;
    summary.cost = meter.cost();
    summary.samples_per_pixel = frame.metadata.samples_per_pixel;
    summary.label = fmt::format("{} spp", summary.samples_per_pixel);
    summary.description =
        fmt::format("method path, {} paths per pixel in two independent halves, with random numbers that no run shares",
                    summary.samples_per_pixel);
    summary.halves = true;
    for (const std::string& warning : frame.statistics.warnings)
        summary.notices.push_back(warning);
    for (const std::string& layer : report_layers())
        if (has_layer(frame.halves[0], layer))
            reference.layers[layer] = {picture_of(frame.halves[0], {layer}).picture,
                                       picture_of(frame.halves[1], {layer}).picture};
    measure_noise(reference);
    return reference;
}

ReportReference read_reference(const std::vector<fs::path>& files, const Shot& shot, int frame) {
    std::vector<GivenFile> given;
    ReportReference reference;
    for (const fs::path& file : files) {
        given.push_back({file, read_exr(file), read_exr_metadata(file)});
        reference.summary.files.push_back(file.string());
    }
    check_given(given, shot, frame);
    for (const std::string& layer : report_layers()) {
        std::optional<Picture> first = layer_of(given[0].image, layer), second;
        if (given.size() > 1)
            second = layer_of(given[1].image, layer);
        if (first && (given.size() == 1 || second))
            reference.layers[layer] = {std::move(*first), std::move(second)};
    }
    if (!reference.layers.contains(""))
        throw Error(ExitCode::BadData, fmt::format("--reference: {} holds no picture", given[0].file.string()));
    check_halves(given, reference);
    notice_origin(given, reference);
    reference.summary.halves = given.size() > 1;
    reference.summary.label = given.size() > 1 ? "two given halves" : "given";
    reference.summary.description =
        given.size() > 1 ? "two given pictures, taken for independent halves" : "one given picture";
    measure_noise(reference);
    if (given.size() == 1)
        noise_from_variance(given[0].image, reference);
    return reference;
}

}  // namespace brisance
