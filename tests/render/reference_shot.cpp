#include "reference_shot.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "film/write_image.h"

namespace brisance::testing {

namespace {

dvec3 triple(const nlohmann::json& j) {
    return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()};
}

Shot shot_of(const nlohmann::json& json) {
    const auto& v = json["volume"];
    const auto& c = json["camera"];
    Shot shot;
    shot.volume.grids.density = v["density"].get<std::string>();
    shot.volume.grids.flame = v["emission"].get<std::string>();
    shot.volume.grids.temperature = "";
    shot.medium.smoke.extinction_per_metre = v["sigma_t"];
    shot.medium.smoke.albedo = Rgb(v["albedo"].get<float>());
    shot.medium.smoke.mean_cosine = v["g"];
    shot.medium.fire.strength = v["emission_strength"];
    shot.medium.fire.threshold = v.value("emission_threshold", 0.0f);
    shot.certify.belief = 0.0;  // the references say what the errors are
    shot.camera_given = true;
    shot.camera.eye = triple(c["eye"]);
    shot.camera.target = triple(c["target"]);
    shot.camera.up = triple(c["up"]);
    shot.camera.vertical_fov_degrees = c["vfov_degrees"];
    shot.camera.width = c["width"];
    shot.camera.height = c["height"];
    for (const auto& surface : json.value("surfaces", nlohmann::json::array())) {
        QuickQuad quad;
        for (int k = 0; k < 4; ++k)
            quad.corners[k] = triple(surface["quad"][k]);
        quad.material.colour = Rgb(surface["reflectance"].get<float>());
        shot.scene.quads.push_back(quad);
    }
    return shot;
}

}  // namespace

ReferenceShot reference_shot(const std::filesystem::path& data, const std::string& name) {
    const std::filesystem::path folder = data / "references";
    const auto json = nlohmann::json::parse(std::ifstream(folder / (name + ".json")));
    return {shot_of(json), data / "volumes" / json["volume"]["file"].get<std::string>(), (folder / name).string()};
}

std::vector<float> read_luminance(const std::string& file) {
    return read_exr(file).layers[0].pixels;
}

}  // namespace brisance::testing
