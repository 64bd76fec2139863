#include "film/view_transform.h"

#include <algorithm>
#include <cmath>

namespace brisance {
namespace {

constexpr float kMix = 0.1f;        // k of the header
constexpr float kBrightest = 1e6f;  // beyond it the curve is 1 to single precision, and squares stay finite

// [2]'s coefficients, its numerator's leading one made equal to the denominator's.
float tone(float x) {
    return (2.43f * x * x + 0.03f * x) / (2.43f * x * x + 0.59f * x + 0.14f);
}

float srgb_curve(float x) {
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
}

float cleaned(float x) {
    return x > 0.0f ? std::min(x, kBrightest) : 0.0f;
}  // NaN compares false

vec3 filmic(const vec3& x) {
    const vec3 mixed = (1.0f - kMix) * x + kMix * luminance(x);
    return {tone(mixed.x), tone(mixed.y), tone(mixed.z)};
}

}  // namespace

vec3 apply_view(const Rgb& exposed, ViewTransform view) {
    vec3 linear(cleaned(exposed.x), cleaned(exposed.y), cleaned(exposed.z));
    if (view == ViewTransform::Filmic)
        linear = filmic(linear);
    linear = glm::clamp(linear, 0.0f, 1.0f);
    return {srgb_curve(linear.x), srgb_curve(linear.y), srgb_curve(linear.z)};
}

}  // namespace brisance
