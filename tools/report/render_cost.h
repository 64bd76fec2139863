// Measures the time of a computation, from the construction of the meter.
#pragma once

#include <sys/resource.h>

#include "core/stopwatch.h"
#include "report.h"

namespace brisance {

class CostMeter {
public:
    Cost cost() const { return {watch_.seconds(), cpu_seconds() - cpu_}; }

private:
    // Of the whole process: nothing else runs in it while it renders.
    static double cpu_seconds() {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
        return seconds(usage.ru_utime) + seconds(usage.ru_stime);
    }

    Stopwatch watch_;
    double cpu_ = cpu_seconds();
};

}  // namespace brisance
