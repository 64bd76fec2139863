#include "time_mapping/source_time.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace brisance {
namespace {

constexpr double kWhole = 1e-6;              // frames
constexpr double kMostFrames = 1'000'000;    // of a picture; more must be a typing mistake
constexpr double kFarthest = 1'000'000'000;  // frame numbers are integers of 32 bits

bool whole(double time) {
    return std::abs(time - std::round(time)) < kWhole;
}

// Slope of the time, per frame of the picture.
double slope(const TimeSettings& settings, double frame) {
    if (settings.curve.empty())
        return settings.speed;
    for (std::size_t i = 1; i < settings.curve.size(); ++i) {
        const TimePoint &a = settings.curve[i - 1], &b = settings.curve[i];
        if (frame >= a.frame && frame < b.frame)
            return (b.source - a.source) / (b.frame - a.frame);
    }
    return 0.0;
}

[[noreturn]] void throw_beyond(const char* side, double frame, double time, const std::vector<int>& on_disk,
                               const std::string& where) {
    const bool before = time < on_disk.front();
    throw Error(
        ExitCode::MissingInput,
        fmt::format("{}: frame {:g} of the picture needs its frame {:.6g}, and the {} on disk is {}; set "
                    "time.{} to hold, repeat, ping_pong or empty, or change time.offset, speed or curve",
                    where, frame, time, before ? "first" : "last", before ? on_disk.front() : on_disk.back(), side));
}

// Brings a time beyond one of the ends to one between them. False: nothing is there.
bool bring_inside(BeyondEnd mode, double first, double last, double& time, double& rate) {
    const double length = last - first;
    switch (mode) {
        case BeyondEnd::Empty:
            return false;
        case BeyondEnd::Repeat: {
            const double period = length + 1.0;
            time -= period * std::floor((time - first + kWhole) / period);
            // Between the last frame and the first, which follows it, lies a cut.
            if (time > last) {
                time = time < last + 0.5 ? last : first;
                rate = 0.0;
            }
            return true;
        }
        case BeyondEnd::PingPong:
            if (length > 0.0) {
                const double phase = (time - first) - 2.0 * length * std::floor((time - first) / (2.0 * length));
                const bool back = phase > length;
                time = first + (back ? 2.0 * length - phase : phase);
                rate = back ? -rate : rate;
                return true;
            }
            [[fallthrough]];
        case BeyondEnd::Hold:
        case BeyondEnd::Error:
            time = std::clamp(time, first, last);
            rate = 0.0;
            return true;
    }
    return true;
}

// Whether a time is that of a frame between the ends that is not there.
bool misses(double time, const std::vector<int>& on_disk) {
    return whole(time) && time > on_disk.front() && time < on_disk.back() &&
           !std::binary_search(on_disk.begin(), on_disk.end(), static_cast<int>(std::lround(time)));
}

SourceTime only(int frame, double rate) {
    return {false, frame, frame, 0.0, rate};
}

// A time between frames that are not neighbours.
SourceTime in_hole(const TimeSettings& settings, int before, int after, double time, double rate, double frame,
                   const std::string& where) {
    if (settings.missing == MissingFrame::Hold)
        return only(before, 0.0);
    if (settings.missing == MissingFrame::Error)
        throw Error(ExitCode::MissingInput,
                    fmt::format("{}: frame {:g} of the picture needs its frame {:.6g}, and after {} the next on disk "
                                "is {}; set time.missing to hold or interpolate, or bring the missing frames",
                                where, frame, time, before, after));
    return {false, before, after, (time - before) / (after - before), rate};
}

}  // namespace

double unbounded_time(const TimeSettings& settings, double frame, int first_on_disk) {
    if (settings.curve.empty())
        return first_on_disk + (frame - first_on_disk) * settings.speed + settings.offset;
    const std::vector<TimePoint>& curve = settings.curve;
    if (frame <= curve.front().frame)
        return curve.front().source + settings.offset;
    for (std::size_t i = 1; i < curve.size(); ++i)
        if (frame < curve[i].frame) {
            const double t = (frame - curve[i - 1].frame) / (curve[i].frame - curve[i - 1].frame);
            return curve[i - 1].source + t * (curve[i].source - curve[i - 1].source) + settings.offset;
        }
    return curve.back().source + settings.offset;
}

SourceTime source_time(const TimeSettings& settings, double frame, const std::vector<int>& on_disk,
                       const std::string& where) {
    double time = unbounded_time(settings, frame, on_disk.front());
    double rate = slope(settings, frame);
    const bool before = time<on_disk.front() - kWhole, after = time> on_disk.back() + kWhole;
    if (before || after) {
        const BeyondEnd mode = before ? settings.before : settings.after;
        if (mode == BeyondEnd::Error || !(std::abs(time) < kFarthest))
            throw_beyond(before ? "before" : "after", frame, time, on_disk, where);
        if (!bring_inside(mode, on_disk.front(), on_disk.back(), time, rate))
            return {true, 0, 0, 0.0, 0.0};
    }
    if (whole(time))
        time = std::round(time);
    const auto next = std::lower_bound(on_disk.begin(), on_disk.end(), time);
    const int upper = next == on_disk.end() ? on_disk.back() : *next;
    if (upper == time || next == on_disk.begin() || next == on_disk.end())
        return only(upper, rate);
    const int lower = *(next - 1);
    const SourceTime between = upper - lower > 1 ? in_hole(settings, lower, upper, time, rate, frame, where)
                                                 : SourceTime{false, lower, upper, time - lower, rate};
    return settings.retime == Retime::Nearest ? only(between.nearest(), rate) : between;
}

std::vector<int> covering_frames(const TimeSettings& settings, const std::vector<int>& on_disk,
                                 const std::string& where) {
    const double origin = on_disk.front();
    double low = 0.0, high = 0.0;
    if (!settings.curve.empty()) {
        low = settings.curve.front().frame;
        high = settings.curve.back().frame;
    } else if (settings.speed > 0.0) {
        low = origin - settings.offset / settings.speed;
        high = low + (on_disk.back() - origin) / settings.speed;
    } else {
        low = high = origin;  // all show the same time
    }
    if (!(high - low < kMostFrames) || !(std::max(std::abs(low), std::abs(high)) < kFarthest))
        throw Error(ExitCode::Usage, fmt::format("{}: the picture would have {:.3g} frames; choose some with -f", where,
                                                 high - low + 1.0));
    std::vector<int> frames;
    for (int f = static_cast<int>(std::ceil(low - kWhole)); f <= static_cast<int>(std::floor(high + kWhole)); ++f)
        if (settings.missing != MissingFrame::Error || !misses(unbounded_time(settings, f, on_disk.front()), on_disk))
            frames.push_back(f);
    return frames;
}

bool may_interpolate(const TimeSettings& settings, const std::vector<int>& on_disk) {
    if (settings.retime == Retime::Nearest || on_disk.size() < 2)
        return false;
    if (settings.missing == MissingFrame::Interpolate && on_disk.back() - on_disk.front() >= int(on_disk.size()))
        return true;
    if (settings.curve.empty())
        return !whole(settings.offset) || !whole(settings.speed);
    return true;
}

}  // namespace brisance
