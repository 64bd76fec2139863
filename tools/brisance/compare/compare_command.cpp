#include "compare/compare_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "compare/compare_report.h"
#include "compare/motion_source.h"
#include "compare/spectrum_page.h"
#include "core/error.h"
#include "film/whole_file.h"
#include "film/write_image.h"
#include "metrics/false_colour.h"
#include "metrics/layers.h"
#include "shot/scene_differences.h"
#include "volume/frame_path.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

const char* const kShot = "brisance/shot";

struct FrameFiles {
    int frame = 0;  // of the file's name
    fs::path image;
    std::vector<fs::path> references;
    fs::path flip_map;  // empty: not wanted
};

struct Loaded {
    fs::path file;
    Image image;
    ExrMetadata metadata;
};

// Why images cannot be compared; what --force sets aside is kept apart.
struct Objections {
    std::vector<std::string> fixed;
    std::vector<std::string> scene;
};

// Each line once, however many frames give rise to it.
void notice(const std::string& line) {
    static std::set<std::string> printed;
    if (printed.insert(line).second)
        fmt::print(stderr, "notice: {}\n", line);
}

std::string shown_layers(const std::vector<std::string>& layers) {
    std::string names;
    for (const std::string& layer : layers)
        names += (names.empty() ? "" : ", ") + shown_layer(layer);
    return names;
}

std::vector<FrameFiles> files_of(const CompareOptions& options) {
    const std::optional<std::vector<int>> requested =
        options.frames.empty() ? std::nullopt : std::optional(parse_frames(options.frames));
    const std::vector<FrameFile> images = resolve_sequence(options.image, requested);
    for (const std::string& pattern : options.references)
        if (images.size() > 1 && !has_frame_token(pattern))
            throw Error(ExitCode::Usage, fmt::format("{} is one reference for {} frames; put #### where the frame "
                                                     "number goes",
                                                     pattern, images.size()));
    if (images.size() > 1 && !options.flip_map.empty() && !has_frame_token(options.flip_map))
        throw Error(ExitCode::Usage, fmt::format("--flip-map: several frames would be written to {}; put #### where "
                                                 "the frame number goes",
                                                 options.flip_map));
    if (!options.flip_map.empty() && fs::path(options.flip_map).extension() != ".png")
        throw Error(ExitCode::Usage, fmt::format("--flip-map must end in .png: {}", options.flip_map));
    std::vector<FrameFiles> frames;
    for (const FrameFile& image : images) {
        frames.push_back({image.frame, image.file, {}, {}});
        for (const std::string& pattern : options.references)
            frames.back().references.push_back(has_frame_token(pattern) ? resolve_frame(pattern, image.frame)
                                                                        : fs::path(pattern));
        if (!options.flip_map.empty()) {
            frames.back().flip_map = expand(options.flip_map, image.frame);
            check_writable(frames.back().flip_map);
        }
    }
    return frames;
}

Loaded load(const fs::path& file) {
    return {file, read_exr(file), read_exr_metadata(file)};
}

void compare_scenes(const Loaded& a, const Loaded& b, Objections& objections) {
    const auto shot_a = a.metadata.text.find(kShot), shot_b = b.metadata.text.find(kShot);
    if (shot_a == a.metadata.text.end() || shot_b == b.metadata.text.end())
        return;
    std::vector<std::string> lines;
    try {
        lines = scene_differences(shot_a->second, shot_b->second);
    } catch (const Error& error) {
        lines = {error.what()};
    }
    if (a.metadata.frame != b.metadata.frame)
        lines.push_back(
            fmt::format("frame: {} against {}", a.metadata.frame.value_or(0), b.metadata.frame.value_or(0)));
    if (!lines.empty())
        objections.scene.push_back(fmt::format("{} and {} show different shots: {}", a.file.string(), b.file.string(),
                                               fmt::join(lines, "; ")));
}

void notice_missing_shots(const std::vector<const Loaded*>& files) {
    std::vector<std::string> without;
    for (const Loaded* file : files)
        if (!file->metadata.text.contains(kShot))
            without.push_back(file->file.string());
    if (!without.empty())
        notice(fmt::format("{} without a shot of Brisance: whether {} the same scene cannot be checked",
                           fmt::join(without, ", "), without.size() == 1 ? "it shows" : "they show"));
}

