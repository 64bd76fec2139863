#include "camera/pixel_samples.h"

#include <algorithm>
#include <cmath>

#include "camera/pixel_filter.h"

namespace brisance {

namespace {

double within_filter(double x) {
    return x - std::floor(x + 0.5);
}

}  // namespace

std::vector<PixelSample> pixel_samples(const CameraSettings& camera, int per_axis, const glm::dvec2& shift) {
    const int n = std::max(1, static_cast<int>(std::ceil(per_axis * camera.filter_width_pixels)));
    std::vector<PixelSample> samples;
    float total = 0.0f;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            double x = (i + (j + 0.5) / n) / n - 0.5, y = (j + (n - i - 0.5) / n) / n - 0.5;
            if (shift != glm::dvec2(0.0)) {
                x = within_filter(x + shift.x / n);
                y = within_filter(y + shift.y / n);
            }
            const float weight = filter_weight(camera.filter, x, y);
            samples.push_back({x * camera.filter_width_pixels, y * camera.filter_width_pixels, weight});
            total += weight;
        }
    for (PixelSample& s : samples)
        s.weight /= total;
    return samples;
}

}  // namespace brisance
