#include "sequence_clock.h"

#include <algorithm>

namespace brisance {

namespace {

constexpr double kAlmost = 0.99;

double seconds_between(SequenceClock::Clock::time_point a, SequenceClock::Clock::time_point b) {
    return std::chrono::duration<double>(b - a).count();
}

}  // namespace

double SequenceClock::seconds() const {
    return seconds_between(begin_, Clock::now());
}

std::optional<double> SequenceClock::seconds_per_frame() const {
    if (done_ == 0)
        return std::nullopt;
    return seconds_between(begin_, finished_at_) / double(done_);
}

double SequenceClock::part_of_frame() const {
    const std::optional<double> each = seconds_per_frame();
    const double by_time = each && *each > 0.0 ? seconds_between(frame_begin_, Clock::now()) / *each : 0.0;
    return std::min(std::max(part_, by_time), kAlmost);
}

double SequenceClock::share() const {
    if (frames_ == 0 || done_ >= frames_)
        return 1.0;
    return (double(done_) + part_of_frame()) / double(frames_);
}

std::optional<double> SequenceClock::seconds_left() const {
    const std::optional<double> each = seconds_per_frame();
    if (!each || done_ >= frames_)
        return each ? std::optional(0.0) : std::nullopt;
    return *each * (double(frames_ - done_) - part_of_frame());
}

}  // namespace brisance
