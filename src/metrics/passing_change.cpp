#include "metrics/passing_change.h"

#include <cmath>

#include "core/error.h"

namespace brisance {
namespace {

double square(const Rgb& c) {
    return double(c.x) * c.x + double(c.y) * c.y + double(c.z) * c.z;
}

bool is_finite(const Rgb& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

bool fits(const Picture& frame, const Neighbour& neighbour) {
    const Picture& picture = neighbour.picture;
    const Motion& motion = neighbour.motion;
    return picture.width == frame.width && picture.height == frame.height && motion.width == frame.width &&
           motion.height == frame.height;
}

}  // namespace

PassingChange passing_change(const Picture& frame, const Neighbour& before, const Neighbour& after) {
    if (!fits(frame, before) || !fits(frame, after))
        throw Error(ExitCode::BadData, "frames of a sequence are of different sizes");
    double change = 0.0, norm = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < frame.pixels.size(); ++i) {
        Rgb then = before.picture.pixels[i], next = after.picture.pixels[i], moved;
        const bool seen_before = sample_before(before.picture, {}, before.motion.before[i], moved);
        if (seen_before)
            then = moved;
        const bool seen_after = sample_before(after.picture, {}, after.motion.before[i], moved);
        if (seen_after)
            next = moved;
        const Rgb difference = frame.pixels[i] - 0.5f * (then + next);
        if (!is_finite(difference))
            continue;
        change += square(difference);
        norm += (square(then) + square(frame.pixels[i]) + square(next)) / 3.0;
        count += seen_before && seen_after;
    }
    PassingChange out;
    out.seen = frame.pixels.empty() ? 0.0 : double(count) / double(frame.pixels.size());
    out.change = norm > 0.0 ? std::sqrt(change / norm) : 0.0;
    return out;
}

}  // namespace brisance
