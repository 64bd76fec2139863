#include "volume/velocity_mapping.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "core/error.h"
#include "core/printable.h"

namespace brisance {
namespace {

using Three = std::array<const char*, 3>;

// Lower case, in the order of preference.
constexpr std::array kVectorNames = {"velocity", "vel", "velocities", "v"};
constexpr std::array<Three, 9> kScalarNames = {{{"velocity.x", "velocity.y", "velocity.z"},
                                                {"velocity_x", "velocity_y", "velocity_z"},
                                                {"velocityx", "velocityy", "velocityz"},
                                                {"vel.x", "vel.y", "vel.z"},
                                                {"vel_x", "vel_y", "vel_z"},
                                                {"velx", "vely", "velz"},
                                                {"v.x", "v.y", "v.z"},
                                                {"v_x", "v_y", "v_z"},
                                                {"vx", "vy", "vz"}}};

bool is_vector_of_three(const GridInfo& grid) {
    return grid.value_type.starts_with("vec3");
}

bool has_name(const GridInfo& grid, const char* lower) {
    const std::string name = lower;
    return std::equal(grid.name.begin(), grid.name.end(), name.begin(), name.end(),
                      [](unsigned char a, char b) { return std::tolower(a) == b; });
}

// The first usable one of that name.
const GridInfo* find_by_name(const std::vector<GridInfo>& grids, const char* name, bool vector) {
    for (const GridInfo& grid : grids)
        if (has_name(grid, name) && grid.usable && is_vector_of_three(grid) == vector)
            return &grid;
    return nullptr;
}

GridChoice choice_of(const GridInfo& grid, const std::string& reason) {
    return {grid.name, grid.index, reason};
}

VelocityMapping by_name(const std::vector<GridInfo>& grids) {
    VelocityMapping out;
    for (const char* name : kVectorNames)
        if (const GridInfo* const grid = find_by_name(grids, name, true)) {
            out.grids = {choice_of(*grid, fmt::format("automatic: name matches '{}'", name))};
            return out;
        }
    for (const Three& names : kScalarNames) {
        for (const char* name : names)
            if (const GridInfo* const grid = find_by_name(grids, name, false))
                out.grids.push_back(choice_of(*grid, fmt::format("automatic: name matches '{}'", name)));
        if (out.grids.size() == names.size())
            return out;
        out.grids.clear();
    }
    out.why_none =
        "no grid has the name of a velocity (velocity, vel, v, or three scalars such as vel_x, vel_y, vel_z); name it "
        "in volume.grids.velocity";
    return out;
}

const GridInfo& named(const std::vector<GridInfo>& grids, const std::string& text, bool vector,
                      const std::string& file) {
    const GridInfo* const grid = find_named_grid(grids, text);
    const auto refuse = [&](const std::string& why) {
        throw Error(ExitCode::BadData,
                    fmt::format("{}: volume.grids.velocity names \"{}\", which {}; name a vector grid (vec3s) or three "
                                "scalar ones [\"x\", \"y\", \"z\"]",
                                file, printable(text, kLongestName), why));
    };
    if (grid == nullptr)
        refuse("is not in the file");
    if (!grid->usable)
        refuse(grid->why_unusable);
    if (is_vector_of_three(*grid) != vector)
        refuse(fmt::format("holds {} per voxel ({})", vector ? "one value" : "three values", grid->value_type));
    return *grid;
}

}  // namespace

std::string VelocityMapping::describe() const {
    std::string names;
    for (const GridChoice& grid : grids)
        names += fmt::format("{}\"{}{}\"", names.empty() ? "" : ", ", printable(grid.name, kLongestName),
                             grid.index > 0 ? fmt::format("[{}]", grid.index) : "");
    return names.empty() ? "none" : names;
}

VelocityMapping map_velocity(const std::vector<GridInfo>& grids, const GridRoles& roles, const std::string& file) {
    if (!roles.velocity)
        return by_name(grids);
    VelocityMapping out;
    for (const std::string& text : *roles.velocity)
        out.grids.push_back(choice_of(named(grids, text, roles.velocity->size() == 1, file), "named by the shot"));
    if (out.grids.empty())
        out.why_none = "volume.grids.velocity says that there is none";
    return out;
}

bool plays_velocity(const std::vector<GridInfo>& grids, const GridRoles& roles, const GridInfo& grid) {
    try {
        for (const GridChoice& choice : map_velocity(grids, roles, "").grids)
            if (choice.name == grid.name && choice.index == grid.index)
                return true;
    } catch (const Error&) {  // says so where velocity is needed
    }
    return false;
}

}  // namespace brisance
