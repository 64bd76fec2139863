// Processor time, for costs that wall time on a busy machine does not tell.
#pragma once

#include <ctime>

namespace brisance {

inline double seconds_on(clockid_t clock) {
    timespec now{};
    clock_gettime(clock, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// Of this thread; of all threads of the process. Only differences mean something.
inline double thread_cpu_seconds() {
    return seconds_on(CLOCK_THREAD_CPUTIME_ID);
}
inline double process_cpu_seconds() {
    return seconds_on(CLOCK_PROCESS_CPUTIME_ID);
}

// What one reading of the thread's clock takes [s]: of a call into the system, and as long as a short piece of work.
inline double cost_of_thread_clock() {
    static const double cost = [] {
        constexpr int kReadings = 256;
        const double start = thread_cpu_seconds();
        double last = start;
        for (int i = 0; i < kReadings; ++i)
            last = thread_cpu_seconds();
        return (last - start) / kReadings;
    }();
    return cost;
}

// Adds the processor time of this thread until it goes, where there is somewhere to add it; without, reads no clock.
class AddedCpuTime {
public:
    explicit AddedCpuTime(double* to) : to_(to), start_(to ? thread_cpu_seconds() : 0.0) {}
    ~AddedCpuTime() {
        if (to_)
            *to_ += thread_cpu_seconds() - start_ - cost_of_thread_clock();
    }
    AddedCpuTime(const AddedCpuTime&) = delete;
    AddedCpuTime& operator=(const AddedCpuTime&) = delete;

private:
    double* to_;
    double start_;
};

}  // namespace brisance
