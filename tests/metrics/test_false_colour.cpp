// Maps of errors can be read by colour, and by lightness alone.

#include "metrics/false_colour.h"

#include <gtest/gtest.h>

#include <cmath>

#include "metrics/colour_space.h"

namespace brisance {
namespace {

Plane line_of(std::vector<float> values) {
    const int width = static_cast<int>(values.size());
    return {width, 1, std::move(values)};
}

float decoded(std::uint8_t byte) {
    const float v = static_cast<float>(byte) / 255.0f;
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

vec3 lab_of(const std::vector<std::uint8_t>& bytes, std::size_t pixel) {
    return lab_from_linear({decoded(bytes[3 * pixel]), decoded(bytes[3 * pixel + 1]), decoded(bytes[3 * pixel + 2])});
}

// Clipping at the gamut's border would bend either.
TEST(FalseColours, RiseInLightnessAsTheErrorDoesWhileTheHueGoesRound) {
    std::vector<float> errors;
    for (int step = 0; step <= 51; ++step)
        errors.push_back(static_cast<float>(step) / 51.0f);
    const std::vector<std::uint8_t> bytes = false_colours(line_of(errors));
    float hue_before = -1e9f;
    for (std::size_t i = 0; i < errors.size(); ++i) {
        const vec3 lab = lab_of(bytes, i);
        EXPECT_NEAR(lab.x, 98.0f * errors[i], 0.8f) << i;
        if (lab.x < 8.0f)
            continue;  // eight bits leave little hue to the dark
        float hue = glm::degrees(std::atan2(lab.z, lab.y));
        hue += hue < 180.0f && errors[i] > 0.4f ? 360.0f : hue < 0.0f ? 360.0f : 0.0f;
        EXPECT_NEAR(hue, 285.0f + 180.0f * errors[i], 6.0f) << i;
        EXPECT_GT(hue, hue_before - 3.0f) << i;
        hue_before = hue;
    }
}

TEST(FalseColours, BeginInBlackAndClipWhatLiesOutside) {
    const std::vector<std::uint8_t> bytes = false_colours(line_of({0.0f, -1.0f, std::nanf(""), 1.0f, 7.0f}));
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_EQ(bytes[i], 0);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_EQ(bytes[9 + c], bytes[12 + c]);
    EXPECT_GT(bytes[9], 240);
}

}  // namespace
}  // namespace brisance
