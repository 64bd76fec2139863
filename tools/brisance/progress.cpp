#include "progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/printable.h"

namespace brisance {
namespace {

constexpr int kBarWidth = 24;
constexpr double kSecondsBetweenLines = 1.0;

int terminal_width() {
    winsize size{};
    return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

}  // namespace

TextProgress::TextProgress(ProgressStyle style) : style_(style) {
    if (style_ == ProgressStyle::Automatic)
        style_ = isatty(STDERR_FILENO) == 1 ? ProgressStyle::Bar : ProgressStyle::Plain;
}

TextProgress::~TextProgress() {
    clear_bar();
}

void TextProgress::begin_frame(int frame, const std::string& file, std::size_t index, std::size_t count) {
    const std::lock_guard lock(mutex_);
    frame_ = count > 1 ? fmt::format("frame {} ({} of {}): ", frame, index + 1, count) : "";
    stage_.clear();
    percent_ = -1;
    if (style_ == ProgressStyle::Plain)
        print_line(fmt::format("{:8.1f} s  {}{}", seconds(), frame_, printable_line(file)));
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
    if (style_ == ProgressStyle::Bar) {
        draw_bar();
        return;
    }
    const Clock::time_point now = Clock::now();
    const bool due = std::chrono::duration<double>(now - last_line_).count() >= kSecondsBetweenLines;
    if (percent / 10 > printed_percent_ / 10 && percent < 100 && due) {
        printed_percent_ = percent;
        last_line_ = now;
        print_line(fmt::format("{:8.1f} s  {}{} {} %", seconds(), frame_, stage_, percent));
    }
}

void TextProgress::notice(const std::string& line) {
    const std::lock_guard lock(mutex_);
    if (notices_[line]++ == 0)
        print_line(printable_line(line));
}

void TextProgress::warning(const std::string& code, const std::string& line) {
    const std::lock_guard lock(mutex_);
    const std::string whole = printable_line(fmt::format("warning: {} [{}]", line, code));
    if (warnings_[whole]++ == 0)
        print_line(whole);
}

void TextProgress::say(const std::string& line) {
    const std::lock_guard lock(mutex_);
    print_line(line);
}

void TextProgress::finish() {
    const std::lock_guard lock(mutex_);
    clear_bar();
    style_ = ProgressStyle::None;
    for (const auto& [line, times] : warnings_)
        if (times > 1)
            print_line(fmt::format("{}: {} times", line, times));
    warnings_.clear();
}

void TextProgress::print_line(const std::string& line) {
    clear_bar();
    std::fputs((line + "\n").c_str(), stderr);
    if (style_ == ProgressStyle::Bar && !stage_.empty())
        draw_bar();
}

void TextProgress::draw_bar() {
    const int percent = std::max(percent_.load(), 0);
    const int filled = kBarWidth * percent / 100;
    std::string line =
        fmt::format("[{:#<{}}{:.<{}}] {:3} %  {}{}", "", filled, "", kBarWidth - filled, percent, frame_, stage_);
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
