#include "metrics/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "core/error.h"
#include "core/parallel.h"

namespace brisance {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// The rows of worldToNDC that mean the same to all programs: x and y before division by the depth, and the depth.
struct Projection {
    dmat3 rows;
    dvec3 shift;

    explicit Projection(const dmat4& m)
        : rows(dvec3(m[0].x, m[0].y, m[0].w), dvec3(m[1].x, m[1].y, m[1].w), dvec3(m[2].x, m[2].y, m[2].w)),
          shift(m[3].x, m[3].y, m[3].w) {}
    dvec3 operator()(const dvec3& world) const { return rows * world + shift; }
};

std::size_t index_of(const Plane& plane, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width) + static_cast<std::size_t>(x);
}

// Whether the nearest pixel of the frame before shows that depth.
bool was_seen(const Plane& depth, const glm::dvec2& at, double expected) {
    const int x = static_cast<int>(std::floor(at.x)), y = static_cast<int>(std::floor(at.y));
    if (x < 0 || y < 0 || x >= depth.width || y >= depth.height)
        return false;
    const double there = depth.values[index_of(depth, x, y)];
    return std::abs(there - expected) <= kSameDepth * std::max(there, expected);
}

}  // namespace

Motion camera_motion(const SeenFrame& frame, const SeenFrame& before) {
    const Plane& depth = frame.depth;
    if (depth.width != before.depth.width || depth.height != before.depth.height)
        throw Error(ExitCode::BadData, "motion: depths of different sizes");
    const Projection now(frame.ndc_from_world), then(before.ndc_from_world);
    const double size = std::abs(glm::determinant(now.rows));
    if (!(size > 0.0) || !std::isfinite(size))
        throw Error(ExitCode::BadData, "motion: the camera's matrix (worldToNDC) cannot be inverted");
    const dmat3 inverse = glm::inverse(now.rows);
    Motion motion{depth.width, depth.height, std::vector<glm::dvec2>(depth.values.size(), glm::dvec2(kNan))};
    parallel_for(static_cast<std::size_t>(depth.height), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < depth.width; ++x) {
            const std::size_t i = index_of(depth, x, y);
            const double z = depth.values[i];
            if (!(z > 0.0) || !std::isfinite(z))
                continue;
            const dvec3 clip = z * dvec3((x + 0.5) / depth.width, (y + 0.5) / depth.height, 1.0);
            const dvec3 seen = then(inverse * (clip - now.shift));
            if (!(seen.z > 0.0))
                continue;
            const glm::dvec2 at(seen.x / seen.z * depth.width, seen.y / seen.z * depth.height);
            if (was_seen(before.depth, at, seen.z))
                motion.before[i] = at;
        }
    });
    return motion;
}

Motion motion_of_vectors(const Plane& x, const Plane& y) {
    if (x.width != y.width || x.height != y.height)
        throw Error(ExitCode::BadData, "motion: vectors of different sizes");
    Motion motion{x.width, x.height, std::vector<glm::dvec2>(x.values.size())};
    for (int row = 0; row < x.height; ++row)
        for (int column = 0; column < x.width; ++column) {
            const std::size_t i = index_of(x, column, row);
            motion.before[i] = glm::dvec2(column + 0.5 + x.values[i], row + 0.5 + y.values[i]);
        }
    return motion;
}

bool sample_before(const Picture& picture, const std::vector<bool>& usable, const glm::dvec2& at, Rgb& colour) {
    if (!std::isfinite(at.x) || !std::isfinite(at.y))
        return false;
    const double x = at.x - 0.5, y = at.y - 0.5;
    // Half a pixel's rounding beyond the outermost centres still counts as on them.
    constexpr double kRounding = 1e-4;
    if (x < -kRounding || y < -kRounding || x > picture.width - 1 + kRounding || y > picture.height - 1 + kRounding)
        return false;
    const int left = std::clamp(static_cast<int>(std::floor(x)), 0, std::max(picture.width - 2, 0));
    const int top = std::clamp(static_cast<int>(std::floor(y)), 0, std::max(picture.height - 2, 0));
    const int right = std::min(left + 1, picture.width - 1), bottom = std::min(top + 1, picture.height - 1);
    const auto u = static_cast<float>(std::clamp(x - left, 0.0, 1.0));
    const auto v = static_cast<float>(std::clamp(y - top, 0.0, 1.0));
    const auto width = static_cast<std::size_t>(picture.width);
    colour = Rgb(0.0f);
    for (const auto& [column, row, weight] :
         {std::tuple(left, top, (1.0f - u) * (1.0f - v)), std::tuple(right, top, u * (1.0f - v)),
          std::tuple(left, bottom, (1.0f - u) * v), std::tuple(right, bottom, u * v)}) {
        if (weight == 0.0f)
            continue;  // a neighbour without a say need not be usable
        const std::size_t i = static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
        if (!usable.empty() && !usable[i])
            return false;
        colour += weight * picture.pixels[i];
    }
    return true;
}

}  // namespace brisance
