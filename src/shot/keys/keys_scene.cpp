#include "shot/keys/keys.h"
#include "shot/keys/object_codec.h"

namespace brisance {
namespace {

const Range kUnit{0.0, 1.0};

Codec<std::array<dvec3, 4>> corners() {
    const Codec<dvec3> corner = point();
    Codec<std::array<dvec3, 4>> codec;
    codec.expected = "four points [[x, y, z], ...] in order around, counter-clockwise as seen from the front";
    codec.schema = {{"type", "array"}, {"items", corner.schema}, {"minItems", 4}, {"maxItems", 4}};
    codec.read = [corner](const Json& json) -> std::optional<std::array<dvec3, 4>> {
        std::array<dvec3, 4> points;
        if (!json.is_array() || json.size() != points.size())
            return std::nullopt;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const std::optional<dvec3> p = corner.read(json[i]);
            if (!p)
                return std::nullopt;
            points[i] = *p;
        }
        return points;
    };
    codec.write = [corner](const std::array<dvec3, 4>& points) {
        Json json = Json::array();
        for (const dvec3& p : points)
            json.push_back(corner.write(p));
        return json;
    };
    return codec;
}

// The keys of a quick shape's material stand beside those of its shape.
template <class T>
void add_material(std::vector<Member<T>>& m) {
    m.push_back(member<T>(
        "colour", rgb(kUnit), [](T & t) -> auto& { return t.material.colour; }));
    m.push_back(member<T>(
        "metallic", real_float(kUnit), [](T & t) -> auto& { return t.material.metallic; }));
    m.push_back(member<T>(
        "roughness", real_float(kUnit), [](T & t) -> auto& { return t.material.roughness; }));
    m.push_back(member<T>(
        "ior", real_float({1.0, 10.0}), [](T & t) -> auto& { return t.material.ior; }));
    m.push_back(member<T>(
        "specular", real_float(kUnit), [](T & t) -> auto& { return t.material.specular; }));
    m.push_back(member<T>(
        "transmission", real_float(kUnit), [](T & t) -> auto& { return t.material.transmission; }));
    m.push_back(member<T>(
        "emission", rgb(radiometric()), [](T & t) -> auto& { return t.material.emission; }));
}

Codec<SceneFile> file_codec() {
    using T = SceneFile;
    return object_of<T>("a glTF file {\"file\": ..., \"up\": \"y\" or \"z\", \"world_from_file\": 16 numbers}",
                        {member<T>(
                             "file", text(false), [](T & t) -> auto& { return t.file; }, true),
                         member<T>(
                             "up", up_axis(), [](T & t) -> auto& { return t.up; }),
                         member<T>(
                             "world_from_file", matrix(), [](T & t) -> auto& { return t.world_from_file; })});
}

Codec<QuickQuad> quad_codec() {
    using T = QuickQuad;
    std::vector<Member<T>> m = {member<T>(
        "corners", corners(), [](T & t) -> auto& { return t.corners; }, true)};
    add_material(m);
    return object_of<T>("a quad {\"corners\": ..., \"colour\": ...}", m);
}

Codec<QuickSphere> sphere_codec() {
    using T = QuickSphere;
    std::vector<Member<T>> m = {member<T>(
                                    "centre", point(), [](T & t) -> auto& { return t.centre; }, true),
                                member<T>(
                                    "radius", real({0.0, 1e15, true}), [](T & t) -> auto& { return t.radius; }, true)};
    add_material(m);
    return object_of<T>("a sphere {\"centre\": ..., \"radius\": ..., \"colour\": ...}", m);
}

Codec<LightSettings> light_codec() {
    using T = LightSettings;
    const Codec<LightKind> kinds = choice<LightKind>({{"point", LightKind::Point},
                                                      {"spot", LightKind::Spot},
                                                      {"sun", LightKind::Sun},
                                                      {"quad", LightKind::Quad},
                                                      {"environment", LightKind::Environment}});
    return object_of<T>("a light {\"kind\": ..., \"power\": ..., ...}",
                        {member<T>(
                             "kind", kinds, [](T & t) -> auto& { return t.kind; }, true),
                         member<T>(
                             "name", text(true), [](T & t) -> auto& { return t.name; }),
                         member<T>(
                             "position", point(), [](T & t) -> auto& { return t.position; }),
                         member<T>(
                             "direction", point(), [](T & t) -> auto& { return t.direction; }),
                         member<T>(
                             "power", rgb(radiometric()), [](T & t) -> auto& { return t.power; }),
                         member<T>(
                             "inner_degrees", real({0.0, 180.0}), [](T & t) -> auto& { return t.inner_degrees; }),
                         member<T>(
                             "outer_degrees", real({0.0, 180.0, true}), [](T & t) -> auto& { return t.outer_degrees; }),
                         member<T>(
                             "angle_degrees", real({0.0, 180.0}), [](T & t) -> auto& { return t.angle_degrees; }),
                         member<T>(
                             "corners", corners(), [](T & t) -> auto& { return t.corners; }),
                         member<T>(
                             "file", text(true), [](T & t) -> auto& { return t.file; }),
                         member<T>(
                             "up", up_axis(), [](T & t) -> auto& { return t.up; }),
                         member<T>(
                             "rotate_degrees", real(any_number()), [](T & t) -> auto& { return t.rotate_degrees; })});
}

}  // namespace

void add_scene_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "scene.files", "glTF 2.0 files; up: the world's axis that glTF's y becomes",
        list_of("a list of glTF files [{\"file\": ...}]", file_codec()),
        [](Shot & s) -> auto& { return s.scene.files; }));
    keys.push_back(make_key(
        "scene.quads", "quick quads; both sides scatter, the front emits [W/(m^2 sr)]",
        list_of("a list of quads [{\"corners\": ...}]", quad_codec()),
        [](Shot & s) -> auto& { return s.scene.quads; }));
    keys.push_back(make_key(
        "scene.spheres", "quick spheres [m]",
        list_of("a list of spheres [{\"centre\": ..., \"radius\": ...}]", sphere_codec()),
        [](Shot & s) -> auto& { return s.scene.spheres; }));
    keys.push_back(make_key(
        "scene.lights",
        "power: point, spot: intensity [W/sr]; sun: irradiance [W/m^2]; quad, environment: radiance [W/(m^2 sr)]",
        list_of("a list of lights [{\"kind\": ...}]", light_codec()),
        [](Shot & s) -> auto& { return s.scene.lights; }));
    keys.push_back(make_key(
        "scene.camera", "a glTF file's camera by name, where the shot gives none; empty: the first there is",
        text(true), [](Shot & s) -> auto& { return s.scene.camera; }));
    keys.push_back(make_key(
        "scene.frames_per_second", "from frames to the seconds of glTF animations", real(above(0.0)),
        [](Shot & s) -> auto& { return s.scene.frames_per_second; }));
}

}  // namespace brisance
