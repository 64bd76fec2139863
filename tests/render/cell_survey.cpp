#include "cell_survey.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "camera/camera.h"
#include "camera/pixel_filter.h"
#include "core/parallel.h"
#include "core/rng.h"
#include "fixtures/estimate.h"
#include "reference/path_tracer.h"

namespace brisance::testing {

namespace {

// A pixel's paths come in sets of one for each quarter of it, as edges cross few quarters. Sets are independent.
constexpr int kQuarters = 4;
constexpr int kLeastSets = 2;  // of a pixel, in each survey
// Of the other paths: evenly, by a target's radiance, and by its square. All targets have the same part.
constexpr double kEvenly = 0.3, kByRadiance = 0.2, kBySquare = 0.5;

using Colours = std::vector<dvec3>;  // of all pixels

Colours colours_of(const Image& image, const std::string& name) {
    const Layer& layer = image.layer(name);
    const std::size_t stride = layer.channels.size();
    Colours colours(layer.pixels.size() / stride);
    for (std::size_t p = 0; p < colours.size(); ++p)
        colours[p] = {layer.pixels[p * stride], layer.pixels[p * stride + 1], layer.pixels[p * stride + 2]};
    return colours;
}

double sum_of(const dvec3& c) {
    return c.x + c.y + c.z;
}

template <class Value>
void add_share(std::vector<double>& size, const Colours& colours, double share, const Value& value) {
    double sum = 0.0;
    for (const dvec3& c : colours)
        sum += value(c);
    for (std::size_t p = 0; p < size.size() && sum > 0.0; ++p)
        size[p] += share * value(colours[p]) / sum;
}

std::vector<double> sizes_of(const std::vector<Colours>& targets) {
    std::vector<double> size(targets.front().size(), kEvenly / double(targets.front().size()));
    for (const Colours& t : targets) {
        add_share(size, t, kByRadiance / double(targets.size()), [](const dvec3& c) { return glm::length(c); });
        add_share(size, t, kBySquare / double(targets.size()), [](const dvec3& c) { return glm::dot(c, c); });
    }
    return size;
}

// Sets of each pixel. Their number owes nothing to the paths, which leaves all sums without bias.
std::vector<int> allocated(const std::vector<Colours>& targets, int sets) {
    std::vector<int> of_pixels;
    for (const double size : sizes_of(targets))
        of_pixels.push_back(std::max(kLeastSets, int(std::lround(size * sets))));
    return of_pixels;
}

// Unbiased paths of a pixel, all random numbers independent of each other and of the picture's.
class PixelPaths {
public:
    PixelPaths(const FrameInput& input, const Shot& shot)
        : tracer_(input.medium, shot.tracing, shot.scattering.bounces, input.surroundings.get()),
          camera_(input.camera, input.medium) {}

    // The mean of a set.
    CellSum trace_set(std::size_t pixel, Rng& rng) const {
        CellSum mean{};
        for (int quarter = 0; quarter < kQuarters; ++quarter) {
            const CellSum path = trace(pixel, quarter, rng);
            for (int c = 0; c < kCells; ++c)
                mean[c] += path[c] / float(kQuarters);
        }
        return mean;
    }

private:
    CellSum trace(std::size_t pixel, int quarter, Rng& rng) const {
        const CameraSettings& s = camera_.settings();
        const glm::dvec2 at = point_in_cell(quarter, 2, rng) - 0.5;
        const double x = at.x, y = at.y, stratum = rng.next_double();
        const double column = double(pixel % s.width) + 0.5 + x * s.filter_width_pixels;
        const double row = double(pixel / s.width) + 0.5 + y * s.filter_width_pixels;
        PathSum path{};
        PathStatistics ignored;
        tracer_.trace(camera_.ray(column, row), stratum, rng, path, ignored);
        for (Rgb& cell : path.cells)
            cell *= filter_weight(s.filter, x, y);
        return path.cells;
    }

