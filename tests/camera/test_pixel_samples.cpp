// Samples of a pixel: stratified along both axes, and unbiased.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "camera/pixel_samples.h"

namespace brisance {
namespace {

TEST(PixelSamples, ShareNoRowAndNoColumnAndStandAboutTheMiddle) {
    CameraSettings camera;
    for (const int n : {1, 2, 3, 4, 5, 8}) {
        const std::vector<PixelSample> samples = pixel_samples(camera, n);
        ASSERT_EQ(samples.size(), std::size_t(n) * n);
        std::vector<double> x, y;
        double weight = 0.0, mean_x = 0.0, mean_y = 0.0;
        for (const PixelSample& s : samples) {
            x.push_back(s.x), y.push_back(s.y);
            weight += s.weight, mean_x += s.weight * s.x, mean_y += s.weight * s.y;
        }
        EXPECT_NEAR(weight, 1.0, 1e-5);
        EXPECT_NEAR(mean_x, 0.0, 1e-6);
        EXPECT_NEAR(mean_y, 0.0, 1e-6);
        std::ranges::sort(x), std::ranges::sort(y);
        for (int i = 0; i < n * n; ++i) {
            EXPECT_NEAR(x[i], (i + 0.5) / (n * n) - 0.5, 1e-9);
            EXPECT_NEAR(y[i], (i + 0.5) / (n * n) - 0.5, 1e-9);
        }
    }
}

}  // namespace
}  // namespace brisance
