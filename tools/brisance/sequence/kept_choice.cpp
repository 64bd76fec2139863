#include "kept_choice.h"

#include <nlohmann/json.hpp>

namespace brisance {

namespace {

using Json = nlohmann::ordered_json;

Json of_time(const TimeSettings& time, const VelocitySettings& velocity) {
    return {{"retime", static_cast<int>(time.retime)},
            {"unit", static_cast<int>(velocity.unit)},
            {"scale", velocity.scale}};
}

void take_time(const Json& json, TimeSettings& time, VelocitySettings& velocity) {
    time.retime = static_cast<Retime>(json.at("retime").get<int>());
    velocity.unit = static_cast<VelocityUnit>(json.at("unit").get<int>());
    velocity.scale = json.at("scale").get<double>();
}

}  // namespace

std::string to_text(const KeptChoice& choice) {
    const Shot& shot = choice.shot;
    Json json = {{"time", of_time(shot.time, shot.velocity)},
                 {"lighting_levels", shot.lighting.levels},
                 {"lighting_lattice_level", shot.lighting.lattice_level},
                 {"smoke_lattice_level", shot.lighting.smoke_lattice_level},
                 {"lattice_level", shot.scattering.lattice_level},
                 {"escape", shot.scattering.escape},
                 {"said", choice.said},
                 {"volumes", Json::array()}};
    if (choice.exposure_stops)
        json["exposure_stops"] = *choice.exposure_stops;
    for (const FurtherVolume& volume : shot.volumes)
        json["volumes"].push_back(volume.time && volume.velocity ? of_time(*volume.time, *volume.velocity) : Json());
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<KeptChoice> kept_choice(const std::string& text, const Shot& given) {
    KeptChoice out{given, std::nullopt, {}};
    Shot& shot = out.shot;
    try {
        const Json json = Json::parse(text);
        take_time(json.at("time"), shot.time, shot.velocity);
        shot.lighting.levels = json.at("lighting_levels").get<int>();
        shot.lighting.lattice_level = json.at("lighting_lattice_level").get<int>();
        shot.lighting.smoke_lattice_level = json.at("smoke_lattice_level").get<int>();
        shot.scattering.lattice_level = json.at("lattice_level").get<int>();
        shot.scattering.escape = json.at("escape").get<float>();
        json.at("said").get_to(out.said);
        if (json.contains("exposure_stops"))
            out.exposure_stops = json.at("exposure_stops").get<float>();
        const Json& volumes = json.at("volumes");
        if (volumes.size() != shot.volumes.size())
            return std::nullopt;
        for (std::size_t i = 0; i < volumes.size(); ++i) {
            if (volumes[i].is_null())
                continue;
            FurtherVolume& volume = shot.volumes[i];
            volume.time = volume.time.value_or(given.time);
            volume.velocity = volume.velocity.value_or(given.velocity);
            take_time(volumes[i], *volume.time, *volume.velocity);
        }
    } catch (const Json::exception&) {
        return std::nullopt;
    }
    return out;
}

}  // namespace brisance
