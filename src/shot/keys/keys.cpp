#include "shot/keys/keys.h"

#include "shot/renamed_keys.h"

namespace brisance {
namespace {

// For editors only: names the schema, means nothing to the picture.
Key schema_key() {
    return {"$schema",
            "where the schema of this file is, for editors; has no effect on the picture",
            text(true).expected,
            text(true).schema,
            [](Shot&, const Json& json) { return text(true).read(json).has_value(); },
            [](const Shot&) -> std::optional<Json> { return std::nullopt; }};
}

std::vector<Key> all_keys() {
    std::vector<Key> keys = {schema_key(), make_key(
                                               "name", "of the shot, and of its files where output.path is empty",
                                               text(true), [](Shot & s) -> auto& { return s.name; })};
    add_volume_keys(keys);
    add_time_keys(keys);
    add_medium_keys(keys);
    add_scene_keys(keys);
    add_camera_keys(keys);
    add_shutter_keys(keys);
    add_lighting_keys(keys);
    add_fire_light_keys(keys);
    add_virtual_light_keys(keys);
    add_unified_light_keys(keys);
    add_tracing_keys(keys);
    add_correction_keys(keys);
    add_certify_keys(keys);
    add_output_keys(keys);
    for (Key& key : keys)
        key.affects = affected_by(key.path);
    return keys;
}

using Sections = std::vector<std::pair<std::string, std::string>>;

Sections all_sections() {
    Sections sections = {
        {"volume", "the OpenVDB file, its grids and its position"},
        {"volume.grids", "which grid plays which role: \"name\" or \"name[index]\", null for automatic, \"\" for none"},
        {"time", "which time of a sequence of volumes each frame of the picture shows"},
        {"velocity", "how far a volume's velocity moves its smoke; read for times between frames and for motion blur"},
        {"smoke", "from density to optical coefficients"},
        {"fire", "what glows"},
        {"scene", "surfaces and lights around the volume"},
        {"camera", "the pinhole camera; without eye and target, or world_from_camera, it is framed on the volume"},
        {"shutter", "motion blur"},
        {"lighting", "how the fire's light reaches the smoke"},
        {"fire_lights",
         "light of the fire's single voxels in smoke and on surfaces, chosen otherwise than by the hierarchy"},
        {"scattering", "light scattered more than once"}};
    for (const ScatteringMethod& method : scattering_methods())
        sections.emplace_back(method.name, method.product + ", of scattering.method " + method.name);
    const Sections rest = {
        {"virtual_lights", "light that surfaces reflect onto surfaces and smoke"},
        {"unified_lights",
         "light on surfaces and in smoke, from all of virtual lights, fire and emitters chosen together"},
        {"tracing", "the reference path tracer (method path)"},
        {"correction", "what unbiased samples find that a picture by many lights misses"},
        {"certify", "how far the finished frame is from the truth"},
        {"output", "what is written"},
        {"output.layers", "layers of the EXR besides the beauty"}};
    sections.insert(sections.end(), rest.begin(), rest.end());
    return sections;
}

}  // namespace

Affects affected_by(const std::string& path) {
    // Leaving out orders of scattering changes what is true.
    if (path == "scattering.bounces")
        return Affects::Picture;
    for (const char* section : {"lighting.", "fire_lights.", "scattering.", "virtual_lights.", "unified_lights.",
                                "tracing.", "correction.", "certify.", "output."})
        if (path.starts_with(section))
            return Affects::Method;
    for (const ScatteringMethod& method : scattering_methods())
        if (path.starts_with(method.name + "."))
            return Affects::Method;
    // Shots stored in older pictures: all keys that were renamed so far are of the method.
    if (renamed_key(path))
        return Affects::Method;
    for (const char* key : {"$schema", "name", "method", "seconds", "camera.samples_per_axis", "camera.edge_refinement",
                            "shutter.most_moments", "shutter.lighting_times"})
        if (path == key)
            return Affects::Method;
    return Affects::Picture;
}

const std::vector<Key>& shot_keys() {
    static const std::vector<Key> keys = all_keys();
    return keys;
}

const std::vector<std::pair<std::string, std::string>>& shot_sections() {
    static const std::vector<std::pair<std::string, std::string>> sections = all_sections();
    return sections;
}

}  // namespace brisance
