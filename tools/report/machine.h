// The machine on which times were measured.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace brisance {

struct Machine {
    std::string processor;  // "unknown processor" where the system does not say
    int cores = 0;          // physical ones
    int logical = 0;
    int threads = 0;  // that rendering may use
    std::uint64_t memory_bytes = 0;
    std::array<double, 3> load{};  // means over the last 1, 5 and 15 minutes, before the first render
    std::string system;            // "Linux 6.1.0 x86_64"
};

Machine this_machine();

}  // namespace brisance
