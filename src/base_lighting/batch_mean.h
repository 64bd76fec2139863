// The mean of batches of draws, and whether it is known well enough.
#pragma once

#include <algorithm>
#include <cstddef>

namespace brisance {

class BatchMean {
public:
    void add(float value) {
        sum_ += value;
        squares_ += value * value;
        ++count_;
    }
    // `darkest`: a smaller mean may err like it.
    bool within(float tolerance, float darkest) const {
        if (count_ < kLeastBatches)
            return false;
        const float n = float(count_), mean = sum_ / n,
                    variance = std::max(0.0f, squares_ / n - mean * mean) / (n - 1.0f),
                    tolerated = tolerance * std::max(mean, darkest);
        return variance <= tolerated * tolerated;
    }

private:
    static constexpr std::size_t kLeastBatches = 4;  // whose spread tells the error of their mean
    float sum_ = 0.0f, squares_ = 0.0f;
    std::size_t count_ = 0;
};

}  // namespace brisance
