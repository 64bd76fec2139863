#include "shot/renamed_keys.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace brisance {

namespace {

using Names = std::vector<std::pair<std::string, std::string>>;

// Sections, then keys, from old to new. Longer paths before shorter ones that they begin with.
const Names& renamed_paths() {
    static const Names names = {{"ray_lights.shrink", "ray_lights.radius_reduction"},
                                {"virtual_lights.extension", "virtual_lights.path_extension"},
                                {"point_lights", "volumetric_vpls"},
                                {"particles", "volumetric_photons"}};
    return names;
}

const Names& removed_keys() {
    static const Names names = {
        {"lighting.gather", "light is always gathered at the medium's nodes and interpolated between them; remove it"}};
    return names;
}

}  // namespace

std::optional<std::string> renamed_key(const std::string& path) {
    for (const auto& [old, why] : removed_keys())
        if (path == old)
            return fmt::format("{} is no longer there: {}", path, why);
    for (const auto& [old, now] : renamed_paths())
        if (path == old || path.starts_with(old + "."))
            return fmt::format("{} is now called {}{}", path, now, path.substr(old.size()));
    return std::nullopt;
}

std::optional<std::string> renamed_value(const std::string& path, const std::string& text) {
    if (path != "scattering.method")
        return std::nullopt;
    for (const auto& [old, now] : renamed_paths())
        if (text == "\"" + old + "\"")
            return fmt::format("the method {} is now called \"{}\"", text, now);
    return std::nullopt;
}

}  // namespace brisance
