#include "render/input/load_medium.h"

#include <algorithm>

#include "core/stopwatch.h"
#include "render/input/carried_volume.h"
#include "render/input/kept_inputs.h"
#include "render/input/read_volume.h"
#include "volume/fog_box.h"

namespace brisance {

namespace {

constexpr std::uint64_t kBoxMemory = std::uint64_t{16} << 30;

// The shot's own volume is the file that is given, or a time between it and another one.
SourceFiles files_of_own(const Shot& shot, const std::filesystem::path& volume, int frame) {
    return shot.time.identity() ? SourceFiles{volume, volume, {}} : own_files(shot, frame);
}

std::vector<VolumePart> parts_of(const Shot& shot, const std::filesystem::path& volume, int frame) {
    const bool blurred = shot.shutter.length > 0.0;
    std::vector<VolumePart> parts;
    if (const SourceFiles own = volume.empty() ? SourceFiles{} : files_of_own(shot, volume, frame); !own.first.empty())
        parts.push_back({own, shot.volume, shot.medium, shot.time, shot.velocity, blurred, {}});
    for (const FurtherVolume& further : shot.volumes) {
        const std::string pattern = further.volume.box ? "" : (shot.folder / further.volume.file).string();
        const TimeSettings& time = time_of(shot, further);
        VolumePart part{
            {}, further.volume, changed(shot.medium, further.changes), time, velocity_of(shot, further), blurred, {}};
        if (further.volume.box)
            part.look.fire.model = FireModel::None;
        else
            part.files = source_files(pattern, time, frame);
        if (further.volume.box || !part.files.first.empty())
            parts.push_back(std::move(part));
    }
    return parts;
}

// Where the nodes that carry volumes are at the frame, and how they move while the shutter is open.
void carry(const Shot& shot, int frame, std::vector<VolumePart>& parts) {
    for (VolumePart& part : parts) {
        if (part.settings.node.empty())
            continue;
        const Carrier carrier(shot, part.settings.node);
        part.settings.world_from_file = carrier.at(frame) * part.settings.world_from_file;
        if (part.blurred)
            part.carried = carried_velocity(carrier, frame, shot.shutter);
    }
}

bool is_settled_part(const VolumePart& part) {
    const bool unit = !part.blurred || part.velocity.unit != VelocityUnit::Automatic;
    return part.settings.box || (part.files.single() ? unit : unit && is_settled(part.time, part.velocity));
}

void make_box(VolumePart& part) {
    part.grids.density = fog_grid(*part.settings.box, kBoxMemory, "volumes");
    dmat4& transform = part.grids.density->info.world_from_index;
    transform = placement(part.settings, "volumes") * transform;
}

StageCost reading_cost(const VolumePart& part, const ReadVolume& read, double seconds) {
    StageCost cost{"reading", seconds, read.bytes, {{"file", part.files.first.string()}, {"mapping", read.mapping}}};
    if (!part.files.single()) {
        cost.detail["second_file"] = part.files.second.string();
        cost.detail["weight_of_second"] = part.files.time.weight;
        cost.detail["retime"] = part.time.retime == Retime::Advect ? "advect" : "linear";
    }
    if (read.seconds_ahead)
        cost.detail["seconds_ahead"] = *read.seconds_ahead;
    return cost;
}

void note_what_was_read(const ReadVolume& read, const VolumePart& part, KeptInputs& kept) {
    std::error_code error;
    const std::uintmax_t of_file = std::filesystem::file_size(part.files.first, error);
    kept.grids.push_back(read.names);
    kept.bytes_read += read.bytes;
    kept.bytes_of_files += error ? 0 : of_file;
}

void read_part(VolumePart& part, Statistics& statistics, Progress& progress, KeptInputs* kept) {
    if (part.settings.box) {
        if (kept)
            kept->grids.emplace_back();
        return make_box(part);
    }
    const Stopwatch watch;
    const ReadVolume read = read_volume(part, kept ? &kept->volumes : nullptr, progress);
    statistics.stages.push_back(reading_cost(part, read, watch.seconds()));
    if (kept)
        note_what_was_read(read, part, *kept);
}

}  // namespace

std::vector<std::filesystem::path> further_files(const Shot& shot, int frame) {
    std::vector<std::filesystem::path> files;
    for (const FurtherVolume& v : shot.volumes) {
        const std::string pattern = v.volume.box ? "" : (shot.folder / v.volume.file).string();
        files.push_back(pattern.empty() ? "" : source_files(pattern, time_of(shot, v), frame).nearest());
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
    if (!std::all_of(parts.begin(), parts.end(), is_settled_part))
        parts = parts_of(settle_time(shot, progress), volume, frame);
    if (parts.empty()) {
        progress.notice("no volume at this time: an empty frame");
        return {};
    }
    carry(shot, frame, parts);
    std::vector<MediumPart> media;
    for (VolumePart& part : parts) {
        read_part(part, statistics, progress, kept);
        add_carried_velocity(part.carried, part.grids);
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