std::vector<std::string> split(const std::string& sum) {
    std::vector<std::string> names;
    std::size_t begin = 0;
    for (std::size_t plus = sum.find('+'); plus != std::string::npos; plus = sum.find('+', begin)) {
        names.push_back(sum.substr(begin, plus - begin));
        begin = plus + 1;
    }
    names.push_back(sum.substr(begin));
    for (std::string& name : names)
        if (name == "beauty")
            name.clear();
    return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// A file with a single picture, as other renderers write them, stands for whatever layer is requested.
std::vector<std::string> parts_in(const Loaded& reference, const std::string& layers) {
    const std::vector<std::string> there = picture_layers(reference.image);
    return there.size() == 1 ? there : split(layers);
}

void require_layers(const Loaded& file, const std::vector<std::string>& parts, Objections& objections) {
    const std::vector<std::string> there = picture_layers(file.image);
    std::vector<std::string> missing;
    for (const std::string& part : parts)
        if (!contains(there, part))
            missing.push_back(shown_layer(part));
    if (!missing.empty())
        objections.fixed.push_back(fmt::format("{} has no layer {}; it has {}", file.file.string(),
                                               fmt::join(missing, ", "), shown_layers(there)));
}

// Layers that all files have.
std::vector<std::string> common_layers(const std::vector<const Loaded*>& files, Objections& objections) {
    std::vector<std::string> common = picture_layers(files.front()->image);
    std::set<std::string> left_out(common.begin(), common.end());
    for (const Loaded* file : files) {
        const std::vector<std::string> there = picture_layers(file->image);
        left_out.insert(there.begin(), there.end());
        std::erase_if(common, [&](const std::string& name) { return !contains(there, name); });
    }
    for (const std::string& name : common)
        left_out.erase(name);
    if (common.empty() || (common.size() == 1 && common.front().empty())) {
        std::string had;
        for (const Loaded* file : files)
            had += fmt::format("{}{} has {}", had.empty() ? "" : ", ", file->file.string(),
                               shown_layers(picture_layers(file->image)));
        objections.fixed.push_back("no layers besides the beauty are common to all: " + had);
    } else if (!left_out.empty()) {
        notice(
            fmt::format("not in every image, and not compared: {}", shown_layers({left_out.begin(), left_out.end()})));
    }
    return common;
}

// What to compare, each a layer or a sum of layers. Every reason against comparing is added to `objections`.
std::vector<std::string> layers_to_compare(const CompareOptions& options, const std::vector<const Loaded*>& files,
                                           Objections& objections) {
    if (options.cells)
        return common_layers(files, objections);
    require_layers(*files.front(), split(options.layers), objections);
    for (std::size_t i = 1; i < files.size(); ++i)
        require_layers(*files[i], parts_in(*files[i], options.layers), objections);
    return {options.layers};
}

void compare_sizes(const Loaded& image, const Loaded& reference, Objections& objections) {
    const Image &a = image.image, &b = reference.image;
    if (a.width != b.width || a.height != b.height)
        objections.fixed.push_back(fmt::format("{} is {} x {} pixels, {} {} x {}", image.file.string(), a.width,
                                               a.height, reference.file.string(), b.width, b.height));
}

// Throws unless the images can be compared, and ought to be or are forced to.
void settle(const Objections& objections, bool force, CompareReport& report) {
    std::vector<std::string> reasons = objections.fixed;
    if (!force)
        for (const std::string& reason : objections.scene)
            reasons.push_back(reason + (objections.fixed.empty() ? " (--force compares them all the same)" : ""));
    if (!reasons.empty())
        throw Error(ExitCode::BadData, fmt::format("{}", fmt::join(reasons, "; ")));
    for (const std::string& reason : objections.scene) {
        notice(reason);
        report.overruled.push_back(reason);
    }
}

FrameAndReference layer_and_reference(const Loaded& image, const std::vector<Loaded>& references,
                                      const std::string& layers) {
    std::vector<LayerPicture> pictures = {picture_of(image.image, split(layers))};
    for (const Loaded& reference : references)
        pictures.push_back(picture_of(reference.image, parts_in(reference, layers)));
    if (std::any_of(pictures.begin(), pictures.end(), [](const LayerPicture& p) { return p.gray; }))
        for (LayerPicture& picture : pictures)
            to_gray(picture.picture);
    FrameAndReference pair{std::move(pictures[0].picture), {std::move(pictures[1].picture), std::nullopt}};
    if (pictures.size() > 2)
        pair.reference.second = std::move(pictures[2].picture);
    return pair;
}

// The same file given twice would make the noise seem to be 0.
void check_halves(const Reference& reference, const std::vector<Loaded>& references) {
    if (!reference.second)
        return;
    const std::vector<Rgb>&a = reference.first.pixels, &b = reference.second->pixels;
    const bool black = std::all_of(a.begin(), a.end(), [](const Rgb& pixel) { return pixel == Rgb(0.0f); });
    if (a == b && !black)
        throw Error(ExitCode::BadData,
                    fmt::format("{} and {} hold the same pixels: they are not independent halves of a reference",
                                references[0].file.string(), references[1].file.string()));
}

// A frame's layers with their references, and what is needed to follow its points into the next frame.
struct ComparedPictures {
    std::vector<std::pair<std::string, FrameAndReference>> layers;
    MotionSource motion;
};

ComparedPictures load_frame(const CompareOptions& options, const FrameFiles& files, bool first, CompareReport& report) {
    const Loaded image = load(files.image);
    std::vector<Loaded> references;
    for (const fs::path& file : files.references)
        references.push_back(load(file));
    std::vector<const Loaded*> all = {&image};
    Objections objections;
    for (const Loaded& reference : references) {
        compare_sizes(image, reference, objections);
        compare_scenes(image, reference, objections);
        all.push_back(&reference);
    }
    if (first)
        notice_missing_shots(all);
    const std::vector<std::string> layers = layers_to_compare(options, all, objections);
    settle(objections, options.force, report);
    ComparedPictures result;
    for (const std::string& layer : layers)
        result.layers.emplace_back(layer, layer_and_reference(image, references, layer));
    check_halves(result.layers.front().second.reference, references);
    if (has_frame_token(options.image))
        result.motion = motion_source(image.file, image.image, image.metadata, options.motion);
    const bool numbered = has_frame_token(options.image);
    report.frames.push_back({numbered ? std::optional(files.frame) : image.metadata.frame,
                             files.image,
                             files.references,
                             image.metadata.render_seconds,
                             {}});
    return result;
}

void compare_frame(const CompareOptions& options, const FrameFiles& files, const ComparedPictures& pictures,
                   ComparedFrame& frame) {
    for (const auto& [layer, pair] : pictures.layers) {
        Comparison comparison = compare(pair.image, pair.reference, options.pixels_per_degree);
        if (frame.layers.empty() && !files.flip_map.empty())
            write_png(files.flip_map, pair.image.width, pair.image.height, false_colours(comparison.flip.errors));
        // A sequence need not hold the maps of all its frames.
        comparison.flip.errors.values.clear();
        comparison.flip.worst_exposures.clear();
        frame.layers.emplace_back(layer, std::move(comparison));
    }
}

ComparedChange compare_step(const FrameFiles& files, const ComparedPictures& before, const FrameFiles& next_files,
                            const ComparedPictures& next) {
    ComparedChange change{files.frame, next_files.frame, {}};
    const std::optional<Motion> motion = motion_between(before.motion, next.motion);
    if (!motion)
        notice(
            "no flicker is measured: the images lack a depth Z or the camera worldToNDC; --motion names a layer of "
            "motion vectors");
    for (const auto& [layer, pair] : before.layers)
        for (const auto& [next_layer, next_pair] : next.layers)
            if (layer == next_layer) {
                ChangeErrors errors{compare_changes(pair, next_pair), std::nullopt};
                if (motion)
                    errors.flicker = measure_flicker(pair, next_pair, *motion);
                change.layers.emplace_back(layer, std::move(errors));
            }
    return change;
}

// Errors over time by layer. A layer that some frame lacks has none.
class Spectra {
public:
    explicit Spectra(std::size_t frames) : frames_(frames) {}
    void add(const ComparedPictures& pictures) {
        if (frames_ >= kSpectrumFrames)
            for (const auto& [layer, pair] : pictures.layers)
                errors_[layer].add(pair);
    }
    std::vector<std::pair<std::string, TemporalSpectrum>> spectra() const {
        std::vector<std::pair<std::string, TemporalSpectrum>> result;
        for (const auto& [layer, errors] : errors_)
            if (errors.frames() == frames_)
                result.emplace_back(layer, errors.spectrum());
        return result;
    }

private:
    std::size_t frames_;
    std::map<std::string, ErrorOverTime> errors_;
};

}  // namespace

