#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <unordered_map>

#include "first_look/survey.h"

namespace brisance {

namespace {

constexpr std::size_t kMostCells = 150000;
constexpr std::size_t kMostSamples = 1000000;  // of a grid, for its percentile
constexpr double kRobust = 0.999;
constexpr int kBlock = BlockGrid::kBlock;

struct Sums {
    double density = 0.0;
    double flame = 0.0, flame_voxels = 0.0;
    double temperature = 0.0, hot_voxels = 0.0;
};

struct HashOfIndex {
    std::size_t operator()(const ivec3& i) const {
        return static_cast<std::size_t>(i.x) * 73856093u ^ static_cast<std::size_t>(i.y) * 19349663u ^
               static_cast<std::size_t>(i.z) * 83492791u;
    }
};

using CellMap = std::unordered_map<ivec3, Sums, HashOfIndex>;

std::optional<ValueSummary> summarize(const BlockGrid* grid) {
    if (grid == nullptr)
        return std::nullopt;
    ValueSummary out;
    std::vector<float> sample;
    double sum = 0.0;
    for (const float value : grid->values)
        if (value > 0.0f) {
            ++out.voxels;
            sum += value;
        }
    if (out.voxels == 0)
        return out;
    const std::size_t stride = out.voxels / kMostSamples + 1;
    std::size_t position = 0;
    for (const float value : grid->values)
        if (value > 0.0f && position++ % stride == 0)
            sample.push_back(value);
    const auto rank = sample.begin() + static_cast<std::ptrdiff_t>(kRobust * static_cast<double>(sample.size() - 1));
    std::nth_element(sample.begin(), rank, sample.end());
    out.most = *rank;
    out.mean = sum / static_cast<double>(out.voxels);
    return out;
}

// Calls visit(middle of a sub-cube in index space, sum of its values above zero, their number).
template <class Visit>
void for_sub_cubes(const BlockGrid& grid, int step, const Visit& visit) {
    for (std::size_t b = 0; b < grid.block_origin.size(); ++b) {
        const float* const values = &grid.values[b * kBlock * kBlock * kBlock];
        for (int x = 0; x < kBlock; x += step)
            for (int y = 0; y < kBlock; y += step)
                for (int z = 0; z < kBlock; z += step) {
                    double sum = 0.0, count = 0.0;
                    for (int i = x; i < x + step; ++i)
                        for (int j = y; j < y + step; ++j)
                            for (int k = z; k < z + step; ++k)
                                if (const float v = values[(i * kBlock + j) * kBlock + k]; v > 0.0f) {
                                    sum += v;
                                    count += 1.0;
                                }
                    if (count > 0.0)
                        visit(dvec3(grid.block_origin[b] + ivec3(x, y, z)) + 0.5 * (step - 1), sum, count);
                }
    }
}

const BlockGrid* first_of(std::initializer_list<const BlockGrid*> grids) {
    const BlockGrid* any = nullptr;
    for (const BlockGrid* const grid : grids) {
        if (grid != nullptr && !grid->empty())
            return grid;
        any = any ? any : grid;
    }
    return any;
}

int step_for(std::uint64_t voxels) {
    int step = 1;
    while (step < kBlock && voxels / static_cast<std::uint64_t>(step * step * step) > kMostCells)
        step *= 2;
    return step;
}

// The middle of a cell of `step` voxels along each axis.
dmat4 cell_transform(const dmat4& world_from_index, int step) {
    dmat4 m = world_from_index;
    for (int c = 0; c < 3; ++c)
        m[c] *= double(step);
    m[3] = world_from_index * glm::dvec4(dvec3(0.5 * (step - 1)), 1.0);
    return m;
}

}  // namespace

FrameSurvey survey_frame(int frame, const BlockGrid* density, const BlockGrid* flame, const BlockGrid* temperature) {
    FrameSurvey out;
    out.frame = frame;
    out.density = summarize(density);
    out.flame = summarize(flame);
    out.temperature = summarize(temperature);
    const BlockGrid* const lattice = first_of({density, flame, temperature});
    if (lattice == nullptr || lattice->empty())
        return out;
    std::uint64_t voxels = 0;
    for (const std::optional<ValueSummary>* s : {&out.density, &out.flame, &out.temperature})
        voxels = std::max(voxels, *s ? (*s)->voxels : 0);
    const int step = step_for(voxels);
    out.world_from_cell = cell_transform(lattice->info.world_from_index, step);
    const dmat4 cell_from_world = glm::inverse(out.world_from_cell);
    const double cell_volume = std::abs(glm::determinant(dmat3(out.world_from_cell)));
    CellMap cells;
    const auto add = [&](const BlockGrid* grid, const auto& take) {
        if (grid == nullptr)
            return;
        const double share = grid->info.voxel_volume() / cell_volume;
        const dmat4 cell_from_index = cell_from_world * grid->info.world_from_index;
        for_sub_cubes(*grid, step, [&](const dvec3& middle, double sum, double count) {
            const dvec3 at(cell_from_index * glm::dvec4(middle, 1.0));
            take(cells[ivec3(glm::round(at))], sum * share, count * share);
        });
    };
    add(density, [](Sums& s, double sum, double) { s.density += sum; });
    add(flame, [](Sums& s, double sum, double count) { s.flame += sum, s.flame_voxels += count; });
    add(temperature, [](Sums& s, double sum, double count) { s.temperature += sum, s.hot_voxels += count; });
    for (const auto& [index, s] : cells)
        out.cells.push_back({index, float(s.density), s.flame_voxels > 0.0 ? float(s.flame / s.flame_voxels) : 0.0f,
                             float(std::min(s.flame_voxels, 1.0)),
                             s.hot_voxels > 0.0 ? float(s.temperature / s.hot_voxels) : 0.0f});
    std::ranges::sort(out.cells, {}, [](const SurveyCell& c) { return std::tuple(c.index.x, c.index.y, c.index.z); });
    return out;
}

}  // namespace brisance
