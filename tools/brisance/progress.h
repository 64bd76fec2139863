// Progress reports of a render for a terminal, a log or another program. Everything goes to standard error.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/progress.h"
#include "sequence/sequence_clock.h"

namespace brisance {

enum class ProgressStyle {
    Automatic,  // Bar on a terminal, Plain otherwise
    Bar,        // one line, redrawn
    Plain,      // whole lines only: one per stage, and one per ten percent of slow stages
    None,       // notices and warnings only
    Alfred,     // Plain's notices and warnings, and "ALF_PROGRESS 12%" for each percent of all frames
    Ndjson      // one JSON object on each line, and nothing else (docs/farm.md lists their keys)
};

class TextProgress : public Progress {
public:
    explicit TextProgress(ProgressStyle style);
    ~TextProgress() override;
    TextProgress(const TextProgress&) = delete;
    TextProgress& operator=(const TextProgress&) = delete;

    // So many frames will be rendered; their rate counts from here.
    void begin_sequence(std::size_t frames);
    // Later stages belong to this frame, `index` counting from 0 of `count`, read from `file`.
    void begin_frame(int frame, const std::string& file, std::size_t index, std::size_t count);
    // The frame is done: rendered, with these files, or failed, with none.
    void end_frame(int frame, const std::vector<std::string>& files);
    // So many more frames are done, by other processes.
    void end_frames(std::size_t count);

    void stage(const std::string& name) override;
    void fraction(double done) override;
    void notice(const std::string& line) override;
    void warning(const std::string& code, const std::string& line) override;

    // A line on standard error between those of the progress.
    void say(const std::string& line);
    // The same for what went wrong; "error: " is put before it.
    void error(const std::string& line);

    // Ends the bar, and prints how often every repeated warning occurred.
    void finish();
    // The last line: what was written, with the time after `head`. `counts` says the same in numbers.
    void summary(const std::string& head, const std::string& tail, nlohmann::ordered_json counts);

private:
    using Clock = std::chrono::steady_clock;
    using Json = nlohmann::ordered_json;

    bool writes_json() const { return style_ == ProgressStyle::Ndjson; }
    void emit(const char* event, Json more);
    void emit_progress();
    void print_line(const std::string& line);
    void draw_bar();
    void clear_bar();
    void print_stage_percent(int percent);
    void tell_alfred();
    std::string pace() const;
    double seconds() const;

    ProgressStyle style_;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_line_{};
    std::mutex mutex_;
    SequenceClock sequence_;
    int number_ = 0;  // of the frame
    std::string frame_;
    std::string stage_;
    std::atomic<int> percent_{-1};
    int printed_percent_ = 0;
    int alfred_percent_ = -1;
    bool bar_shown_ = false;
    std::map<std::string, std::uint64_t> warnings_;  // line: times given
    std::map<std::string, std::uint64_t> notices_;
};

// Whether some progress is written as JSON: then errors are, too.
bool standard_error_is_json();

// "3 h 12 min", "1 min 20 s", "8.1 s".
std::string duration_text(double seconds);

}  // namespace brisance
