#include "render/input/volume_in_time.h"

#include <cmath>

#include "core/error.h"
#include "render/input/read_volume.h"
#include "retiming/choose_retiming.h"
#include "volume/frame_path.h"

namespace brisance {

namespace {

std::string pattern_of_own(const Shot& shot) {
    return shot.volume.file.empty() ? "" : (shot.folder / shot.volume.file).string();
}

std::string pattern_of_further(const Shot& shot, const FurtherVolume& volume) {
    return volume.volume.box ? "" : (shot.folder / volume.volume.file).string();
}

// All frames on disk, of which there is at least one.
std::vector<int> frames_of(const std::string& pattern) {
    std::vector<int> frames = frames_on_disk(pattern);
    if (frames.empty())
        resolve_frame(pattern, 1);  // says what is there instead
    return frames;
}

void refuse_times_of_nothing(const Shot& shot) {
    bool sequence = has_frame_token(pattern_of_own(shot)), given = !shot.time.identity();
    for (const FurtherVolume& volume : shot.volumes) {
        sequence = sequence || has_frame_token(pattern_of_further(shot, volume));
        given = given || volume.time;
    }
    if (given && !sequence)
        throw Error(ExitCode::Usage,
                    "time: no volume of the shot is a sequence, so that it has no time; write name.####.vdb for the "
                    "sequence, or remove what is given of time");
}

SourceFiles one_file(const std::filesystem::path& file) {
    return {file, file, {}};
}

// Settles one volume's retiming.
struct Settling {
    const std::string& pattern;
    const VolumeSettings& volume;
    const MediumSettings& look;
    TimeSettings time;
    VelocitySettings velocity;
};

void settle(Settling& s, Progress& progress) {
    if (s.time.identity() || is_settled(s.time, s.velocity))
        return;
    const std::vector<int> on_disk = frames_of(s.pattern);
    if (!may_interpolate(s.time, on_disk))
        return;
    progress.stage("time");
    const DecidingField field = deciding_field(s.pattern, on_disk, s.volume, s.look);
    const RetimingQuestion question{s.time.retime,         s.velocity, on_disk, 0, field.name, field.has_velocity,
                                    field.why_no_velocity, s.pattern};
    const RetimingChoice choice = choose_retiming(
        question, [&](int frame) { return read_deciding(resolve_frame(s.pattern, frame), s.volume, field, progress); });
    for (const std::string& line : choice.lines)
        progress.notice(line);
    s.time.retime = choice.retime;
    s.velocity = choice.velocity;
}

// For motion blur, where retiming has not settled the unit.
void settle_unit(Settling& s, Progress& progress) {
    if (s.velocity.unit != VelocityUnit::Automatic || s.velocity.scale == 0.0)
        return;
    const std::vector<int> on_disk = frames_of(s.pattern);
    if (on_disk.size() < 2)
        return;
    const DecidingField field = deciding_field(s.pattern, on_disk, s.volume, s.look);
    if (!field.has_velocity)
        return;
    progress.stage("unit of the velocity");
    const RetimingQuestion question{s.time.retime, s.velocity, on_disk, 0, field.name, true, "", s.pattern};
    const UnitChoice choice = choose_unit(
        question, [&](int frame) { return read_deciding(resolve_frame(s.pattern, frame), s.volume, field, progress); });
    progress.notice(choice.line);
    s.velocity = choice.velocity;
}

}  // namespace

SourceFiles source_files(const std::string& pattern, const TimeSettings& time, double frame) {
    if (!has_frame_token(pattern))
        return one_file(pattern);
    if (time.identity() && frame == std::round(frame)) {
        try {
            return one_file(resolve_frame(pattern, static_cast<int>(frame)));
        } catch (const Error& error) {
            if (error.code() != ExitCode::MissingInput || frames_on_disk(pattern).empty())
                throw;
            throw Error(error.code(), std::string(error.what()) +
                                          "; time.before, time.after and time.missing say what to show instead");
        }
    }
    const SourceTime moment = source_time(time, frame, frames_of(pattern), pattern);
    if (moment.empty)
        return {};
    const std::filesystem::path first = resolve_frame(pattern, moment.first);
    return {first, moment.single() ? first : resolve_frame(pattern, moment.second), moment};
}

SourceFiles own_files(const Shot& shot, double frame) {
    refuse_times_of_nothing(shot);
    const std::string pattern = pattern_of_own(shot);
    return pattern.empty() ? SourceFiles{} : source_files(pattern, shot.time, frame);
}

const TimeSettings& time_of(const Shot& shot, const FurtherVolume& volume) {
    return volume.time ? *volume.time : shot.time;
}

const VelocitySettings& velocity_of(const Shot& shot, const FurtherVolume& volume) {
    return volume.velocity ? *volume.velocity : shot.velocity;
}

std::vector<int> covering_frames(const Shot& shot) {
    const std::string pattern = pattern_of_own(shot);
    return covering_frames(shot.time, frames_of(pattern), pattern);
}

std::vector<std::filesystem::path> files_to_settle_time(const Shot& shot) {
    std::vector<std::filesystem::path> files;
    const auto add = [&](const Settling& s) {
        const std::vector<int> on_disk = has_frame_token(s.pattern) ? frames_on_disk(s.pattern) : std::vector<int>{};
        const bool settles = !(s.time.identity() || is_settled(s.time, s.velocity));
        const bool blurs = shot.shutter.length > 0.0 && s.velocity.unit == VelocityUnit::Automatic;
        if (on_disk.size() < 2 || !(settles || blurs))
            return;
        if (settles || deciding_field(s.pattern, on_disk, s.volume, s.look).has_velocity)
            for (const int frame : frames_looked_at(on_disk))
                files.push_back(resolve_frame(s.pattern, frame));
    };
    try {
        const std::string own = pattern_of_own(shot);
        add({own, shot.volume, shot.medium, shot.time, shot.velocity});
        for (const FurtherVolume& volume : shot.volumes) {
            const std::string pattern = pattern_of_further(shot, volume);
            const MediumSettings look = changed(shot.medium, volume.changes);
            add({pattern, volume.volume, look, time_of(shot, volume), velocity_of(shot, volume)});
        }
    } catch (const Error&) {
        return {};  // settling will say so
    }
    return files;
}

bool is_settled(const TimeSettings& time, const VelocitySettings& velocity) {
    return time.retime == Retime::Nearest || time.retime == Retime::Linear ||
           (time.retime == Retime::Advect && velocity.unit != VelocityUnit::Automatic);
}

Shot settle_time(const Shot& given, Progress& progress) {
    Shot shot = given;
    if (const std::string pattern = pattern_of_own(shot); has_frame_token(pattern)) {
        Settling own{pattern, shot.volume, shot.medium, shot.time, shot.velocity};
        settle(own, progress);
        if (given.shutter.length > 0.0)
            settle_unit(own, progress);
        shot.time = own.time;
        shot.velocity = own.velocity;
    }
    for (FurtherVolume& volume : shot.volumes) {
        const std::string pattern = pattern_of_further(shot, volume);
        if (!has_frame_token(pattern))
            continue;
        const MediumSettings look = changed(given.medium, volume.changes);
        Settling further{pattern, volume.volume, look, time_of(given, volume), velocity_of(given, volume)};
        const bool unit = given.shutter.length > 0.0 && further.velocity.unit == VelocityUnit::Automatic;
        if (is_settled(further.time, further.velocity) && !unit)
            continue;
        settle(further, progress);
        if (unit)
            settle_unit(further, progress);
        volume.time = further.time;
        volume.velocity = further.velocity;
    }
    return shot;
}

}  // namespace brisance
