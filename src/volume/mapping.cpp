#include "volume/mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>

#include "core/error.h"
#include "core/printable.h"
#include "volume/vector_parts.h"
#include "volume/velocity_mapping.h"

namespace brisance {
namespace {

enum Role { Density, Temperature, Flame, Colour };
constexpr std::array<const char*, 4> kRoleNames = {"density", "temperature", "flame", "colour"};
using Names = std::vector<std::string>;
using RoleTable = std::array<Names, 4>;  // in the order of preference, lower case

struct Preset {
    const char* name;
    RoleTable names;
};

// `heat` is burn intensity in Houdini and a kind of temperature in old Blender files. Only a preset can decide.
const Preset& preset_of(MappingPreset which) {
    static const Preset automatic{"automatic",
                                  {{{"density", "smoke", "dens", "soot"},
                                    {"temperature", "temp"},
                                    {"flame", "flames", "fire", "burn", "emission", "fuel"},
                                    {"cd", "color", "colour", "albedo"}}}};
    static const Preset houdini{"houdini",
                                {{{"density"}, {"temperature"}, {"flame", "flames", "heat", "burn"}, {"cd", "color"}}}};
    static const Preset embergen{
        "embergen", {{{"density", "smoke"}, {"temperature"}, {"flames", "flame", "fire"}, {"color", "cd", "albedo"}}}};
    static const Preset mantaflow{"mantaflow", {{{"density"}, {"temperature", "heat"}, {"flame"}, {"color"}}}};
    switch (which) {
        case MappingPreset::Houdini:
            return houdini;
        case MappingPreset::EmberGen:
            return embergen;
        case MappingPreset::Mantaflow:
            return mantaflow;
        case MappingPreset::Automatic:
            break;
    }
    return automatic;
}

// Never density, even when nothing else is there.
bool is_not_an_amount(const std::string& lower) {
    static const Names names = {"heat", "shadow", "scatter", "collision", "sdf", "surface", "flags"};
    return std::find(names.begin(), names.end(), lower) != names.end() || lower.starts_with("vel");
}

std::string lower_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool is_vector(const GridInfo& grid) {
    return grid.value_type.starts_with("vec3");
}

std::size_t count_named(const std::vector<GridInfo>& grids, const std::string& name) {
    return static_cast<std::size_t>(
        std::count_if(grids.begin(), grids.end(), [&](const GridInfo& g) { return g.name == name; }));
}

// As a shot would write it: "name", or "name[index]" where the name alone does not say which.
std::string shot_name(const std::vector<GridInfo>& grids, const GridInfo& grid) {
    const bool bare = !grid.name.empty() && count_named(grids, grid.name) == 1;
    const std::string name = printable(grid.name, kLongestName);
    return bare ? fmt::format("\"{}\"", name) : fmt::format("\"{}[{}]\"", name, grid.index);
}

std::string list_names(const std::vector<GridInfo>& grids) {
    std::string result;
    for (const GridInfo& grid : grids)
        result += fmt::format("{}{}{}", result.empty() ? "" : ", ", shot_name(grids, grid),
                              grid.name.empty() ? " (unnamed)" : "");
    return result.empty() ? "none" : result;
}

// Why a grid cannot play a role; empty when it can.
std::string why_not(const GridInfo& grid, Role role) {
    if (!grid.usable)
        return grid.why_unusable;
    if (role == Colour && !is_vector(grid))
        return fmt::format("holds one {} per voxel; a colour needs three (vec3s)", grid.value_type);
    if (role != Colour && is_vector(grid))
        return fmt::format("holds three values per voxel ({}); {} needs one (float)", grid.value_type,
                           kRoleNames[role]);
    return {};
}

// The same for a grid that nobody has named. Whole numbers mark cells: what is in them, not how much of it.
std::string why_not_by_itself(const GridInfo& grid, Role role) {
    const std::string reason = why_not(grid, role);
    if (!reason.empty() || !grid.value_type.starts_with("int"))
        return reason;
    return fmt::format("holds whole numbers ({}), which mark cells; name it in the shot if it is an amount",
                       grid.value_type);
}

struct GridReference {
    std::string name;
    int index = 0;
    bool index_given = false;
};

// "name[2]" unless a grid carries the whole text as its name.
GridReference parse_reference(const std::string& text, const std::vector<GridInfo>& grids) {
    const std::size_t open = text.rfind('[');
    if (count_named(grids, text) > 0 || open == std::string::npos || text.back() != ']')
        return {text, 0, false};
    int index = 0;
    const char* const begin = text.data() + open + 1;
    const char* const end = text.data() + text.size() - 1;
    const auto [rest, error] = std::from_chars(begin, end, index);
    if (error != std::errc() || rest != end || index < 0)
        return {text, 0, false};
    return {text.substr(0, open), index, true};
}

void note_several(const std::vector<GridInfo>& grids, const GridInfo& chosen, GridMapping& mapping) {
    const std::size_t several = count_named(grids, chosen.name);
    if (several < 2)
        return;
    mapping.notes.push_back(
        fmt::format("{} grids are named \"{}\": \"{}[{}]\" is used; name \"{}[{}]\" in the shot to pick another",
                    several, chosen.name, chosen.name, chosen.index, chosen.name, chosen.index == 0 ? 1 : 0));
}

GridChoice choose_named(const std::vector<GridInfo>& grids, Role role, const std::string& text, const std::string& file,
                        GridMapping& mapping) {
    const GridInfo* const found = find_named_grid(grids, text);
    if (found == nullptr)
        throw Error(ExitCode::BadData,
                    fmt::format("{}: the shot names \"{}\" as {}, which is not in the file; grids: {}", file, text,
                                kRoleNames[role], list_names(grids)));
    if (const std::string reason = why_not(*found, role); !reason.empty())
        throw Error(ExitCode::BadData,
                    fmt::format("{}: the shot names \"{}\" as {}, but it {}", file, text, kRoleNames[role], reason));
    if (!parse_reference(text, grids).index_given)
        note_several(grids, *found, mapping);
    return {found->name, found->index, "named by the shot"};
}

std::optional<GridChoice> choose_by_name(const std::vector<GridInfo>& grids, Role role, const Preset& preset,
                                         GridMapping& mapping) {
    for (const std::string& name : preset.names[role]) {
        for (const GridInfo& grid : grids) {
            if (lower_case(grid.name) != name)
                continue;
            if (const std::string reason = why_not_by_itself(grid, role); !reason.empty()) {
                mapping.notes.push_back(
                    fmt::format("grid {} is not used as {}: it {}", shot_name(grids, grid), kRoleNames[role], reason));
                continue;
            }
            note_several(grids, grid, mapping);
            const bool automatic = preset.name == preset_of(MappingPreset::Automatic).name;
            return GridChoice{grid.name, grid.index,
                              automatic ? fmt::format("automatic: name matches '{}'", name)
                                        : fmt::format("preset {}: name matches '{}'", preset.name, name)};
        }
    }
    return std::nullopt;
}

// A colour as three scalar grids, where no grid holds it whole.
void choose_colour_parts(const std::vector<GridInfo>& grids, GridMapping& mapping) {
    static const Names stems = {"cd", "color", "colour", "albedo"};
    if (const std::optional<VectorParts> parts = find_vector_parts(grids, stems))
        for (const GridInfo* const part : *parts)
            mapping.colour_parts.push_back({part->name, part->index, "automatic: one of three parts of a colour"});
}

// A file with a single amount in it, whatever its name, can only mean one thing.
void choose_only_grid(const std::vector<GridInfo>& grids, GridMapping& mapping) {
    const GridInfo* only = nullptr;
    for (const GridInfo& grid : grids) {
        if (!why_not_by_itself(grid, Density).empty() || is_not_an_amount(lower_case(grid.name)))
            continue;
        if (only != nullptr)
            return;
        only = &grid;
    }
    if (only == nullptr)
        return;
    mapping.density = GridChoice{only->name, only->index, "automatic: the only usable scalar grid"};
    mapping.notes.push_back(
        fmt::format("no grid has a known name; {}{}, the only usable scalar grid, is read as density",
                    shot_name(grids, *only), only->name.empty() ? " (unnamed)" : ""));
}

[[noreturn]] void throw_nothing_to_render(const std::vector<GridInfo>& grids, const std::string& file) {
    std::string reasons;
    for (const GridInfo& grid : grids) {
        std::string reason = why_not_by_itself(grid, Density);
        if (reason.empty())
            reason = "has no known name; name it in the shot's volume.grids";
        reasons += fmt::format(" {}{} {};", shot_name(grids, grid), grid.name.empty() ? " (unnamed)" : "", reason);
    }
    throw Error(ExitCode::BadData,
                fmt::format("{}: no grid can serve as density, flame or temperature:{}", file, reasons));
}

void note_leftovers(const std::vector<GridInfo>& grids, const VolumeSettings& settings, GridMapping& mapping) {
    const auto used = [&](const GridInfo& grid) {
        for (const GridChoice& part : mapping.colour_parts)
            if (part.name == grid.name && part.index == grid.index)
                return true;
        for (const auto* choice : {&mapping.density, &mapping.temperature, &mapping.flame, &mapping.colour})
            if (*choice && (*choice)->name == grid.name && (*choice)->index == grid.index)
                return true;
        return false;
    };
    std::string unused;
    for (const GridInfo& grid : grids) {
        if (used(grid) || plays_velocity(grids, settings.grids, grid))
            continue;
        unused += fmt::format("{}{}", unused.empty() ? "" : ", ", shot_name(grids, grid));
        if (lower_case(grid.name) == "heat" && settings.preset == MappingPreset::Automatic)
            mapping.notes.push_back(
                fmt::format("grid {} is left out: heat is burn intensity in Houdini and a temperature in "
                            "old Blender files; choose preset houdini or mantaflow, or name it in the shot",
                            shot_name(grids, grid)));
    }
    if (!unused.empty())
        mapping.notes.push_back("unused grids: " + unused);
}

}  // namespace

std::string GridChoice::shot_name() const {
    return index > 0 || name.empty() ? fmt::format("{}[{}]", name, index) : name;
}

std::string GridMapping::describe() const {
    const std::array<const std::optional<GridChoice>*, 4> choices = {&density, &temperature, &flame, &colour};
    std::string line;
    for (std::size_t role = 0; role < choices.size(); ++role) {
        const std::optional<GridChoice>& choice = *choices[role];
        line += fmt::format("{}{} <- ", line.empty() ? "" : ", ", kRoleNames[role]);
        if (choice)
            line += fmt::format("\"{}\"", printable(choice->shot_name(), kLongestName));
        else if (role == Colour && !colour_parts.empty())
            for (const GridChoice& part : colour_parts)
                line += fmt::format("{}\"{}\"", &part == &colour_parts.front() ? "" : " + ",
                                    printable(part.shot_name(), kLongestName));
        else
            line += "none";
    }
    return line;
}

const GridInfo* find_named_grid(const std::vector<GridInfo>& grids, const std::string& text) {
    const GridReference wanted = parse_reference(text, grids);
    const auto found = std::find_if(grids.begin(), grids.end(), [&](const GridInfo& grid) {
        return grid.name == wanted.name && grid.index == wanted.index;
    });
    return found == grids.end() ? nullptr : &*found;
}

GridMapping map_grids(const std::vector<GridInfo>& grids, const VolumeSettings& settings, const std::string& file) {
    GridMapping mapping;
    const Preset& preset = preset_of(settings.preset);
    const auto choose = [&](Role role, const std::optional<std::string>& requested) -> std::optional<GridChoice> {
        if (!requested)
            return choose_by_name(grids, role, preset, mapping);
        return requested->empty() ? std::nullopt
                                  : std::optional<GridChoice>(choose_named(grids, role, *requested, file, mapping));
    };
    mapping.density = choose(Density, settings.grids.density);
    mapping.temperature = choose(Temperature, settings.grids.temperature);
    mapping.flame = choose(Flame, settings.grids.flame);
    mapping.colour = choose(Colour, settings.grids.colour);
    if (!mapping.colour && !settings.grids.colour)
        choose_colour_parts(grids, mapping);
    const auto nothing = [&] { return !mapping.density && !mapping.temperature && !mapping.flame; };
    if (nothing() && !settings.grids.density)
        choose_only_grid(grids, mapping);
    if (nothing())
        throw_nothing_to_render(grids, file);
    note_leftovers(grids, settings, mapping);
    return mapping;
}

}  // namespace brisance
