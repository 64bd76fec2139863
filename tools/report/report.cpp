#include "report.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "core/error.h"

namespace brisance {
namespace {

constexpr std::size_t kMostEqualTimes = 8;
constexpr double kLeastBusy = 0.7;  // of the threads

double seconds_of(const MeasuredRun& run, Clock clock) {
    return clock == Clock::Wall ? run.cost.wall_seconds : run.cost.cpu_seconds;
}

// Numbers of `digits` times powers of ten within [low, high].
std::vector<double> round_numbers(double low, double high, const std::vector<double>& digits) {
    std::vector<double> numbers;
    for (int exponent = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, exponent) <= high; ++exponent)
        for (const double digit : digits)
            if (const double number = digit * std::pow(10.0, exponent); number >= low && number <= high)
                numbers.push_back(number);
    return numbers;
}

}  // namespace

const std::vector<double>& report_targets() {
    static const std::vector<double> targets = {0.10, 0.05, 0.02, 0.01};
    return targets;
}

std::optional<double> headline_error(const Report& report, const MeasuredRun& run, const std::string& layer) {
    const auto found = run.errors.find(layer);
    if (found == run.errors.end())
        return std::nullopt;
    return report.reference.halves ? found->second.noise_free : found->second.differences.rrmse;
}

std::optional<double> headline_spread(const Report& report, const MeasuredRun& run, const std::string& layer) {
    const auto found = run.errors.find(layer);
    if (found == run.errors.end() || !found->second.spread)
        return std::nullopt;
    const ErrorSpread& spread = *found->second.spread;
    return report.reference.halves ? spread.noise_free : spread.rrmse;
}

std::optional<double> flicker_in(const MethodResult& result, const std::string& cell) {
    const auto found = result.flicker.find(cell);
    return found == result.flicker.end() || !std::isfinite(found->second) ? std::nullopt : std::optional(found->second);
}

ErrorCurve curve_of(const Report& report, const MethodResult& result, const std::string& layer, Clock clock) {
    std::vector<CurvePoint> points;
    for (const MeasuredRun& run : result.runs)
        if (const std::optional<double> error = headline_error(report, run, layer))
            points.push_back({seconds_of(run, clock), *error, result.method.averages ? run.samples_per_pixel : 0.0});
    return {points, result.method.averages ? Tail::Average : Tail::Floor};
}

std::size_t baseline(const Report& report) {
    std::size_t best = 0;
    std::ptrdiff_t most = -1;
    for (std::size_t m = 0; m < report.methods.size(); ++m) {
        const ErrorCurve curve = curve_of(report, report.methods[m], "", Clock::Wall);
        const auto reached = std::count_if(report_targets().begin(), report_targets().end(), [&](double target) {
            return curve.time_to(target).kind != ReadingKind::NotReached;
        });
        if (reached > most) {
            most = reached;
            best = m;
        }
    }
    return best;
}

double processors_busy(const Report& report) {
    double wall = 0.0, cpu = 0.0;
    for (const MethodResult& result : report.methods)
        for (const MeasuredRun& run : result.runs) {
            wall += run.cost.wall_seconds;
            cpu += run.cost.cpu_seconds;
        }
    return wall > 0.0 ? cpu / wall : 0.0;
}

bool was_disturbed(const Report& report) {
    return processors_busy(report) < kLeastBusy * report.machine.threads;
}

std::vector<double> equal_times(const Report& report, Clock clock) {
    double low = INFINITY, high = 0.0;
    for (const MethodResult& result : report.methods)
        for (const MeasuredRun& run : result.runs)
            if (const double seconds = seconds_of(run, clock); seconds > 0.0) {
                low = std::min(low, seconds);
                high = std::max(high, seconds);
            }
    if (!(high > 0.0))
        return {};
    for (const std::vector<double>& digits : {std::vector<double>{1, 2, 5}, {1, 3}, {1}}) {
        std::vector<double> times = round_numbers(low, high, digits);
        if (times.size() <= kMostEqualTimes && !times.empty())
            return times;
    }
    return {high};
}

std::string report_date() {
    std::time_t now = std::time(nullptr);
    if (const char* const fixed = std::getenv("SOURCE_DATE_EPOCH"); fixed != nullptr && *fixed != '\0') {
        long long seconds = 0;
        const char* const end = fixed + std::strlen(fixed);
        const auto [rest, error] = std::from_chars(fixed, end, seconds);
        if (error != std::errc() || rest != end || seconds < 0)
            throw Error(ExitCode::Usage,
                        fmt::format("SOURCE_DATE_EPOCH is \"{}\": expected whole seconds since 1970", fixed));
        now = static_cast<std::time_t>(seconds);
    }
    std::tm utc{};
    gmtime_r(&now, &utc);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                       utc.tm_hour, utc.tm_min, utc.tm_sec);
}

std::string shell_quoted(const std::string& word) {
    const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
               std::strchr("-_./,:=+@%", c) != nullptr;
    });
    if (plain)
        return word;
    std::string quoted = "'";
    for (const char c : word)
        quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

}  // namespace brisance
