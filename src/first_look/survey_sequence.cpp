#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <system_error>

#include "core/error.h"
#include "first_look/survey.h"
#include "volume/vdb_file.h"
#include "volume/vdb_header.h"

namespace brisance {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSurveyMemory = std::uint64_t{16} << 30;

std::uintmax_t size_of(const FrameFile& frame) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(frame.file, error);
    return error ? 0 : size;
}

bool burns(const FrameSurvey& frame) {
    return frame.flame && frame.flame->voxels > 0;
}

bool is_empty(const GridInfo& grid) {
    return grid.active_max.x < grid.active_min.x;
}

// Blender's and Houdini's marks where the file does not name its writer.
std::string writer_of(const std::vector<GridInfo>& grids) {
    std::set<std::string> names;
    for (const GridInfo& grid : grids) {
        if (!grid.creator.empty())
            return grid.creator;
        names.insert(grid.name);
    }
    return names.contains("shadow") && names.contains("density") ? "Blender (it has Mantaflow's shadow grid)" : "";
}

class Surveyor {
public:
    Surveyor(const VolumeSettings& settings, Progress& progress) : settings_(settings), progress_(progress) {}

    // False where the file cannot be read: a damaged frame does not keep the others from a look.
    bool add(const FrameFile& file, SequenceSurvey& out) {
        try {
            progress_.stage("looking at " + file.file.filename().string());
            VdbReader reader(file.file);
            const GridMapping mapping = map_grids(reader.grids(), settings_, file.file.string());
            const auto read = [&](const std::optional<GridChoice>& choice) -> std::optional<BlockGrid> {
                if (!choice)
                    return std::nullopt;
                return reader.read(choice->name, choice->index, kSurveyMemory);
            };
            const auto pointer = [](const std::optional<BlockGrid>& grid) { return grid ? &*grid : nullptr; };
            const auto density = read(mapping.density), flame = read(mapping.flame);
            const auto temperature = read(mapping.temperature);
            out.seen.push_back(survey_frame(file.frame, pointer(density), pointer(flame), pointer(temperature)));
            if (out.writer.empty())
                out.writer = writer_of(reader.grids());
            if (out.seen.back().cells.size() >= most_cells_) {
                most_cells_ = out.seen.back().cells.size();
                out.mapping = mapping;
            }
            return true;
        } catch (const Error& error) {
            if (!first_)
                first_.emplace(error);
            out.notes.push_back(fmt::format("frame {} is left out: {}", file.frame, error.what()));
            return false;
        }
    }

    const std::optional<Error>& first_error() const { return first_; }

private:
    const VolumeSettings& settings_;
    Progress& progress_;
    std::size_t most_cells_ = 0;
    std::optional<Error> first_;
};

// A flame may burn in few frames only: the files' headers say in which.
std::optional<FrameFile> frame_with_flame(const std::vector<FrameFile>& all, const std::string& flame) {
    for (const FrameFile& frame : all)
        try {
            for (const GridInfo& grid : list_grids(frame.file))
                if (grid.name == flame && !is_empty(grid))
                    return frame;
        } catch (const Error&) {  // told where it is rendered
        }
    return std::nullopt;
}

bool all_have(const std::vector<FrameFile>& all, const GridMapping& mapping) {
    for (const FrameFile& frame : all)
        try {
            const VdbHeader header = read_vdb_header(frame.file);
            for (const auto* choice : {&mapping.density, &mapping.flame, &mapping.temperature})
                if (*choice && std::ranges::find(header.grid_names, (*choice)->name) == header.grid_names.end())
                    return false;
        } catch (const Error&) {  // told where it is rendered
        }
    return true;
}

}  // namespace

std::vector<FrameFile> telling_frames(const std::vector<FrameFile>& all) {
    if (all.empty())
        return {};
    std::set<std::size_t> which;
    for (std::size_t quarter = 0; quarter <= 4; ++quarter)
        which.insert(quarter * (all.size() - 1) / 4);
    std::size_t largest = 0;
    for (std::size_t i = 1; i < all.size(); ++i)
        if (size_of(all[i]) > size_of(all[largest]))
            largest = i;
    which.insert(largest);
    std::vector<FrameFile> out;
    for (const std::size_t i : which)
        out.push_back(all[i]);
    return out;
}

SequenceSurvey survey_sequence(const std::string& pattern, const VolumeSettings& settings, Progress& progress) {
    SequenceSurvey out;
    out.name = fs::path(pattern).filename().string();
    const std::vector<FrameFile> all = resolve_sequence(pattern, std::nullopt);
    for (const FrameFile& frame : all)
        out.frames.push_back(frame.frame);
    Surveyor surveyor(settings, progress);
    for (const FrameFile& frame : telling_frames(all))
        surveyor.add(frame, out);
    if (out.seen.empty())
        throw surveyor.first_error().value();
    if (out.mapping.flame && std::ranges::none_of(out.seen, burns))
        if (const std::optional<FrameFile> frame = frame_with_flame(all, out.mapping.flame->name);
            frame && std::ranges::none_of(out.seen, [&](const FrameSurvey& s) { return s.frame == frame->frame; }))
            surveyor.add(*frame, out);
    std::ranges::sort(out.seen, {}, &FrameSurvey::frame);
    out.mapping_of_all = all_have(all, out.mapping);
    for (const std::string& note : out.notes)
        progress.warning("first-look", note);
    return out;
}

}  // namespace brisance