int run_compare(const CompareOptions& options) {
    const std::vector<FrameFiles> files = files_of(options);
    std::vector<Limit> limits;
    for (const std::string& limit : options.limits)
        limits.push_back(parse_limit(limit, options.references.size() > 1, files.size() > 1));
    if (!options.spectrum.empty() && files.size() < kSpectrumFrames)
        throw Error(ExitCode::Usage,
                    fmt::format("--spectrum: {} frames are too few; {} are needed", files.size(), kSpectrumFrames));
    if (!options.spectrum.empty())
        check_writable(options.spectrum);
    CompareReport report;
    report.pixels_per_degree = options.pixels_per_degree;
    ComparedPictures before;
    Spectra spectra(files.size());
    for (std::size_t i = 0; i < files.size(); ++i) {
        ComparedPictures pictures = load_frame(options, files[i], i == 0, report);
        compare_frame(options, files[i], pictures, report.frames.back());
        spectra.add(pictures);
        if (i > 0)
            report.changes.push_back(compare_step(files[i - 1], before, files[i], pictures));
        before = std::move(pictures);
    }
    report.spectra = spectra.spectra();
    if (!options.spectrum.empty())
        write_text(options.spectrum,
                   spectrum_page(options.image + " against " + options.references.front(), report.spectra));
    const std::vector<std::string> exceeded = exceeded_limits(report, limits);
    std::fputs((options.as_json ? report_json(report, exceeded) : report_text(report)).c_str(), stdout);
    for (const std::string& line : exceeded)
        fmt::print(stderr, "brisance: {}\n", line);
    return static_cast<int>(exceeded.empty() ? ExitCode::Success : ExitCode::RenderFailed);
}

}  // namespace brisance
