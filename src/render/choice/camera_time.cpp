#include "render/choice/camera_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "render/frame_picture.h"

namespace brisance {

namespace {

// Samples along a pixel's side. Automatic ones shade few of sixteen where those suffice.
constexpr int kAutomatic = 0;
constexpr int kFiner[] = {5, 6, 8};
// Four samples a pixel take at least so many times as long as one.
constexpr double kLeastGrowth = 1.5;

// Of the picture's pixels, those of the smallest timed one, but no fewer than these; larger ones follow while they take
// no more than this part of the time that is left. Time grows with pixels as between the two largest.
constexpr double kPart = 1.0 / 64.0, kFewestPixels = 2000.0, kLarger = 4.0, kTimed = 0.08;
// Times of small pictures are short, and differ from run to run.
constexpr double kSmallPictures = 1.2;

constexpr const char* kChoosingSamples = "choice of the samples";

class TimedPictures {
public:
    // `end`: on the watch.
    TimedPictures(const DrawInput& input, const ManyLights& lights, double end, const Stopwatch& watch)
        : input_(input), lights_(lights), full_(input.camera.settings()), shot_(input.shot), end_(end), watch_(watch) {
        shot_.output.virtual_lights = shot_.output.bounce_layers = false;
        first_part_ = std::min(1.0, std::max(kPart, kFewestPixels / (double(full_.width) * full_.height)));
        time(1, first_part_);  // what is made once and kept is no part of a picture's time
    }

    double left() const { return end_ - watch_.seconds(); }

    // Of the whole picture [s].
    double seconds(int side) const {
        double part = first_part_, taken = time(side, part), of_all = taken / part;
        const auto of_more = [&] { return (kLarger - 1.0) * part * of_all; };
        while (kLarger * part < 1.0 && taken + of_more() <= kTimed * left()) {
            const double larger = time(side, kLarger * part);
            of_all = std::max(0.0, larger - taken) / ((kLarger - 1.0) * part);
            taken = larger;
            part *= kLarger;
        }
        return kSmallPictures * (taken + (1.0 - part) * of_all);
    }

    CameraSettings with_side(int side) const {
        CameraSettings settings = full_;
        settings.samples_per_axis = side;
        // Samples of edges are all shaded, which takes longer than automatic ones in between.
        if (side != kAutomatic)
            settings.edge_refinement = 1;
        return settings;
    }

private:
    double time(int side, double part) const {
        CameraSettings settings = with_side(side);
        settings.width = std::max(1, static_cast<int>(std::lround(std::sqrt(part) * full_.width)));
        settings.height = std::max(1, static_cast<int>(std::lround(std::sqrt(part) * full_.height)));
        const Camera camera(settings, input_.medium);
        const DrawInput small{shot_, input_.plan, input_.medium, input_.surroundings, camera};
        Progress silent;
        Statistics unused;
        const Stopwatch watch;
        FramePicture(small, lights_, nullptr, silent).draw(unused, {});
        const double pixels = double(settings.width) * settings.height;
        return watch.seconds() * part * double(full_.width) * full_.height / pixels;
    }

    const DrawInput& input_;
    const ManyLights& lights_;
    const CameraSettings& full_;
    Shot shot_;
    double end_;
    const Stopwatch& watch_;
    double first_part_;  // of the pixels
};

struct Choice {
    int side = 1;
    double seconds = 0.0;  // of the picture, expected
};

Choice choose(const TimedPictures& pictures) {
    Choice best{1, pictures.seconds(1)};
    const auto fits = [&](double seconds) { return seconds <= pictures.left(); };
    if (!fits(kLeastGrowth * best.seconds))
        return best;
    const double of_two = pictures.seconds(2);
    const auto take = [&](int side, double seconds) {
        if (fits(seconds))
            best = {side, std::max(best.seconds, seconds)};
        return fits(seconds);
    };
    if (!take(2, of_two))
        return best;
    // Where all samples are shaded, time grows with their number.
    const auto of_side = [&](int side) { return of_two * side * side / 4.0; };
    if (!take(kAutomatic, pictures.seconds(kAutomatic))) {
        take(3, of_side(3));
        return best;
    }
    for (const int side : kFiner)
        take(side, of_side(side));
    return best;
}

}  // namespace

bool samples_follow_time(const Shot& shot, const Plan& plan, const CameraSettings& camera) {
    return !plan.scattering_method && camera.samples_per_axis == 0 && shot.virtual_lights.passes == 1;
}

CameraSettings camera_for_time(const DrawInput& input, const ManyLights& lights, double seconds, Statistics& statistics,
                               Progress& progress) {
    progress.stage(kChoosingSamples);
    const Stopwatch watch;
    const TimedPictures pictures(input, lights, seconds, watch);
    const Choice choice = choose(pictures);
    const double left = pictures.left();
    const std::string side = choice.side == kAutomatic ? "auto" : fmt::format("{}", choice.side);
    progress.notice(
        fmt::format("seconds: lights are there, {:.3g} s are left for the camera; "
                    "camera.samples_per_axis={} should take {:.2g} s",
                    std::max(0.0, left), side, choice.seconds));
    if (choice.side == 1 && choice.seconds > left)
        progress.warning(
            "seconds",
            fmt::format("the time may not suffice: {:.2g} s are left, and one sample a pixel takes up to {:.2g} s",
                        std::max(0.0, left), choice.seconds));
    statistics.stages.push_back(
        {kChoosingSamples, watch.seconds(), 0, {{"samples_per_axis", side}, {"forecast_seconds", choice.seconds}}});
    return pictures.with_side(choice.side);
}

}  // namespace brisance
