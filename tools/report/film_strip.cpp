#include "film_strip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "metrics/layers.h"
#include "named_progress.h"
#include "render/render_frame.h"
#include "render/still_variants.h"

namespace brisance {
namespace {

const dvec3 kMovePerFrame(3, 5, 7);  // voxels: bricks and the levels of hierarchies lie elsewhere in the smoke
constexpr int kSeedsPerFrame = 104729;

bool finite(const Rgb& pixel) {
    return std::isfinite(pixel.x) && std::isfinite(pixel.y) && std::isfinite(pixel.z);
}

bool finite_in_all(std::span<const Picture> frames, std::size_t pixel) {
    return std::ranges::all_of(frames, [&](const Picture& frame) { return finite(frame.pixels[pixel]); });
}

// Half of the mean squared change of a pixel from frame to frame, of each channel.
dvec3 variance_in_time(std::span<const Picture> frames, std::size_t pixel) {
    dvec3 sum(0.0);
    for (std::size_t n = 1; n < frames.size(); ++n) {
        const dvec3 change = dvec3(frames[n].pixels[pixel]) - dvec3(frames[n - 1].pixels[pixel]);
        sum += change * change;
    }
    return sum / (2.0 * static_cast<double>(frames.size() - 1));
}

// Of the true picture: free of the reference's noise where that can be had.
double squared_radiance(const Reference& reference, std::size_t pixel) {
    const dvec3 a(reference.first.pixels[pixel]);
    return glm::dot(a, reference.second ? dvec3(reference.second->pixels[pixel]) : a);
}

bool holds_light(const Reference& reference) {
    return std::ranges::any_of(mean_picture(reference).pixels, [](const Rgb& pixel) { return pixel != Rgb(0.0f); });
}

const PlannedRun& first_run(const std::vector<PlannedMethod>& methods, const Method& method) {
    return std::ranges::find(methods, method.label, [](const PlannedMethod& m) { return m.method.label; })
        ->runs.front();
}

Image rendered(const Shot& shot, const FrameInput& input, Progress& progress) {
    return render_medium(by_its_method_alone(shot), input.medium, progress, input.surroundings.get()).image;
}

// One further frame of every method.
void add_frames(int frame, const StripRequest& request, const Shot& shot, const std::vector<PlannedMethod>& methods,
                const ReportReference& reference, FilmStrips& strips, Report& report, Progress& progress) {
    const Shot moved_shot = frame_of_strip(shot, frame, request.voxel);
    const std::string name = fmt::format("frame {} of {}", frame + 1, request.frames);
    Statistics unused;
    const FrameInput input = load_frame(moved_shot, request.file.file, request.file.frame, unused, progress);
    for (const MethodResult& result : report.methods) {
        const PlannedRun& run = first_run(methods, result.method);
        try {
            NamedProgress named(progress, fmt::format("{}, {}, {}", result.method.label, run.step.label, name));
            const Shot frame_shot = frame_of_strip(run.shot, frame, request.voxel);
            strips.add_frame(result.method, rendered(frame_shot, input, named), reference);
        } catch (const std::exception& error) {
            report.failures.push_back({result.method.label, fmt::format("{}: {}", name, reason_of(error))});
        }
    }
}

}  // namespace

Shot frame_of_strip(const Shot& shot, int frame, double voxel) {
    if (frame == 0)
        return shot;
    const Shot reseeded_shot = reseeded(shot, frame * kSeedsPerFrame);
    return voxel > 0.0 ? moved(reseeded_shot, double(frame) * voxel * kMovePerFrame) : reseeded_shot;
}

double flicker_of(std::span<const Picture> frames, const Reference& reference) {
    if (frames.size() < 2)
        return std::numeric_limits<double>::quiet_NaN();
    double change = 0.0, light = 0.0;
    for (std::size_t i = 0; i < frames.front().pixels.size(); ++i)
        if (finite_in_all(frames, i)) {
            const dvec3 variance = variance_in_time(frames, i);
            change += variance.x + variance.y + variance.z;
            light += squared_radiance(reference, i);
        }
    return light > 0.0 ? std::sqrt(change / light) : std::numeric_limits<double>::quiet_NaN();
}

Plane flicker_map(std::span<const Picture> frames, const Reference& reference) {
    const Picture truth = mean_picture(reference);
    Picture changed = truth;
    for (std::size_t i = 0; i < changed.pixels.size(); ++i)
        changed.pixels[i] += Rgb(glm::sqrt(variance_in_time(frames, i)));
    return relative_error_map(changed, truth, measure_differences(truth.pixels, truth.pixels).epsilon);
}

void FilmStrips::add_frame(const Method& method, const Image& image, const ReportReference& reference) {
    const std::vector<std::string> there = picture_layers(image);
    for (const auto& [cell, target] : reference.layers)
        if (owns(method, cell) && std::ranges::find(there, cell) != there.end() && holds_light(target))
            frames_[method.label][cell].push_back(picture_of(image, {cell}).picture);
}

const std::map<std::string, std::vector<Picture>>& FilmStrips::of(const Method& method) const {
    static const std::map<std::string, std::vector<Picture>> none;
    const auto found = frames_.find(method.label);
    return found == frames_.end() ? none : found->second;
}

void measure_strips(const StripRequest& request, const Shot& shot, const std::vector<PlannedMethod>& methods,
                    const ReportReference& reference, FilmStrips& strips, Report& report, PagePictures& pictures,
                    Progress& progress) {
    for (int frame = 1; frame < request.frames; ++frame)
        add_frames(frame, request, shot, methods, reference, strips, report, progress);
    report.strip_frames = request.frames;
    for (MethodResult& result : report.methods)
        for (const auto& [cell, frames] : strips.of(result.method)) {
            if (static_cast<int>(frames.size()) < request.frames)
                continue;  // a frame failed
            const Reference& target = reference.layers.at(cell);
            result.flicker[cell] = flicker_of(frames, target);
            pictures.add_strip(result.runs.front().id, cell, frames, flicker_map(frames, target),
                               exposure_for(mean_picture(target)));
        }
}

}  // namespace brisance
