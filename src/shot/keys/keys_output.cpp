#include "shot/keys/keys.h"

namespace brisance {
namespace {

Key exposure_key() {
    const Codec<float> codec = real_float({-60.0, 60.0});
    return {"output.exposure_stops",
            "exposure of the PNG [stops]; auto: its bright parts just below white",
            "\"auto\" or " + codec.expected,
            {{"anyOf", Json::array({Json{{"const", "auto"}}, codec.schema})}},
            [codec](Shot& shot, const Json& json) {
                const std::optional<float> stops = codec.read(json);
                if (!stops && json != "auto")
                    return false;
                shot.exposure_given = stops.has_value();
                shot.output.exposure_stops = stops.value_or(0.0f);
                return true;
            },
            [codec](const Shot& shot) -> std::optional<Json> {
                return shot.exposure_given ? codec.write(shot.output.exposure_stops) : Json("auto");
            }};
}

}  // namespace

void add_output_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "output.path", "the EXR, relative to the shot's folder, with a frame token for sequences; empty: from the name",
        text(true), [](Shot & s) -> auto& { return s.output.path; }));
    keys.push_back(make_key(
        "output.png", "a PNG beside the EXR", flag(), [](Shot & s) -> auto& { return s.output.png; }));
    keys.push_back(make_key(
        "output.statistics", "costs and counts as JSON beside the EXR", flag(),
        [](Shot & s) -> auto& { return s.output.statistics; }));
    keys.push_back(make_key(
        "output.halves", "the path tracer's two independent halves as STEM.A.exr and STEM.B.exr beside the EXR", flag(),
        [](Shot & s) -> auto& { return s.output.halves; }));
    keys.push_back(make_key(
        "output.virtual_lights",
        "pictures of the virtual lights of surfaces beside the EXR: STEM.virtual_lights.ply, .exr, .png, ...", flag(),
        [](Shot & s) -> auto& { return s.output.virtual_lights; }));
    keys.push_back(make_key(
        "output.layers.cells", "one layer per kind of light path: V, MV, MM", flag(),
        [](Shot & s) -> auto& { return s.output.cell_layers; }));
    keys.push_back(make_key(
        "output.layers.bounces", "one layer per order of scattering", flag(),
        [](Shot & s) -> auto& { return s.output.bounce_layers; }));
    keys.push_back(make_key(
        "output.layers.bound",
        "for virtual_lights.kind point: light between surfaces (SS) as SS_bounded and SS_residual, what compensation "
        "brings back; bound: the share of the light that the bound takes away",
        flag(), [](Shot & s) -> auto& { return s.output.bound_layers; }));
    keys.push_back(exposure_key());
    keys.push_back(make_key(
        "output.view", "view transform of the PNG",
        choice<ViewTransform>({{"filmic", ViewTransform::Filmic}, {"srgb", ViewTransform::Srgb}}),
        [](Shot & s) -> auto& { return s.output.view; }));
    keys.push_back(make_key(
        "output.frames_per_second", "recorded in the EXR [1/s]", or_word(real({0.0, 1000.0, true}), "none", 0.0),
        [](Shot & s) -> auto& { return s.output.frames_per_second; }));
}

}  // namespace brisance
