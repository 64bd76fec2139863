#include "first_look/view.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "medium/emission.h"

namespace brisance {

namespace {

constexpr double kCellsPerPixel = 2.0;  // across, so that cells cover the picture without gaps
constexpr double kMostPixels = 1 << 22;

// Cells along the same line of sight share a pixel.
class Pixels {
public:
    Pixels(const View& view, const ViewAxes& axes) : axes_(axes), side_(kCellsPerPixel * view.cell_metres) {
        glm::dvec2 low(INFINITY), high(-INFINITY);
        for (const ViewCell& c : view.cells) {
            const glm::dvec2 p = project(c);
            low = glm::min(low, p), high = glm::max(high, p);
        }
        if (view.cells.empty())
            return;
        const glm::dvec2 extent = high - low;
        side_ = std::max(side_, std::sqrt(extent.x * extent.y / kMostPixels));
        low_ = low;
        width_ = static_cast<std::size_t>(extent.x / side_) + 1;
        height_ = static_cast<std::size_t>(extent.y / side_) + 1;
    }
    std::size_t count() const { return width_ * height_; }
    double area() const { return side_ * side_; }
    std::size_t of(const ViewCell& c) const {
        const glm::dvec2 p = (project(c) - low_) / side_;
        return std::min(static_cast<std::size_t>(p.y), height_ - 1) * width_ +
               std::min(static_cast<std::size_t>(p.x), width_ - 1);
    }

private:
    glm::dvec2 project(const ViewCell& c) const {
        return {glm::dot(c.position, axes_.right), glm::dot(c.position, axes_.up)};
    }

    const ViewAxes& axes_;
    double side_;
    glm::dvec2 low_{0.0};
    std::size_t width_ = 0, height_ = 0;
};

double mean_weighted_by_itself(const std::vector<double>& values) {
    double sum = 0.0, squares = 0.0;
    for (const double v : values)
        sum += v, squares += v * v;
    return sum > 0.0 ? squares / sum : 0.0;
}

}  // namespace

ViewAxes first_view() {
    ViewAxes axes;
    axes.back = glm::normalize(dvec3(0.25, -1.0, 0.22));
    axes.right = glm::normalize(glm::cross(dvec3(0.0, 0.0, 1.0), axes.back));
    axes.up = glm::cross(axes.back, axes.right);
    return axes;
}

View make_view(const FrameSurvey& frame, const dmat4& world_from_file, const ViewAxes& axes) {
    View view;
    const dmat4 m = world_from_file * frame.world_from_cell;
    const double volume = std::abs(glm::determinant(dmat3(m)));
    view.cell_metres = std::cbrt(volume);
    view.cells.reserve(frame.cells.size());
    for (const SurveyCell& cell : frame.cells)
        view.cells.push_back({dvec3(m * glm::dvec4(dvec3(cell.index), 1.0)), volume, cell});
    std::ranges::stable_sort(view.cells, std::greater(),
                             [&](const ViewCell& c) { return glm::dot(c.position, axes.back); });
    return view;
}

double column_depth(const View& view, const ViewAxes& axes) {
    const Pixels pixels(view, axes);
    std::vector<double> depth(pixels.count(), 0.0);
    for (const ViewCell& c : view.cells)
        depth[pixels.of(c)] += double(c.cell.density) * c.volume / pixels.area();
    return mean_weighted_by_itself(depth);
}

Seen look_through(const View& view, const ViewAxes& axes, const MediumSettings& medium) {
    const Pixels pixels(view, axes);
    const SourceRadiance radiance(medium.fire);
    const bool direct = medium.fire.convention == EmissionConvention::Direct;
    std::vector<double> transmittance(pixels.count(), 1.0), glow(pixels.count(), 0.0);
    std::vector<double> shine(view.cells.size());
    Seen seen;
    seen.weight.resize(view.cells.size());
    for (std::size_t i = 0; i < view.cells.size(); ++i) {
        const ViewCell& c = view.cells[i];
        const std::size_t p = pixels.of(c);
        const double depth = double(medium.smoke.extinction_per_metre) * c.cell.density * c.volume / pixels.area();
        const double covered = transmittance[p] * -std::expm1(-depth);
        const Rgb fire = radiance({c.cell.temperature, c.cell.flame, Rgb(1.0f)});
        const double source = luminance(direct ? fire : fire * (Rgb(1.0f) - medium.smoke.albedo));
        shine[i] =
            direct ? transmittance[p] * source * c.cell.flame_share * c.volume / pixels.area() : covered * source;
        glow[p] += shine[i];
        seen.weight[i] = covered * pixels.area();
        transmittance[p] *= std::exp(-depth);
    }
    seen.brightness = mean_weighted_by_itself(glow);
    for (std::size_t i = 0; i < view.cells.size() && seen.brightness > 0.0; ++i)
        seen.weight[i] = std::max(seen.weight[i], std::min(1.0, shine[i] / seen.brightness) * pixels.area());
    for (double& t : transmittance)
        t = 1.0 - t;
    seen.opacity = mean_weighted_by_itself(transmittance);
    return seen;
}

}  // namespace brisance
