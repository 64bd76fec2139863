#include "render/load_medium.h"

#include "core/stopwatch.h"
#include "volume/mapping.h"

namespace brisance {

namespace {

constexpr std::uint64_t kGridMemory = std::uint64_t{16} << 30;

MediumGrids read_grids(const Shot& shot, const std::filesystem::path& volume, const GridMapping& mapping,
                       Progress& progress) {
    const FireModel fire = shot.medium.fire.model;
    const bool black_body = fire == FireModel::Blackbody || fire == FireModel::NormalizedBlackbody;
    const auto read = [&](const std::optional<GridChoice>& choice, bool used) -> std::optional<BlockGrid> {
        if (!choice || !used)
            return std::nullopt;
        return read_grid(volume, choice->name, choice->index, kGridMemory);
    };
    MediumGrids grids;
    grids.density = read(mapping.density, true);
    grids.temperature = read(mapping.temperature, black_body);
    grids.flame = read(mapping.flame, fire == FireModel::Flame || (black_body && shot.medium.fire.modulate_by_flame));
    grids.colour = read(mapping.colour, true);
    if (!mapping.density)
        progress.notice("no density grid: nothing absorbs or scatters");
    if (black_body && !mapping.temperature)
        progress.warning("no-temperature", "fire.model asks for a temperature grid and none is mapped: nothing emits");
    if (fire == FireModel::Flame && !mapping.flame)
        progress.warning("no-flame", "fire.model is flame and no flame grid is mapped: nothing emits");
    return grids;
}

}  // namespace

Medium load_medium(const Shot& shot, const std::filesystem::path& volume, Statistics& statistics, Progress& progress) {
    progress.stage("reading " + volume.filename().string());
    Stopwatch watch;
    const GridMapping mapping = map_grids(list_grids(volume), shot.volume, volume.string());
    progress.notice("grids: " + mapping.describe());
    for (const std::string& note : mapping.notes)
        progress.notice(note);
    const MediumGrids grids = read_grids(shot, volume, mapping, progress);
    std::uint64_t bytes = 0;
    for (const auto* g : {&grids.density, &grids.temperature, &grids.flame, &grids.colour})
        bytes += *g ? (*g)->values.size() * sizeof(float) : 0;
    statistics.stages.push_back(
        {"reading", watch.seconds(), bytes, {{"file", volume.string()}, {"mapping", mapping.describe()}}});

    progress.stage("medium");
    watch = Stopwatch();
    Medium medium = build_medium(grids, shot.medium, shot.volume.half_voxel_shift, progress);
    std::size_t nodes = 0;
    for (float e : medium.extinction)
        nodes += e > 0.0f;
    statistics.stages.push_back({"medium",
                                 watch.seconds(),
                                 medium.bytes(),
                                 {{"bricks", medium.lattice.brick_count()},
                                  {"absorbing_nodes", nodes},
                                  {"voxel_metres", medium.spacing},
                                  {"largest_extinction_per_metre", medium.max_extinction}}});
    if (medium.lattice.empty())
        progress.notice("the volume is empty: a black frame");
    return medium;
}

}  // namespace brisance
