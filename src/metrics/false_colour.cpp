#include "metrics/false_colour.h"

#include <array>
#include <cmath>
#include <numbers>

#include "film/view_transform.h"
#include "metrics/colour_space.h"

namespace brisance {
namespace {

constexpr std::size_t kSteps = 256;

// As colourful as sRGB allows: every colour of the map lies inside its gamut, and nothing is clipped.
Rgb linear_colour(float error) {
    constexpr float pi = std::numbers::pi_v<float>;
    const float chroma = 58.0f * std::sin(pi * error) + 20.0f * error;
    const float hue = glm::radians(285.0f + 180.0f * error);
    return linear_from_lab({98.0f * error, chroma * std::cos(hue), chroma * std::sin(hue)});
}

std::array<std::array<std::uint8_t, 3>, kSteps> make_palette() {
    std::array<std::array<std::uint8_t, 3>, kSteps> palette{};
    for (std::size_t step = 0; step < kSteps; ++step) {
        const vec3 shown =
            apply_view(linear_colour(static_cast<float>(step) / static_cast<float>(kSteps - 1)), ViewTransform::Srgb);
        for (int c = 0; c < 3; ++c)
            palette[step][static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(std::lround(255.0f * shown[c]));
    }
    return palette;
}

}  // namespace

std::vector<std::uint8_t> false_colours(const Plane& errors) {
    static const auto palette = make_palette();
    std::vector<std::uint8_t> bytes;
    bytes.reserve(3 * errors.values.size());
    for (const float error : errors.values) {
        const float clipped = error > 0.0f ? std::min(error, 1.0f) : 0.0f;
        const auto& colour = palette[static_cast<std::size_t>(std::lround(clipped * static_cast<float>(kSteps - 1)))];
        bytes.insert(bytes.end(), colour.begin(), colour.end());
    }
    return bytes;
}

}  // namespace brisance
