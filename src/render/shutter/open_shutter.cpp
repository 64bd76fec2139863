#include "render/shutter/open_shutter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "camera/shutter.h"
#include "core/available_memory.h"
#include "motion/mean_fire.h"
#include "render/shutter/screen_movement.h"

namespace brisance {

namespace {

// Movement that no pixel shows.
constexpr double kStill = 1.0 / 16.0;  // [pixels]

// Of a moment's medium: itself, its records for the camera, and the tables of paths through it.
constexpr std::uint64_t kCopies = 4;
// Of the memory that there is, for all moments.
constexpr double kShareOfMemory = 0.5;

bool moves(const MovingMedium* moving, const std::array<Instant, 3>& instants) {
    const auto differs = [&](const auto& part) { return part(instants[0]) != part(instants[2]); };
    return moving || differs([](const Instant& i) { return i.surroundings; }) ||
           !stand_still(instants[0].camera->settings(), instants[2].camera->settings());
}

// Moments that fit into memory, if each has a medium of its own.
std::size_t moments_in_memory(const MovingMedium* moving, const Medium& medium) {
    const std::optional<std::uint64_t> available = available_memory();
    if (!moving || !available || medium.lattice.empty())
        return std::numeric_limits<std::size_t>::max();
    return static_cast<std::size_t>(kShareOfMemory * double(*available) / double(kCopies * medium.bytes()));
}

// Moments, a multiple of `lightings`, no more than a pixel apart or the most that the shot and memory allow.
std::size_t moment_count(const ShutterSettings& settings, double pixels, std::size_t in_memory, Progress& progress) {
    const auto wanted = static_cast<std::size_t>(std::clamp(std::ceil(pixels), 2.0, 1e6));
    const std::size_t most = std::max<std::size_t>(2, std::min<std::size_t>(settings.most_moments, in_memory));
    const std::size_t count = std::min(wanted, most);
    const auto lightings = static_cast<std::size_t>(settings.lighting_times);
    const std::size_t whole = (count + lightings - 1) / lightings * lightings;
    progress.notice(fmt::format("motion blur: {:.3g} pixels of movement at {} moments", pixels, whole));
    if (count < wanted && in_memory < static_cast<std::size_t>(settings.most_moments))
        progress.warning("shutter", fmt::format("there is memory for {} moments of the open shutter, {:.2g} pixels "
                                                "apart",
                                                count, pixels / double(count)));
    else if (count < wanted)
        progress.notice(
            fmt::format("moments are {:.2g} pixels apart where movement is fastest; raise "
                        "shutter.most_moments for smoother streaks",
                        pixels / double(count)));
    return whole;
}

}  // namespace

OpenShutter::OpenShutter(const ShutterSettings& settings, const Medium& medium, const Surroundings* surroundings,
                         const CameraSettings& camera, const Animation& animation, Progress& progress)
    : medium_(medium), surroundings_(surroundings), camera_(camera), animation_(animation) {
    if (!(settings.length > 0.0) || (medium.velocity.empty() && !animation.camera && !animation.surroundings))
        return;
    const ShutterSpan span = shutter_span(settings);
    if (!medium.velocity.empty())
        moving_ = std::make_unique<MovingMedium>(medium, std::max(std::abs(span.opens), std::abs(span.closes)));
    if (moving_ && !(moving_->largest_distance() > 0.0f))
        moving_.reset();
    std::array<Instant, 3> instants;
    for (int k = 0; k < 3; ++k)
        instants[k] = at(span.opens + 0.5 * k * (span.closes - span.opens), false);
    const double pixels = moves(moving_.get(), instants) ? largest_movement(medium, instants) : 0.0;
    if (pixels < kStill) {
        progress.notice("motion blur: nothing moves by a sixteenth of a pixel; the frame is drawn as a still");
        moving_.reset();
        return;
    }
    lightings_ = static_cast<std::size_t>(settings.lighting_times);
    const std::size_t count = moment_count(settings, pixels, moments_in_memory(moving_.get(), medium), progress);
    for (const double frames : shutter_moments(settings, static_cast<int>(count)))
        instants_.push_back(at(frames, true));
    for (const Instant& i : instants_)
        moments_.push_back({i.medium, i.surroundings, i.camera.get()});
}

Instant OpenShutter::at(double frames, bool with_medium) const {
    Instant out;
    out.frames = frames;
    out.medium = &medium_;
    out.surroundings = surroundings_;
    if (with_medium && moving_ && frames != 0.0) {
        out.own_medium = std::make_unique<Medium>(moving_->at(frames));
        out.medium = out.own_medium.get();
    }
    if (animation_.surroundings && frames != 0.0) {
        out.own_surroundings = animation_.surroundings(frames);
        out.surroundings = out.own_surroundings.get();
    }
    out.camera = std::make_unique<Camera>(animation_.camera ? animation_.camera(frames) : camera_, medium_);
    return out;
}

Instant OpenShutter::lit(std::size_t lighting) const {
    const std::size_t each = instants_.size() / lightings_;
    const std::span<const Instant> stretch(&instants_[lighting * each], each);
    double middle = 0.0;
    for (const Instant& i : stretch)
        middle += i.frames / double(each);
    Instant out = at(std::abs(middle) < 1e-9 ? 0.0 : middle, true);
    if (moving_ && out.medium->emits()) {
        std::vector<const Medium*> media;
        for (const Instant& i : stretch)
            media.push_back(i.medium);
        out.own_medium =
            std::make_unique<Medium>(with_mean_fire(out.own_medium ? std::move(*out.own_medium) : *out.medium, media));
        out.medium = out.own_medium.get();
    }
    return out;
}

Origins OpenShutter::origins(const Instant& lit, const Instant& moment) const {
    return moving_->origins(moment.medium->lattice, moment.frames - lit.frames);
}

}  // namespace brisance
