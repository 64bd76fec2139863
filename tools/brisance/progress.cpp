#include "progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/printable.h"

namespace brisance {
namespace {

constexpr int kBarWidth = 24;
constexpr double kSecondsBetweenLines = 1.0;
std::atomic<bool> some_json{false};
constexpr const char* kLongStage = "path tracing";  // takes almost all time of a frame where it runs

int terminal_width() {
    winsize size{};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

double rounded(double value) {
    return std::round(100.0 * value) / 100.0;
}

}  // namespace

std::string duration_text(double seconds) {
    if (seconds < 59.95)
        return fmt::format("{:.1f} s", seconds);
    const auto whole = static_cast<long long>(std::llround(seconds));
    if (whole < 3600)
        return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

bool standard_error_is_json() {
    return some_json;
}

TextProgress::TextProgress(ProgressStyle style) : style_(style) {
    if (style_ == ProgressStyle::Automatic)
        style_ = isatty(STDERR_FILENO) == 1 ? ProgressStyle::Bar : ProgressStyle::Plain;
    some_json = some_json || writes_json();
}

TextProgress::~TextProgress() {
    clear_bar();
}

void TextProgress::begin_sequence(std::size_t frames) {
    const std::lock_guard lock(mutex_);
    sequence_.begin(frames);
    tell_alfred();
}

void TextProgress::begin_frame(int frame, const std::string& file, std::size_t index, std::size_t count) {
    const std::lock_guard lock(mutex_);
    sequence_.begin_frame();
    number_ = frame;
    frame_ = count > 1 ? fmt::format("frame {} ({} of {}): ", frame, index + 1, count) : "";
    stage_.clear();
    percent_ = -1;
    if (style_ == ProgressStyle::Plain)
        print_line(fmt::format("{:8.1f} s  {}{}", seconds(), frame_, printable_line(file)));
    if (writes_json())
        emit("frame", {{"frame", frame}, {"index", index}, {"frames", count}, {"file", file}});
}

void TextProgress::end_frame(int frame, const std::vector<std::string>& files) {
    const std::lock_guard lock(mutex_);
    sequence_.end_frame();
    if (writes_json() && !files.empty())
        emit("written", {{"frame", frame}, {"files", files}});
    if (style_ == ProgressStyle::Plain && sequence_.frames() > 1)
        print_line(fmt::format("{:8.1f} s  {}", seconds(), pace()));
    if (writes_json())
        emit_progress();
    tell_alfred();
}

void TextProgress::end_frames(std::size_t count) {
    const std::lock_guard lock(mutex_);
    sequence_.end_frames(count);
    stage_ = "rendering";
    if (style_ == ProgressStyle::Plain)
        print_line(fmt::format("{:8.1f} s  {}", seconds(), pace()));
    if (style_ == ProgressStyle::Bar)
        draw_bar();
    if (writes_json())
        emit_progress();
    tell_alfred();
}

void TextProgress::stage(const std::string& name) {
    const std::lock_guard lock(mutex_);
    stage_ = printable_line(name);
    percent_ = 0;
    printed_percent_ = 0;
    last_line_ = Clock::now();
    if (style_ == ProgressStyle::Plain)
        print_line(fmt::format("{:8.1f} s  {}{}", seconds(), frame_, stage_));
    if (style_ == ProgressStyle::Bar)
        draw_bar();
    if (writes_json())
        emit_progress();
    tell_alfred();
}

void TextProgress::fraction(double done) {
    if (!(done >= 0.0) || style_ == ProgressStyle::None)
        return;
    // Loops call this often: only a new percent is worth a lock.
    const int percent = static_cast<int>(100.0 * std::min(done, 1.0));
    if (percent <= percent_.load(std::memory_order_relaxed))
        return;
    const std::lock_guard lock(mutex_);
    if (percent <= percent_)
        return;
    percent_ = percent;
    if (stage_ == kLongStage)
        sequence_.set_part(0.01 * percent);
    if (style_ == ProgressStyle::Bar)
        draw_bar();
    else
        print_stage_percent(percent);
    tell_alfred();
}

// One line for ten percent of a stage, but no more than one a second.
void TextProgress::print_stage_percent(int percent) {
    const Clock::time_point now = Clock::now();
    const bool due = std::chrono::duration<double>(now - last_line_).count() >= kSecondsBetweenLines;
    if (percent / 10 <= printed_percent_ / 10 || percent >= 100 || !due)
        return;
    printed_percent_ = percent;
    last_line_ = now;
    if (style_ == ProgressStyle::Plain)
        print_line(fmt::format("{:8.1f} s  {}{} {} %", seconds(), frame_, stage_, percent));
    if (writes_json())
        emit_progress();
}

void TextProgress::notice(const std::string& line) {
    const std::lock_guard lock(mutex_);
    if (notices_[line]++ > 0)
        return;
    if (writes_json())
        emit("notice", {{"text", line}});
    else
        print_line(printable_line(line));
}

void TextProgress::warning(const std::string& code, const std::string& line) {
    const std::lock_guard lock(mutex_);
    const std::string whole = printable_line(fmt::format("warning: {} [{}]", line, code));
    if (warnings_[whole]++ > 0)
        return;
    if (writes_json())
        emit("warning", {{"code", code}, {"text", line}});
    else
        print_line(whole);
}

void TextProgress::say(const std::string& line) {
    const std::lock_guard lock(mutex_);
    if (writes_json())
        emit("notice", {{"text", line}});
    else
        print_line(line);
}

void TextProgress::error(const std::string& line) {
    const std::lock_guard lock(mutex_);
    if (writes_json())
        emit("error", {{"text", line}});
    else
        print_line("error: " + line);
}

void TextProgress::finish() {
    const std::lock_guard lock(mutex_);
    clear_bar();
    stage_.clear();
    for (const auto& [line, times] : warnings_)
        if (times > 1 && !writes_json())
            print_line(fmt::format("{}: {} times", line, times));
    warnings_.clear();
}

void TextProgress::summary(const std::string& head, const std::string& tail, Json counts) {
    const std::lock_guard lock(mutex_);
    counts["seconds"] = rounded(sequence_.seconds());
    if (writes_json())
        emit("summary", std::move(counts));
    else if (style_ != ProgressStyle::None)
        print_line(head + " in " + duration_text(sequence_.seconds()) + tail);
}

void TextProgress::emit(const char* event, Json more) {
    Json json = {{"event", event}};
    json.update(more);
    std::fputs((json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n").c_str(), stderr);
}

void TextProgress::emit_progress() {
    if (sequence_.frames() == 0)
        return;  // nothing is known of the frames yet
    Json json = {{"percent", static_cast<int>(100.0 * sequence_.share())},
                 {"frames_done", sequence_.done()},
                 {"frames", sequence_.frames()},
                 {"seconds", rounded(sequence_.seconds())}};
    const std::optional<double> each = sequence_.seconds_per_frame(), left = sequence_.seconds_left();
    json["seconds_per_frame"] = each ? Json(rounded(*each)) : Json();
    json["seconds_left"] = left ? Json(rounded(*left)) : Json();
    if (sequence_.done() < sequence_.frames() && !stage_.empty())
        json.update({{"frame", number_}, {"stage", stage_}, {"stage_percent", std::max(percent_.load(), 0)}});
    emit("progress", std::move(json));
}

void TextProgress::tell_alfred() {
    if (style_ != ProgressStyle::Alfred || sequence_.frames() == 0)
        return;
    const int percent = static_cast<int>(100.0 * sequence_.share());
    if (percent <= alfred_percent_)
        return;
    alfred_percent_ = percent;
    print_line(fmt::format("ALF_PROGRESS {}%", percent));
}

void TextProgress::print_line(const std::string& line) {
    clear_bar();
    std::fputs((line + "\n").c_str(), stderr);
    if (style_ == ProgressStyle::Bar && !stage_.empty())
        draw_bar();
}

// "3 of 24 frames, 8.1 s a frame, 2 min 50 s left"
std::string TextProgress::pace() const {
    std::string text = fmt::format("{} of {} frames", sequence_.done(), sequence_.frames());
    if (const std::optional<double> each = sequence_.seconds_per_frame())
        text += fmt::format(", {} a frame, {} left", duration_text(*each), duration_text(*sequence_.seconds_left()));
    return text;
}

void TextProgress::draw_bar() {
    const bool several = sequence_.frames() > 1;
    const int of_stage = std::max(percent_.load(), 0);
    const int percent = several ? static_cast<int>(100.0 * sequence_.share()) : of_stage;
    const int filled = kBarWidth * percent / 100;
    std::string line = fmt::format("[{:#<{}}{:.<{}}] {:3} %  ", "", filled, "", kBarWidth - filled, percent);
    line += several ? fmt::format("{}; {}{} {} %", pace(), frame_, stage_, of_stage) : frame_ + stage_;
    // A line that wraps could not be drawn over.
    line.resize(std::min(line.size(), static_cast<std::size_t>(std::max(terminal_width() - 1, 1))));
    std::fputs(("\r" + line + "\x1b[K").c_str(), stderr);
    std::fflush(stderr);
    bar_shown_ = true;
}

void TextProgress::clear_bar() {
    if (bar_shown_)
        std::fputs("\r\x1b[K", stderr);
    bar_shown_ = false;
}

double TextProgress::seconds() const {
    return std::chrono::duration<double>(Clock::now() - start_).count();
}

}  // namespace brisance
