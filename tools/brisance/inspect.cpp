#include "inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/printable.h"
#include "film/whole_file.h"
#include "first_look/look_file.h"
#include "load_shot.h"
#include "volume/frame_path.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

constexpr int kBins = 40;
constexpr double kMebibyte = 1048576.0;

std::string dump(const Json& json, int indent = -1) {
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

// On one line, with the blanks people write.
std::string dump_line(const Json& json) {
    if (!json.is_structured())
        return dump(json);
    std::string text;
    for (const auto& [key, value] : json.items())
        text += (text.empty() ? "" : ", ") + (json.is_object() ? dump(key) + ": " : "") + dump_line(value);
    return json.is_object() ? "{" + text + "}" : "[" + text + "]";
}

std::string shown_name(const GridInfo& info) {
    return fmt::format("{}[{}]", printable(info.name, kLongestName), info.index);
}

ivec3 size_of(const GridInfo& info) {
    return info.active_max - info.active_min + 1;
}

bool has_voxels(const GridInfo& info) {
    return info.active_max.x >= info.active_min.x;
}

std::string bars(const std::vector<std::uint64_t>& histogram) {
    static constexpr std::array<const char*, 9> glyphs = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
    const std::uint64_t most = histogram.empty() ? 0 : *std::max_element(histogram.begin(), histogram.end());
    std::string line;
    for (const std::uint64_t count : histogram) {
        const double height = most > 0 ? std::log1p(double(count)) / std::log1p(double(most)) : 0.0;
        line += glyphs[count == 0 ? 0 : std::clamp(static_cast<std::size_t>(std::lround(height * 8)), 1uL, 8uL)];
    }
    return line;
}

// Oddities of a transform, in words.
std::vector<std::string> transform_flags(const GridInfo& info) {
    if (!info.affine)
        return {"frustum"};
    const dmat3 axes(info.world_from_index);
    const dvec3 length(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    const double longest = std::max({length.x, length.y, length.z});
    double off_axis = 0.0, skew = 0.0;
    for (int i = 0; i < 3; ++i) {
        skew = std::max(skew, std::abs(glm::dot(axes[i], axes[(i + 1) % 3])) / (longest * longest));
        for (int j = 0; j < 3; ++j)
            off_axis = std::max(off_axis, i == j ? 0.0 : std::abs(axes[i][j]) / longest);
    }
    std::vector<std::string> flags;
    if (skew > 1e-6)
        flags.emplace_back("sheared");
    else if (off_axis > 1e-6)
        flags.emplace_back("rotated");
    if (longest - std::min({length.x, length.y, length.z}) > 1e-5 * longest)
        flags.emplace_back("anisotropic voxels");
    if (glm::determinant(axes) < 0.0)
        flags.emplace_back("mirrored (negative scale)");
    return flags;
}

std::pair<dvec3, dvec3> world_bounds(const GridInfo& info) {
    dvec3 low(INFINITY), high(-INFINITY);
    for (int corner = 0; corner < 8; ++corner) {
        dvec3 index;
        for (int axis = 0; axis < 3; ++axis)
            index[axis] = (corner >> axis) & 1 ? info.active_max[axis] : info.active_min[axis];
        const dvec3 world(info.world_from_index * glm::dvec4(index, 1.0));
        low = glm::min(low, world);
        high = glm::max(high, world);
    }
    return {low, high};
}

// Blocks that are at least half full, or the whole box where that is less: no more than a rough figure.
double rough_bytes(const InspectedGrid& grid) {
    if (!has_voxels(grid.info))
        return 0.0;
    const dvec3 blocks = dvec3(size_of(grid.info)) / 8.0 + 1.0;
    const double dense = 512.0 * blocks.x * blocks.y * blocks.z;
    const double channels = grid.info.value_type.starts_with("vec3") ? 3.0 : 1.0;
    return 4.0 * channels * std::min(dense, 2.0 * static_cast<double>(grid.census.active_voxels) + 512.0);
}

const InspectedGrid* find_grid(const Inspection& inspection, const std::optional<GridChoice>& choice) {
    if (choice)
        for (const InspectedGrid& grid : inspection.grids)
            if (grid.info.name == choice->name && grid.info.index == choice->index)
                return &grid;
    return nullptr;
}

std::vector<std::pair<std::string, std::optional<GridChoice>>> roles(const GridMapping& mapping) {
    return {{"density", mapping.density},
            {"temperature", mapping.temperature},
            {"flame", mapping.flame},
            {"colour", mapping.colour}};
}

std::string shot_name(const Inspection& inspection, const GridChoice& choice) {
    const auto same = std::count_if(inspection.grids.begin(), inspection.grids.end(),
                                    [&](const InspectedGrid& grid) { return grid.info.name == choice.name; });
    const bool bare = same == 1 && !choice.name.empty();
    return bare ? choice.name : fmt::format("{}[{}]", choice.name, choice.index);
}

void find_sequence(Inspection& inspection) {
    const std::optional<std::string> pattern = pattern_of(inspection.file);
    if (!pattern)
        return;
    inspection.frames = frames_on_disk(*pattern);
    if (inspection.frames.size() > 1)
        inspection.pattern = *pattern;
    else
        inspection.frames.clear();
}

Json shot_json(const Inspection& inspection) {
    Stated nothing;
    Json shot = {{"volume", {{"file", inspection.volumes}}}};
    shot.update(shot_of_look(*inspection.look, nothing), true);
    return shot;
}

std::string transform_line(const GridInfo& info) {
    if (!info.affine)
        return "  transform  frustum\n";
    const dmat3 axes(info.world_from_index);
    std::string line = fmt::format("  transform  voxel {:g} x {:g} x {:g}", glm::length(axes[0]), glm::length(axes[1]),
                                   glm::length(axes[2]));
    for (const std::string& flag : transform_flags(info))
        line += ", " + flag;
    if (!has_voxels(info))
        return line + "\n";
    const auto [low, high] = world_bounds(info);
    return line + fmt::format("; world ({:.4g} {:.4g} {:.4g}) to ({:.4g} {:.4g} {:.4g})\n", low.x, low.y, low.z, high.x,
                              high.y, high.z);
}

std::string grid_text(const InspectedGrid& grid) {
    const GridInfo& info = grid.info;
    const GridCensus& census = grid.census;
    std::string text = fmt::format("\n{}{}  {}, class {}\n", shown_name(info), info.name.empty() ? " (unnamed)" : "",
                                   info.value_type, info.grid_class.empty() ? "not readable" : info.grid_class);
    text += fmt::format("  voxels     {} active ({} tiles)", census.active_voxels, census.active_tiles);
    if (has_voxels(info)) {
        const dvec3 size = dvec3(info.active_max) - dvec3(info.active_min) + 1.0;
        text += fmt::format("; box ({} {} {}) to ({} {} {}), {:.0f} x {:.0f} x {:.0f}", info.active_min.x,
                            info.active_min.y, info.active_min.z, info.active_max.x, info.active_max.y,
                            info.active_max.z, size.x, size.y, size.z);
    }
    text += "\n" + transform_line(info);
    if (!census.histogram.empty() && census.active_voxels > 0) {
        const bool vector = info.value_type.starts_with("vec3");
        text += fmt::format("  values     {:.4g} to {:.4g}, mean {:.4g}{}", census.minimum, census.maximum, census.mean,
                            vector ? " (lengths)" : "");
        text += fmt::format("; {} not finite{}\n", census.nan_voxels,
                            vector ? std::string() : fmt::format(", {} negative", census.negative_voxels));
        text += fmt::format("  histogram  {:.3g} |{}| {:.3g}  (log counts)\n", census.minimum, bars(census.histogram),
                            census.maximum);
    }
    if (!grid.problem.empty())
        return text + "  unusable   " + grid.problem + "\n";
    return text + (info.usable ? "  usable\n" : "  unusable   it " + info.why_unusable + "\n");
}

Json grid_json(const InspectedGrid& grid) {
    const GridInfo& info = grid.info;
    Json matrix = Json::array();
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            matrix.push_back(info.world_from_index[column][row]);
    return {{"name", info.name},
            {"index", info.index},
            {"type", info.value_type},
            {"class", info.grid_class},
            {"active_voxels", grid.census.active_voxels},
            {"active_tiles", grid.census.active_tiles},
            {"active_min", {info.active_min.x, info.active_min.y, info.active_min.z}},
            {"active_max", {info.active_max.x, info.active_max.y, info.active_max.z}},
            {"world_from_index_rows", matrix},
            {"transform_flags", transform_flags(info)},
            {"minimum", grid.census.minimum},
            {"maximum", grid.census.maximum},
            {"mean", grid.census.mean},
            {"histogram", grid.census.histogram},
            {"nan_voxels", grid.census.nan_voxels},
            {"negative_voxels", grid.census.negative_voxels},
            {"usable", info.usable && grid.problem.empty()},
            {"why_unusable", grid.problem.empty() ? info.why_unusable : grid.problem},
            {"rough_bytes", std::llround(rough_bytes(grid))}};
}

double rough_bytes_of_mapped(const Inspection& inspection) {
    double bytes = 0.0;
    for (const auto& [role, choice] : roles(*inspection.mapping))
        if (const InspectedGrid* const grid = find_grid(inspection, choice))
            bytes += rough_bytes(*grid);
    return bytes;
}

}  // namespace

std::filesystem::path telling_file(const std::string& pattern) {
    if (!has_frame_token(pattern))
        return pattern;
    std::filesystem::path largest;
    std::uintmax_t most = 0;
    for (const FrameFile& frame : resolve_sequence(pattern, std::nullopt)) {
        std::error_code error;
        const std::uintmax_t size = std::filesystem::file_size(frame.file, error);
        if (!error && (largest.empty() || size > most)) {
            largest = frame.file;
            most = size;
        }
    }
    return largest;
}

Inspection inspect_file(const std::filesystem::path& file) {
    Inspection result;
    VdbReader reader(file);
    std::vector<GridInfo> infos = reader.grids();
    result.file = std::filesystem::absolute(file).lexically_normal();
    result.file_bytes = std::filesystem::file_size(file);
    for (GridInfo& info : infos) {
        InspectedGrid grid{info, {}, {}};
        if (info.value_type != "unknown") {
            try {
                grid.census = reader.census(info.name, info.index, kBins);
            } catch (const Error& error) {
                grid.problem = error.what();
                info.usable = false;
                info.why_unusable = error.what();
            }
        }
        result.grids.push_back(std::move(grid));
    }
    try {
        result.mapping = map_grids(infos, VolumeSettings{}, file.string());
    } catch (const Error& error) {
        result.why_no_mapping = error.what();
    }
    find_sequence(result);
    return result;
}

std::string suggested_shot(const Inspection& inspection) {
    if (!inspection.look)
        return {};
    std::string text = "{\n";
    const Json shot = shot_json(inspection);
    for (auto part = shot.begin(); part != shot.end(); ++part)
        text += fmt::format("{}    \"{}\": {}", part == shot.begin() ? "" : ",\n", part.key(), dump_line(part.value()));
    return text + "\n}\n";
}

std::string inspection_text(const Inspection& inspection) {
    const std::string creator = inspection.grids.empty() ? "" : inspection.grids.front().info.creator;
    std::string text =
        fmt::format("{}\n{:.2f} MiB, {} grid{}{}\n", inspection.file.string(),
                    static_cast<double>(inspection.file_bytes) / kMebibyte, inspection.grids.size(),
                    inspection.grids.size() == 1 ? "" : "s", creator.empty() ? "" : ", written by " + creator);
    if (!inspection.pattern.empty())
        text += fmt::format("one of {} frames: {}\n", inspection.frames.size(), describe_frames(inspection.frames));
    for (const InspectedGrid& grid : inspection.grids)
        text += grid_text(grid);
    if (!inspection.mapping)
        return text + "\ncannot be rendered: " + inspection.why_no_mapping + "\n";
    text += "\nmapping    " + inspection.mapping->describe() + "\n";
    for (const auto& [role, choice] : roles(*inspection.mapping))
        if (choice)
            text += fmt::format("  {} {}\n", role, choice->reason);
    for (const std::string& note : inspection.mapping->notes)
        text += "  " + note + "\n";
    text += fmt::format("memory     roughly {:.1f} MiB for the mapped grids\n",
                        rough_bytes_of_mapped(inspection) / kMebibyte);
    if (inspection.velocity)
        text += velocity_text(*inspection.velocity);
    if (!inspection.look)
        return text;
    text += fmt::format("first look, by frame {} (docs/first_look.md)\n", describe_frames(inspection.look->looked_at));
    for (const std::string& line : describe_look(*inspection.look))
        text += "  " + line + "\n";
    for (const std::string& line : inspection.look->warnings)
        text += "  " + line + "\n";
    return text + "shot\n" + suggested_shot(inspection);
}

std::string inspection_json(const Inspection& inspection) {
    Json json = {{"schema_version", 1},
                 {"file", inspection.file.string()},
                 {"file_bytes", inspection.file_bytes},
                 {"sequence", {{"pattern", inspection.pattern}, {"frames", inspection.frames}}},
                 {"grids", Json::array()}};
    for (const InspectedGrid& grid : inspection.grids)
        json["grids"].push_back(grid_json(grid));
    if (!inspection.mapping) {
        json["why_not_renderable"] = inspection.why_no_mapping;
        return dump(json, 2) + "\n";
    }
    for (const auto& [role, choice] : roles(*inspection.mapping))
        if (choice)
            json["mapping"][role] = {{"grid", shot_name(inspection, *choice)}, {"reason", choice->reason}};
    json["mapping"]["notes"] = inspection.mapping->notes;
    json["rough_bytes"] = std::llround(rough_bytes_of_mapped(inspection));
    if (const std::optional<InspectedVelocity>& v = inspection.velocity; v && !v->mapping.empty())
        json["velocity"] = {{"grids", v->mapping}, {"form", v->form}, {"unit", v->unit}};
    if (inspection.look)
        json["suggestion"] = {{"look", Json::parse(look_to_json(*inspection.look))}, {"shot", shot_json(inspection)}};
    return dump(json, 2) + "\n";
}

int run_inspect(const InspectOptions& options) {
    const std::string volumes = volume_input(options.input);
    Inspection inspection = inspect_file(telling_file(volumes));
    inspection.velocity = inspect_velocity(inspection.file, inspection.pattern, inspection.frames);
    Progress silent;
    try {
        if (inspection.mapping)
            inspection.look = first_look(volumes, {}, silent);
    } catch (const Error& error) {  // a grid is damaged, of this file or another: the others are shown all the same
        if (error.code() != ExitCode::BadData)
            throw;
        inspection.mapping.reset();
        inspection.why_no_mapping = error.what();
    }
    inspection.volumes = fs::absolute(volumes).lexically_normal().string();
    if (!options.write_look.empty() && inspection.look)
        write_whole_file(options.write_look, look_to_json(*inspection.look));
    const std::string text = options.as_json ? inspection_json(inspection) : inspection_text(inspection);
    std::fputs(text.c_str(), stdout);
    return static_cast<int>(inspection.mapping ? ExitCode::Success : ExitCode::BadData);
}

}  // namespace brisance
