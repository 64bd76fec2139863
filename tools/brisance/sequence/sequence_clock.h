// How far a sequence is: its share done, its rate, the time left.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

namespace brisance {

class SequenceClock {
public:
    using Clock = std::chrono::steady_clock;

    void begin(std::size_t frames) {
        frames_ = frames;
        begin_ = frame_begin_ = Clock::now();
    }
    void begin_frame() {
        frame_begin_ = Clock::now();
        part_ = 0.0;
    }
    void end_frame() { end_frames(1); }
    void end_frames(std::size_t count) {
        done_ += count;
        part_ = 0.0;
        finished_at_ = frame_begin_ = Clock::now();
    }
    // What is known of the frame under way, 0 to 1. Otherwise it is taken from the time of the frames before it.
    void set_part(double part) { part_ = part; }

    std::size_t frames() const { return frames_; }
    std::size_t done() const { return done_; }
    double seconds() const;
    // Of the frames that are done; none before the first.
    std::optional<double> seconds_per_frame() const;
    // 0 to 1, of all frames. It is 1 only once all are done.
    double share() const;
    std::optional<double> seconds_left() const;

private:
    double part_of_frame() const;

    std::size_t frames_ = 0, done_ = 0;
    double part_ = 0.0;
    Clock::time_point begin_ = Clock::now(), frame_begin_ = begin_, finished_at_ = begin_;
};

}  // namespace brisance
