#include "suite/contest.h"

#include <algorithm>
#include <functional>

namespace brisance {
namespace {

bool there(const Reading& reading) {
    return reading.kind != ReadingKind::NotReached;
}

// The smallest reading among the contenders, of those but `without`.
std::optional<std::size_t> smallest(const std::vector<Contender>& contenders,
                                    const std::function<const Reading&(const Contender&)>& reading_of,
                                    std::optional<std::size_t> without = std::nullopt) {
    std::optional<std::size_t> best;
    for (std::size_t i = 0; i < contenders.size(); ++i) {
        const Reading& reading = reading_of(contenders[i]);
        if (i != without && there(reading) && (!best || reading.value < reading_of(contenders[*best]).value))
            best = i;
    }
    return best;
}

const Reading& error_of(const Contender& contender) {
    return contender.error;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

// At which the contenders are compared: the longest run of the one that shots take by default, so that a row says what
// the others give for its time. Where it does not compete, the median of all longest runs.
double equal_time(const std::vector<ErrorCurve>& curves, std::optional<std::size_t> by_default) {
    if (by_default)
        return curves[*by_default].points().back().seconds;
    std::vector<double> longest;
    for (const ErrorCurve& curve : curves)
        longest.push_back(curve.points().back().seconds);
    return median(std::move(longest));
}

// Of the run with the smallest error.
std::optional<double> spread_at_floor(const Report& report, const MethodResult& result, const std::string& cell,
                                      double floor) {
    for (const MeasuredRun& run : result.runs)
        if (headline_error(report, run, cell) == floor)
            return headline_spread(report, run, cell);
    return std::nullopt;
}

Contest contest_of(const Report& report, const std::string& cell, Clock clock) {
    Contest contest;
    contest.cell = cell;
    if (const auto noise = report.reference.noise.find(cell); noise != report.reference.noise.end())
        contest.noise = noise->second;
    std::vector<ErrorCurve> curves;
    std::optional<std::size_t> by_default;
    for (const MethodResult& result : report.methods) {
        if (!owns(result.method, cell))
            continue;
        ErrorCurve curve = curve_of(report, result, cell, clock);
        if (curve.points().empty())
            continue;
        if (result.method.by_default)
            by_default = curves.size();
        contest.contenders.push_back({result.method.label,
                                      {},
                                      {},
                                      curve.floor(),
                                      flicker_in(result, cell),
                                      spread_at_floor(report, result, cell, curve.floor())});
        curves.push_back(std::move(curve));
    }
    if (curves.empty())
        return contest;
    contest.seconds = equal_time(curves, by_default);
    for (std::size_t i = 0; i < curves.size(); ++i) {
        contest.contenders[i].error = curves[i].error_after(contest.seconds);
        for (std::size_t t = 0; t < kSuiteTargets.size(); ++t)
            contest.contenders[i].times[t] = curves[i].time_to(kSuiteTargets[t]);
    }
    contest.at_time = smallest(contest.contenders, error_of);
    for (std::size_t t = 0; t < kSuiteTargets.size(); ++t)
        if (const auto first =
                smallest(contest.contenders, [t](const Contender& c) -> const Reading& { return c.times[t]; })) {
            contest.target = t;
            contest.at_error = first;
        }
    return contest;
}

}  // namespace

std::vector<Contest> contests(const Report& report, Clock clock) {
    std::vector<Contest> all;
    for (const std::string& layer : report.layers)
        if (!layer.empty())
            all.push_back(contest_of(report, layer, clock));
    return all;
}

std::optional<std::size_t> second_at_time(const Contest& contest) {
    return smallest(contest.contenders, error_of, contest.at_time);
}

}  // namespace brisance
