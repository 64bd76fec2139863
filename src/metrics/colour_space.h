// Converts linear Rec. 709 to spaces whose distances correspond to perceived differences. White (1, 1, 1) is D65.
// [1] CIE 15, Colorimetry: CIELAB. The opponent space YCxCz is CIELAB without its cube root, so that filtering in it is
// filtering light.
#pragma once

#include <cmath>

#include "core/vec.h"

namespace brisance {

// Columns: red, green and blue of IEC 61966-2-1.
inline const mat3 kXyzFromLinear{0.4124564f, 0.2126729f, 0.0193339f, 0.3575761f, 0.7151522f,
                                 0.1191920f, 0.1804375f, 0.0721750f, 0.9503041f};
inline const mat3 kLinearFromXyz = glm::inverse(kXyzFromLinear);
inline const vec3 kWhite = kXyzFromLinear * vec3(1.0f);

// (x, y, z), relative to white, as lightness and two opponent axes: 116 y - 16, 500 (x - y), 200 (y - z).
inline vec3 opponent(const vec3& relative) {
    return {116.0f * relative.y - 16.0f, 500.0f * (relative.x - relative.y), 200.0f * (relative.y - relative.z)};
}

inline vec3 without_opponents(const vec3& v) {
    const float y = (v.x + 16.0f) / 116.0f;
    return {y + v.y / 500.0f, y, y - v.z / 200.0f};
}

inline vec3 ycxcz_from_linear(const Rgb& linear) {
    return opponent(kXyzFromLinear * linear / kWhite);
}

inline Rgb linear_from_ycxcz(const vec3& ycxcz) {
    return kLinearFromXyz * (without_opponents(ycxcz) * kWhite);
}

constexpr float kLabKnee = 6.0f / 29.0f;  // of the cube root; a line below [1]

inline vec3 lab_from_linear(const Rgb& linear) {
    const vec3 relative = kXyzFromLinear * linear / kWhite;
    const auto root = [](float t) {
        return t > kLabKnee * kLabKnee * kLabKnee ? std::cbrt(t) : t / (3.0f * kLabKnee * kLabKnee) + 4.0f / 29.0f;
    };
    return opponent({root(relative.x), root(relative.y), root(relative.z)});
}

inline Rgb linear_from_lab(const vec3& lab) {
    const vec3 roots = without_opponents(lab);
    const auto cube = [](float t) {
        return t > kLabKnee ? t * t * t : 3.0f * kLabKnee * kLabKnee * (t - 4.0f / 29.0f);
    };
    return kLinearFromXyz * (vec3(cube(roots.x), cube(roots.y), cube(roots.z)) * kWhite);
}

}  // namespace brisance