    PathTracer tracer_;
    Camera camera_;
};

// Of the picture, for an empty name.
dvec3 radiance_of(const CellSum& path, const std::string& name) {
    dvec3 sum(0.0);
    for (int c = 0; c < kCells; ++c)
        if (name.empty() || name == kCellNames[c])
            sum += dvec3(path[c]);
    return sum;
}

// What the differences I - x of a pixel's sets add to a target's sums.
class PixelSums {
public:
    void add(const dvec3& difference) {
        sum_ += difference;
        squares_ += difference * difference;
    }
    CellSums of(const dvec3& image, int sets) const {
        const double n = sets;
        // Over all pairs of sets.
        const dvec3 mean = sum_ / n, square = (sum_ * sum_ - squares_) / (n * (n - 1.0));
        CellSums s;
        s.difference = sum_of(mean);
        s.truth = sum_of(image - mean);
        s.squared_difference = sum_of(square);
        s.squared_truth = sum_of(image * (image - 2.0 * mean) + square);
        return s;
    }

private:
    dvec3 sum_{0.0}, squares_{0.0};
};

std::vector<double> column(const std::vector<CellSums>& sums, double CellSums::*value) {
    std::vector<double> out;
    for (const CellSums& s : sums)
        out.push_back(s.*value);
    return out;
}

}  // namespace

CellSums& CellSums::operator+=(const CellSums& other) {
    difference += other.difference;
    truth += other.truth;
    squared_difference += other.squared_difference;
    squared_truth += other.squared_truth;
    return *this;
}

Measurement ratio_of(const std::vector<double>& a, const std::vector<double>& b) {
    const double n = double(a.size());
    const double sum = std::accumulate(a.begin(), a.end(), 0.0), below = std::accumulate(b.begin(), b.end(), 0.0);
    if (!(below > 0.0))
        return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    const double q = sum / below;
    double square = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        square += (a[i] - q * b[i]) * (a[i] - q * b[i]);
    return {q, std::sqrt(square * n / (n - 1.0)) / below};
}

CellSurvey::CellSurvey(const FrameInput& input, const Shot& shot, const Image& picture, std::vector<std::string> cells,
                       int samples)
    : targets_(std::move(cells)) {
    targets_.insert(targets_.begin(), "");
    std::vector<Colours> images;
    for (const std::string& target : targets_)
        images.push_back(colours_of(picture, target));
    sums_.assign(targets_.size(), std::vector<CellSums>(kSurveys));
    const PixelPaths paths(input, shot);
    const std::vector<int> sets = allocated(images, samples / kQuarters);
    for (int number = 0; number < kSurveys; ++number) {
        std::vector<std::vector<PixelSums>> pixels(sets.size(), std::vector<PixelSums>(targets_.size()));
        parallel_for(pixels.size(), [&](std::size_t p) {
            for (int k = 0; k < sets[p]; ++k) {
                Rng rng(Stream::Certificate, std::uint64_t(number + 1) << 32 | p, std::uint64_t(k) + 1);
                const CellSum set = paths.trace_set(p, rng);
                for (std::size_t t = 0; t < targets_.size(); ++t)
                    pixels[p][t].add(images[t][p] - radiance_of(set, targets_[t]));
            }
        });
        for (std::size_t p = 0; p < pixels.size(); ++p)
            for (std::size_t t = 0; t < targets_.size(); ++t)
                sums_[t][number] += pixels[p][t].of(images[t][p], sets[p]);
    }
}

const std::vector<CellSums>& CellSurvey::of(const std::string& cell) const {
    return sums_[std::find(targets_.begin(), targets_.end(), cell) - targets_.begin()];
}

Measurement CellSurvey::mean_error(const std::vector<std::string>& cells) const {
    std::vector<CellSums> together(kSurveys);
    for (const std::string& cell : cells)
        for (int number = 0; number < kSurveys; ++number)
            together[number] += of(cell)[number];
    return ratio_of(column(together, &CellSums::difference), column(together, &CellSums::truth));
}

Measurement CellSurvey::mean_error(const std::string& cell, const std::string& whole) const {
    return ratio_of(column(of(cell), &CellSums::difference), column(of(whole), &CellSums::truth));
}

Measurement CellSurvey::squared_error(const std::string& cell, const std::string& whole) const {
    return ratio_of(column(of(cell), &CellSums::squared_difference), column(of(whole), &CellSums::squared_truth));
}

double CellSurvey::share(const std::string& cell) const {
    return ratio_of(column(of(cell), &CellSums::truth), column(of(""), &CellSums::truth)).value;
}

}  // namespace brisance::testing
