// Progress reports of a render for a terminal or a log. Everything goes to standard error.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

#include "core/progress.h"

namespace brisance {

enum class ProgressStyle {
    Automatic,  // Bar on a terminal, Plain otherwise
    Bar,        // one line, redrawn
    Plain,      // whole lines only: one per stage, and one per ten percent of slow stages
    None        // notices and warnings only
};

class TextProgress : public Progress {
public:
    explicit TextProgress(ProgressStyle style);
    ~TextProgress() override;
    TextProgress(const TextProgress&) = delete;
    TextProgress& operator=(const TextProgress&) = delete;

    // Later stages belong to this frame, `index` counting from 0 of `count`, read from `file`.
    void begin_frame(int frame, const std::string& file, std::size_t index, std::size_t count);

    void stage(const std::string& name) override;
    void fraction(double done) override;
    void notice(const std::string& line) override;
    void warning(const std::string& code, const std::string& line) override;

    // A line on standard error between those of the progress.
    void say(const std::string& line);

    // Ends the bar, and prints how often every repeated warning occurred.
    void finish();

private:
    using Clock = std::chrono::steady_clock;

    void print_line(const std::string& line);
    void draw_bar();
    void clear_bar();
    double seconds() const;

    ProgressStyle style_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_line_{};
    std::mutex mutex_;
    std::string frame_;
    std::string stage_;
    std::atomic<int> percent_{-1};
    int printed_percent_ = 0;
    bool bar_shown_ = false;
    std::map<std::string, std::uint64_t> warnings_;  // line: times given
    std::map<std::string, std::uint64_t> notices_;
};

}  // namespace brisance
