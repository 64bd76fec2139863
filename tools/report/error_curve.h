// How a method's error falls with time: a power law through its runs, and readings between and beyond them.
#pragma once

#include <optional>
#include <vector>

namespace brisance {

struct CurvePoint {
    double seconds = 0.0;
    double error = 0.0;  // 0: too small to distinguish from 0
    double work = 0.0;   // paths per pixel; 0: not of that kind
};

// What more time than the longest run's would give.
enum class Tail {
    Average,  // unbiased estimates averaged: after the start-up the error falls as seconds^-1/2
    Floor     // a biased method: nothing below the smallest error that was measured
};

// error = constant * seconds^exponent, or of work
struct PowerLaw {
    double constant = 0.0;
    double exponent = 0.0;
};

enum class ReadingKind {
    Interpolated,  // between two runs, or at one
    Extrapolated,  // beyond the longest run, by the law of averages after the start-up
    AtMost,        // the cheapest run is better already, or the method had finished, or the error is 0
    NotReached     // by no run, nor by more time; or before the first run
};

struct Reading {
    double value = 0.0;
    ReadingKind kind = ReadingKind::NotReached;
};

class ErrorCurve {
public:
    // Points in any order. Those without a positive time or with an error that is not finite are left out.
    ErrorCurve(std::vector<CurvePoint> points, Tail tail);

    // Least squares in the logarithms, over all errors above 0; absent unless two of them differ in time.
    std::optional<PowerLaw> law() const;

    // The same against work instead of time, which other programs on the machine do not disturb.
    std::optional<PowerLaw> law_of_work() const;

    // The time [s] that does not depend on the number of paths, by the straight line through time against work of the
    // two longest runs; at most the first run's. 0 for a tail that does not average.
    double startup() const;

    // The shortest time [s] after which the error is at most `error` (above 0), along straight lines in the logarithms.
    Reading time_to(double error) const;

    // The error after `seconds`.
    Reading error_after(double seconds) const;

    // The smallest error of all runs; 0 without runs.
    double floor() const;

    const std::vector<CurvePoint>& points() const { return points_; }  // by time

private:
    std::vector<CurvePoint> points_;
    Tail tail_;
};

}  // namespace brisance
