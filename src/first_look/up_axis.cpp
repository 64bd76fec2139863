#include "first_look/up_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <utility>

namespace brisance {

namespace {

constexpr double kClearly = 2.0;         // as far along one axis as along the other
constexpr double kLeastMovement = 0.05;  // of the smoke's size
constexpr double kFlat = 0.25;           // floor's share of the widest layer, more than the ceiling's

struct Writer {
    const char* mark;  // within the writer's name, lower case
    const char* name;
    char up;
};

constexpr std::array<Writer, 6> kWriters = {{{"houdini", "Houdini", 'y'},
                                             {"blender", "Blender", 'z'},
                                             {"mantaflow", "Mantaflow", 'z'},
                                             {"brisance", "Brisance's own simulator", 'z'},
                                             {"maya", "Maya", 'y'},
                                             {"3ds max", "3ds Max", 'z'}}};

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

dvec3 middle_of(const FrameSurvey& frame, const SurveyCell& cell) {
    return dvec3(frame.world_from_cell * glm::dvec4(dvec3(cell.index), 1.0));
}

double amount(const SurveyCell& cell) {
    return double(cell.density) + double(cell.flame) * double(cell.flame_share);
}

struct Spread {
    dvec3 centre{0.0}, deviation{0.0};
    bool any = false;
};

Spread spread_of(const FrameSurvey& frame) {
    double total = 0.0;
    dvec3 sum(0.0), squares(0.0);
    for (const SurveyCell& cell : frame.cells) {
        const double w = amount(cell);
        const dvec3 p = middle_of(frame, cell) - dvec3(frame.world_from_cell[3]);
        total += w, sum += w * p, squares += w * p * p;
    }
    if (!(total > 0.0))
        return {};
    const dvec3 mean = sum / total;
    return {mean + dvec3(frame.world_from_cell[3]), glm::sqrt(glm::max(squares / total - mean * mean, dvec3(0.0))),
            true};
}

// Area of the lowest and of the highest layer over that of the widest, along an axis of the lattice.
std::pair<double, double> floor_and_ceiling(const FrameSurvey& frame, int axis) {
    std::map<int, double> layers;
    double mean = 0.0;
    for (const SurveyCell& cell : frame.cells)
        mean += amount(cell) / static_cast<double>(frame.cells.size());
    for (const SurveyCell& cell : frame.cells)
        if (amount(cell) > 0.1 * mean)
            layers[cell.index[axis]] += 1.0;
    if (layers.size() < 4)
        return {0.0, 0.0};
    double widest = 0.0;
    for (const auto& [layer, area] : layers)
        widest = std::max(widest, area);
    // A floor may cut through the first layer of cells.
    const auto second = std::next(layers.begin()), last_but_one = std::prev(layers.end(), 2);
    return {std::max(layers.begin()->second, second->second) / widest,
            std::max(layers.rbegin()->second, last_but_one->second) / widest};
}

std::optional<UpAxis> by_writer(const SequenceSurvey& survey) {
    for (const Writer& writer : kWriters)
        if (lower(survey.writer).find(writer.mark) != std::string::npos)
            return UpAxis{writer.up, fmt::format("written by {}, where {} is up", writer.name, writer.up)};
    return std::nullopt;
}

std::optional<UpAxis> by_movement(const SequenceSurvey& survey) {
    Spread first, last;
    for (const FrameSurvey& frame : survey.seen) {
        const Spread spread = spread_of(frame);
        if (!spread.any)
            continue;
        if (!first.any)
            first = spread;
        last = spread;
    }
    if (!first.any)
        return std::nullopt;
    const dvec3 way = last.centre - first.centre;
    const double size = glm::length(last.deviation);
    for (const auto& [axis, letter, other] : {std::tuple(1, 'y', 2), std::tuple(2, 'z', 1)})
        if (way[axis] > kLeastMovement * size && way[axis] > kClearly * std::abs(way[other]))
            return UpAxis{letter, fmt::format("the smoke moves {:.2g} along {} from the first frame to the last, and "
                                              "{:.2g} along {}",
                                              way[axis], letter, way[other], letter == 'y' ? 'z' : 'y')};
    return std::nullopt;
}

std::optional<UpAxis> by_floor(const SequenceSurvey& survey) {
    double y = 0.0, z = 0.0;
    for (const FrameSurvey& frame : survey.seen) {
        const auto [y_floor, y_ceiling] = floor_and_ceiling(frame, 1);
        const auto [z_floor, z_ceiling] = floor_and_ceiling(frame, 2);
        y += (y_floor - y_ceiling) / static_cast<double>(survey.seen.size());
        z += (z_floor - z_ceiling) / static_cast<double>(survey.seen.size());
    }
    if (std::max(y, z) < kFlat || std::abs(y - z) < kFlat)
        return std::nullopt;
    const char axis = y > z ? 'y' : 'z';
    return UpAxis{axis, fmt::format("it stands on a flat floor across {}", axis)};
}

}  // namespace

UpAxis guess_up_axis(const SequenceSurvey& survey) {
    if (const auto up = by_writer(survey))
        return *up;
    if (const auto up = by_movement(survey))
        return *up;
    if (const auto up = by_floor(survey))
        return *up;
    return {'y', "neither the writer nor the shape says, and most programs have y up"};
}

}  // namespace brisance
