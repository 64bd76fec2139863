#include "metrics/flicker.h"

#include <cmath>
#include <limits>

#include "core/error.h"

namespace brisance {
namespace {

// One picture less another, pixel by pixel.
Picture error_of(const Picture& image, const Picture& reference) {
    Picture error = image;
    for (std::size_t i = 0; i < error.pixels.size(); ++i)
        error.pixels[i] -= reference.pixels[i];
    return error;
}

double dot(const Rgb& a, const Rgb& b) {
    return double(a.x) * b.x + double(a.y) * b.y + double(a.z) * b.z;
}

double root_ratio(double numerator, double denominator) {
    if (denominator > 0.0)
        return std::sqrt(std::max(0.0, numerator) / denominator);
    return numerator > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

// Errors against each half, in both frames; against the one reference twice where there is one.
struct HalfErrors {
    Picture a, b;

    explicit HalfErrors(const FrameAndReference& frame)
        : a(error_of(frame.image, frame.reference.first)),
          b(frame.reference.second ? error_of(frame.image, *frame.reference.second) : a) {}
};

void add_pixel(FlickerSums& sums, const Rgb& a, const Rgb& b, const Rgb& reference_a, const Rgb& reference_b) {
    const Rgb mean = 0.5f * (a + b), half = 0.5f * (a - b), target = 0.5f * (reference_a + reference_b);
    sums.change += dot(mean, mean);
    sums.cross += dot(a, b);
    sums.noise += dot(half, half);
    sums.reference += dot(target, target);
    sums.reference_cross += dot(reference_a, reference_b);
    ++sums.pixels;
}

}  // namespace

void FlickerSums::add(const FlickerSums& more) {
    change += more.change;
    cross += more.cross;
    noise += more.noise;
    reference += more.reference;
    reference_cross += more.reference_cross;
    pixels += more.pixels;
    finite += more.finite;
}

Flicker flicker_of(const FlickerSums& sums, bool halves) {
    Flicker result;
    result.sums = sums;
    result.seen = sums.finite > 0 ? double(sums.pixels) / double(sums.finite) : 0.0;
    result.error = root_ratio(sums.change, sums.reference);
    if (halves)
        result.halves =
            HalvesDifferences{root_ratio(sums.cross, sums.reference_cross), root_ratio(sums.noise, sums.reference)};
    return result;
}

Flicker measure_flicker(const FrameAndReference& frame, const FrameAndReference& next, const Motion& motion) {
    const UsableFrames usable = usable_frames(frame, next);
    if (motion.before.size() != next.image.pixels.size() || motion.width != next.image.width)
        throw Error(ExitCode::BadData, "the motion and the pictures are of different sizes");
    const HalfErrors before(frame), now(next);
    const Picture& first = next.reference.first;
    const Picture& second = next.reference.second ? *next.reference.second : first;
    FlickerSums sums;
    for (std::size_t i = 0; i < now.a.pixels.size(); ++i) {
        if (!usable.next[i])
            continue;
        ++sums.finite;
        Rgb a, b;
        if (sample_before(before.a, usable.frame, motion.before[i], a) &&
            sample_before(before.b, usable.frame, motion.before[i], b))
            add_pixel(sums, now.a.pixels[i] - a, now.b.pixels[i] - b, first.pixels[i], second.pixels[i]);
    }
    Flicker result = flicker_of(sums, next.reference.second.has_value());
    result.not_finite = usable.not_finite;
    return result;
}

}  // namespace brisance
