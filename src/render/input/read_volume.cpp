#include "render/input/read_volume.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "render/input/frame_velocity.h"
#include "retiming/between_frames.h"
#include "volume/frame_path.h"
#include "volume/mapping.h"
#include "volume/vector_parts.h"
#include "volume/velocity_mapping.h"

namespace brisance {

namespace {

constexpr std::uint64_t kGridMemory = std::uint64_t{16} << 30;

// In the order of SourceFrame's fields.
constexpr std::size_t kDensity = 0, kTemperature = 1, kFlame = 2, kColour = 3, kRoles = 4;
constexpr std::array<const char*, kRoles> kRoleTitles = {"density", "temperature", "flame", "colour"};

bool is_black_body(const FireSettings& fire) {
    return fire.model == FireModel::Blackbody || fire.model == FireModel::NormalizedBlackbody;
}

// Which roles a look needs.
std::array<bool, kRoles> needed_roles(const FireSettings& fire) {
    const bool black_body = is_black_body(fire);
    return {true, black_body, fire.model == FireModel::Flame || (black_body && fire.modulate_by_flame), true};
}

std::array<const std::optional<GridChoice>*, kRoles> choices(const GridMapping& mapping) {
    return {&mapping.density, &mapping.temperature, &mapping.flame, &mapping.colour};
}

void say_what_is_missing(const FireSettings& fire, const GridMapping& mapping, Progress& progress) {
    if (!mapping.density)
        progress.notice("no density grid: nothing absorbs or scatters");
    if (is_black_body(fire) && !mapping.temperature)
        progress.warning("no-temperature", "fire.model needs a temperature grid and none is mapped: nothing emits");
    if (fire.model == FireModel::Flame && !mapping.flame)
        progress.warning("no-flame", "fire.model is flame and no flame grid is mapped: nothing emits");
}

// One file, open.
class OpenVolume {
public:
    OpenVolume(const std::filesystem::path& file, const VolumeSettings& settings, ReadAhead* ahead = nullptr)
        : file_(file), settings_(settings), ahead_(ahead ? ahead->take(file) : std::nullopt) {
        if (!ahead_)
            reader_.emplace(file);
        mapping_ = map_grids(grids(), settings, file.string());
    }

    const GridMapping& mapping() const { return mapping_; }

    std::vector<std::optional<BlockGrid>> fields(const std::array<bool, kRoles>& needed) {
        std::vector<std::optional<BlockGrid>> out(kRoles);
        for (std::size_t role = 0; role < kRoles; ++role)
            if (const std::optional<GridChoice>& choice = *choices(mapping_)[role]; choice && needed[role])
                out[role] = read(*choice);
        if (needed[kColour] && mapping_.colour_parts.size() == 3)
            out[kColour] = join_vector_parts(
                {read(mapping_.colour_parts[0]), read(mapping_.colour_parts[1]), read(mapping_.colour_parts[2])},
                file_.string());
        return out;
    }

    bool has_velocity() const { return !map_velocity(grids(), settings_.grids, file_.string()).grids.empty(); }

    CentredVelocity velocity(Progress& progress) {
        const VelocityMapping mapping = map_velocity(grids(), settings_.grids, file_.string());
        VelocityGrids found;
        for (const GridChoice& choice : mapping.grids) {
            found.push_back(read(choice));
            if (const std::uint64_t bad = found.back().census.nan_voxels; bad > 0)
                progress.warning("nan", fmt::format("{}: grid '{}': {} NaN or infinite velocities read as 0",
                                                    file_.string(), choice.name, bad));
        }
        CentredVelocity velocity = centred_velocity(found);
        if (velocity.outliers > 0)
            progress.warning("velocity",
                             fmt::format("{}: {} of its velocities are above {:.3g}, four times the 99th "
                                         "percentile (up to {:.3g}), and are clamped to it",
                                         file_.string(), velocity.outliers, velocity.limit, velocity.largest));
        return velocity;
    }

    const std::vector<GridName>& names() const { return names_; }
    std::optional<double> seconds_ahead() const { return ahead_ ? std::optional(ahead_->seconds) : std::nullopt; }

private:
    const std::vector<GridInfo>& grids() const { return ahead_ ? ahead_->grids : reader_->grids(); }

    // What was read ahead, or now.
    BlockGrid read(const GridChoice& choice) {
        names_.emplace_back(choice.name, choice.index);
        if (ahead_)
            if (auto found = ahead_->voxels.extract(names_.back()))
                return std::move(found.mapped());
        if (!reader_)
            reader_.emplace(file_);
        return reader_->read(choice.name, choice.index, kGridMemory);
    }

