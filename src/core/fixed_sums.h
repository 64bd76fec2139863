// Sums that come out the same in whatever order threads add to them: whole numbers of a small unit.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <vector>

#include "core/nearest_whole.h"
#include "core/vec.h"

namespace brisance {

// Each holds up to 2^16 times `whole`, of either sign, in steps of 2^-46 of it. Sums beyond 2^17 times `whole` and
// values that are not finite are not noticed: they wrap around or become any number.
class FixedSums {
public:
    FixedSums(std::size_t count, double whole) : unit_(std::max(whole, 1e-300) / 0x1p46), sums_(3 * count) {}

    // A value in whole steps. Values that go to one sum may be added up so before.
    using Steps = glm::vec<3, std::int64_t>;
    Steps steps(const dvec3& value) const {
        return {nearest_whole(value.x / unit_), nearest_whole(value.y / unit_), nearest_whole(value.z / unit_)};
    }

    // From any thread.
    void add_steps(std::size_t sum, const Steps& steps) {
        for (std::size_t c = 0; c < 3; ++c)
            std::atomic_ref<std::int64_t>(sums_[3 * sum + c]).fetch_add(steps[int(c)], std::memory_order_relaxed);
    }
    void add(std::size_t sum, const dvec3& value) { add_steps(sum, steps(value)); }
    dvec3 read(std::size_t sum) const {
        return unit_ * dvec3(double(sums_[3 * sum]), double(sums_[3 * sum + 1]), double(sums_[3 * sum + 2]));
    }
    std::uint64_t bytes() const { return sums_.size() * sizeof(std::int64_t); }

private:
    double unit_;
    std::vector<std::int64_t> sums_;
};

}  // namespace brisance
