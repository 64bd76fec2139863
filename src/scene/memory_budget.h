// The memory limit of a scene, checked before each allocation.
#pragma once

#include <cstdint>
#include <string>

namespace brisance {

// Sums in double: counts come from files, and no sum of theirs may wrap around.
class MemoryBudget {
public:
    explicit MemoryBudget(std::uint64_t limit) : limit_(static_cast<double>(limit)) {}

    // Throws Error Temporary, which begins with `where`, when all that was claimed exceeds the limit.
    void claim(const std::string& where, double bytes, double triangles = 0.0);
    std::uint64_t left() const;

private:
    double limit_, bytes_ = 0.0, triangles_ = 0.0;
};

}  // namespace brisance