    std::filesystem::path file_;
    const VolumeSettings& settings_;
    std::optional<ReadAhead::File> ahead_;
    std::optional<VdbReader> reader_;
    GridMapping mapping_;
    std::vector<GridName> names_;
};

// Whether the smoke is to be blurred by its velocity, which is not looked for where the shutter is closed. A notice
// says what keeps it from that.
bool blurs(const VolumePart& part, const OpenVolume& volume, Progress& progress) {
    if (!part.blurred || part.velocity.scale == 0.0 || !volume.has_velocity())
        return false;
    if (part.velocity.unit != VelocityUnit::Automatic)
        return true;
    progress.notice(
        "motion blur: the unit of the velocity is told from neighbouring frames alone: the smoke is not "
        "blurred; set velocity.unit, such as second for m/s, or shutter.length=0");
    return false;
}

SourceFrame read_frame(const std::filesystem::path& file, const VolumePart& part, bool moves, Progress& progress) {
    OpenVolume volume(file, part.settings);
    return {volume.fields(needed_roles(part.look.fire)), moves ? volume.velocity(progress) : CentredVelocity{}};
}

std::string describe_all(const GridMapping& mapping, const VolumePart& part, Progress& progress) {
    progress.notice("grids: " + mapping.describe());
    for (const std::string& note : mapping.notes)
        progress.notice(note);
    say_what_is_missing(part.look.fire, mapping, progress);
    return mapping.describe();
}

Fields read_between(VolumePart& part, std::string& mapping, Progress& progress) {
    const SourceTime& time = part.files.time;
    const bool moves = part.time.retime == Retime::Advect;
    OpenVolume nearest(part.files.nearest(), part.settings);
    mapping = describe_all(nearest.mapping(), part, progress);
    const bool blurred = blurs(part, nearest, progress);
    const std::string where = part.files.first.string();
    const BetweenFrames pair{read_frame(part.files.first, part, moves || blurred, progress),
                             read_frame(part.files.second, part, moves || blurred, progress), time.weight,
                             time.second - time.first, where};
    if (blurred)
        part.grids.velocity = frame_velocity(pair, part.velocity, time.rate, placement(part.settings, where));
    progress.stage(fmt::format("{} {} and {}", moves ? "advecting" : "blending", part.files.first.filename().string(),
                               part.files.second.filename().string()));
    if (moves && pair.first.velocity.empty() && pair.second.velocity.empty())
        progress.warning("velocity",
                         where + ": neither it nor the next frame has a velocity: they are blended in place");
    return moves ? advected(pair, part.velocity) : blended(pair);
}

}  // namespace

ReadVolume read_volume(VolumePart& part, ReadAhead* ahead, Progress& progress) {
    const dmat4 world_from_file = placement(part.settings, part.files.first.string());
    ReadVolume out;
    Fields fields;
    if (part.files.single()) {
        progress.stage("reading " + part.files.first.filename().string());
        OpenVolume volume(part.files.first, part.settings, ahead);
        out.mapping = describe_all(volume.mapping(), part, progress);
        fields = volume.fields(needed_roles(part.look.fire));
        if (blurs(part, volume, progress))
            part.grids.velocity =
                frame_velocity(volume.velocity(progress), part.velocity, part.files.time.rate, world_from_file);
        out.names = volume.names();
        out.seconds_ahead = volume.seconds_ahead();
    } else {
        progress.stage("reading " + part.files.first.filename().string() + " and " +
                       part.files.second.filename().string());
        fields = read_between(part, out.mapping, progress);
    }
    for (std::optional<BlockGrid>& field : fields)
        if (field) {
            field->info.world_from_index = world_from_file * field->info.world_from_index;
            out.bytes += field->values.size() * sizeof(float);
        }
    part.grids = {std::move(fields[kDensity]), std::move(fields[kTemperature]), std::move(fields[kFlame]),
                  std::move(fields[kColour]), std::move(part.grids.velocity)};
    return out;
}

DecidingField deciding_field(const std::string& pattern, const std::vector<int>& on_disk,
                             const VolumeSettings& settings, const MediumSettings& look) {
    std::filesystem::path largest;
    std::uintmax_t most = 0;
    for (const int frame : on_disk) {
        const std::filesystem::path file = resolve_frame(pattern, frame);
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(file, error);
        if (!error && (largest.empty() || size > most)) {
            largest = file;
            most = size;
        }
    }
    const std::vector<GridInfo> grids = list_grids(largest);
    const GridMapping mapping = map_grids(grids, settings, largest.string());
    const std::array<bool, kRoles> needed = needed_roles(look.fire);
    DecidingField field;
    for (const std::size_t role : {kColour, kTemperature, kFlame, kDensity})
        if (*choices(mapping)[role] && needed[role])
            field.role = role;
    field.name = kRoleTitles[field.role];
    const VelocityMapping velocity = map_velocity(grids, settings.grids, largest.string());
    field.has_velocity = !velocity.grids.empty();
    field.why_no_velocity = velocity.why_none;
    return field;
}

SourceFrame read_deciding(const std::filesystem::path& file, const VolumeSettings& settings, const DecidingField& field,
                          Progress& progress) {
    OpenVolume volume(file, settings);
    std::array<bool, kRoles> wanted{};
    wanted[field.role] = true;
    SourceFrame frame;
    frame.fields = {std::move(volume.fields(wanted)[field.role])};
    if (field.has_velocity)
        frame.velocity = volume.velocity(progress);
    return frame;
}

}  // namespace brisance
