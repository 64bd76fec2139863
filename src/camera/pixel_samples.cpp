#include "camera/pixel_samples.h"

#include <algorithm>
#include <cmath>

#include "camera/pixel_filter.h"

namespace brisance {

std::vector<PixelSample> pixel_samples(const CameraSettings& camera, int per_axis) {
    const int n = std::max(1, static_cast<int>(std::ceil(per_axis * camera.filter_width_pixels)));
    std::vector<PixelSample> samples;
    float total = 0.0f;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double x = (i + (j + 0.5) / n) / n - 0.5, y = (j + (n - i - 0.5) / n) / n - 0.5;
            const float weight = filter_weight(camera.filter, x, y);
            samples.push_back({x * camera.filter_width_pixels, y * camera.filter_width_pixels, weight});
            total += weight;
        }
    for (PixelSample& s : samples)
        s.weight /= total;
    return samples;
}

}  // namespace brisance
