#include "metrics/passing_change.h"

#include <cmath>
#include <limits>

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
        Rgb then, next;
        if (!sample_before(before.picture, {}, before.motion.before[i], then) ||
            !sample_before(after.picture, {}, after.motion.before[i], next))
            continue;
        const Rgb difference = frame.pixels[i] - 0.5f * (then + next);
        if (!is_finite(difference))
            continue;
        change += square(difference);
        norm += square(frame.pixels[i]);
        ++count;
    }
    PassingChange out;
    out.seen = frame.pixels.empty() ? 0.0 : double(count) / double(frame.pixels.size());
    if (norm > 0.0)
        out.change = std::sqrt(change / norm);
    else if (change > 0.0)
        out.change = std::numeric_limits<double>::infinity();
    return out;
}

}  // namespace brisance
