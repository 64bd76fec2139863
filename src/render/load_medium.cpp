#include "render/load_medium.h"

#include "core/stopwatch.h"
#include "render/kept_inputs.h"
#include "volume/fog_box.h"
#include "volume/frame_path.h"
#include "volume/mapping.h"

namespace brisance {

namespace {

constexpr std::uint64_t kGridMemory = std::uint64_t{16} << 30;

// One file, and what the shot says of it.
struct VolumePart {
    std::filesystem::path file;
    VolumeSettings settings;
    MediumSettings look;
    MediumGrids grids;
};

std::vector<VolumePart> parts_of(const Shot& shot, const std::filesystem::path& volume, int frame) {
    std::vector<VolumePart> parts;
    if (!volume.empty())
        parts.push_back({volume, shot.volume, shot.medium, {}});
    const std::vector<std::filesystem::path> files = further_files(shot, frame);
    for (std::size_t i = 0; i < files.size(); ++i) {
        parts.push_back({files[i], shot.volumes[i].volume, changed(shot.medium, shot.volumes[i].changes), {}});
        if (shot.volumes[i].volume.box)
            parts.back().look.fire.model = FireModel::None;
    }
    return parts;
}

// The grids of one file: those that were read ahead, and the others now.
class GridSource {
public:
    GridSource(const std::filesystem::path& file, KeptInputs* kept) : file_(file) {
        if (kept)
            ahead_ = kept->volumes.take(file);
        if (!ahead_)
            reader_.emplace(file);
    }
    const std::vector<GridInfo>& grids() const { return ahead_ ? ahead_->grids : reader_->grids(); }
    BlockGrid read(const GridChoice& choice) {
        names_.emplace_back(choice.name, choice.index);
        if (ahead_)
            if (auto found = ahead_->voxels.extract(names_.back()))
                return std::move(found.mapped());
        if (!reader_)
            reader_.emplace(file_);
        return reader_->read(choice.name, choice.index, kGridMemory);
    }
    const std::vector<GridName>& names() const { return names_; }
    std::optional<double> seconds_ahead() const { return ahead_ ? std::optional(ahead_->seconds) : std::nullopt; }

private:
    std::filesystem::path file_;
    std::optional<ReadAhead::File> ahead_;
    std::optional<VdbReader> reader_;
    std::vector<GridName> names_;
};

MediumGrids read_grids(const VolumePart& part, const GridMapping& mapping, GridSource& source, Progress& progress) {
    const FireSettings& fire = part.look.fire;
    const bool black_body = fire.model == FireModel::Blackbody || fire.model == FireModel::NormalizedBlackbody;
    const dmat4 world_from_file = placement(part.settings, part.file.string());
    const auto read = [&](const std::optional<GridChoice>& choice, bool used) -> std::optional<BlockGrid> {
        if (!choice || !used)
            return std::nullopt;
        BlockGrid grid = source.read(*choice);
        grid.info.world_from_index = world_from_file * grid.info.world_from_index;
        return grid;
    };
    MediumGrids grids;
    grids.density = read(mapping.density, true);
    grids.temperature = read(mapping.temperature, black_body);
    grids.flame = read(mapping.flame, fire.model == FireModel::Flame || (black_body && fire.modulate_by_flame));
    grids.colour = read(mapping.colour, true);
    if (!mapping.density)
        progress.notice("no density grid: nothing absorbs or scatters");
    if (black_body && !mapping.temperature)
        progress.warning("no-temperature", "fire.model needs a temperature grid and none is mapped: nothing emits");
    if (fire.model == FireModel::Flame && !mapping.flame)
        progress.warning("no-flame", "fire.model is flame and no flame grid is mapped: nothing emits");
    return grids;
}

void make_box(VolumePart& part) {
    part.grids.density = fog_grid(*part.settings.box, kGridMemory, "volumes");
    dmat4& transform = part.grids.density->info.world_from_index;
    transform = placement(part.settings, "volumes") * transform;
}

void note_what_was_read(const GridSource& source, const VolumePart& part, std::uint64_t bytes, KeptInputs& kept) {
    std::error_code error;
    const std::uintmax_t of_file = std::filesystem::file_size(part.file, error);
    kept.grids.push_back(source.names());
    kept.bytes_read += bytes;
    kept.bytes_of_files += error ? 0 : of_file;
}

void read_part(VolumePart& part, Statistics& statistics, Progress& progress, KeptInputs* kept) {
    if (part.settings.box) {
        if (kept)
            kept->grids.emplace_back();
        return make_box(part);
    }
    progress.stage("reading " + part.file.filename().string());
    const Stopwatch watch;
    GridSource source(part.file, kept);
    const GridMapping mapping = map_grids(source.grids(), part.settings, part.file.string());
    progress.notice("grids: " + mapping.describe());
    for (const std::string& note : mapping.notes)
        progress.notice(note);
    part.grids = read_grids(part, mapping, source, progress);
    std::uint64_t bytes = 0;
    for (const auto* g : {&part.grids.density, &part.grids.temperature, &part.grids.flame, &part.grids.colour})
        bytes += *g ? (*g)->values.size() * sizeof(float) : 0;
    statistics.stages.push_back(
        {"reading", watch.seconds(), bytes, {{"file", part.file.string()}, {"mapping", mapping.describe()}}});
    if (const std::optional<double> ahead = source.seconds_ahead())
        statistics.stages.back().detail["seconds_ahead"] = *ahead;
    if (kept)
        note_what_was_read(source, part, bytes, *kept);
}

}  // namespace

std::vector<std::filesystem::path> further_files(const Shot& shot, int frame) {
    std::vector<std::filesystem::path> files;
    for (const FurtherVolume& v : shot.volumes) {
        const std::string pattern = v.volume.box ? "" : (shot.folder / v.volume.file).string();
        files.push_back(has_frame_token(pattern) ? resolve_frame(pattern, frame) : std::filesystem::path(pattern));
    }
    return files;
}

Medium load_medium(const Shot& shot, const std::filesystem::path& volume, int frame, Statistics& statistics,
                   Progress& progress, KeptInputs* kept) {
    if (kept) {
        kept->grids.clear();
        kept->bytes_read = kept->bytes_of_files = 0;
    }
    std::vector<VolumePart> parts = parts_of(shot, volume, frame);
    std::vector<MediumPart> media;
    for (VolumePart& part : parts) {
        read_part(part, statistics, progress, kept);
        media.push_back({part.grids, part.look, part.settings.half_voxel_shift});
    }
    progress.stage("medium");
    const Stopwatch watch;
    Medium medium = build_medium(media, progress);
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
