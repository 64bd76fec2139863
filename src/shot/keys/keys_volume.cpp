#include "shot/keys/keys.h"
#include "shot/keys/object_codec.h"
#include "shot/keys/time_codecs.h"

namespace brisance {
namespace {

Codec<MappingPreset> mapping_preset() {
    return choice<MappingPreset>({{"auto", MappingPreset::Automatic},
                                  {"automatic", MappingPreset::Automatic},
                                  {"houdini", MappingPreset::Houdini},
                                  {"embergen", MappingPreset::EmberGen},
                                  {"mantaflow", MappingPreset::Mantaflow}});
}

Codec<GridRoles> roles() {
    using T = GridRoles;
    return object_of<T>("grids by role {\"density\": \"name\", \"flame\": \"name[index]\", ...}",
                        {member<T>(
                             "density", optional_text(), [](T & t) -> auto& { return t.density; }),
                         member<T>(
                             "temperature", optional_text(), [](T & t) -> auto& { return t.temperature; }),
                         member<T>(
                             "flame", optional_text(), [](T & t) -> auto& { return t.flame; }),
                         member<T>(
                             "colour", optional_text(), [](T & t) -> auto& { return t.colour; }),
                         member<T>(
                             "velocity", velocity_grids(), [](T & t) -> auto& { return t.velocity; })});
}

Codec<FogBox> fog_box() {
    using T = FogBox;
    return object_of<T>("a homogeneous box {\"low\": [x, y, z], \"high\": [x, y, z]}",
                        {member<T>(
                             "low", point(), [](T & t) -> auto& { return t.low; }, true),
                         member<T>(
                             "high", point(), [](T & t) -> auto& { return t.high; }, true),
                         member<T>(
                             "voxel_metres", real({0.0, 1e15}), [](T & t) -> auto& { return t.voxel_metres; })});
}

Codec<FurtherVolume> further_volume() {
    using T = FurtherVolume;
    return object_of<T>(
        "a volume {\"file\" or \"box\": ..., \"world_from_file\": 16 numbers, \"albedo\": ..., ...}",
        {member<T>(
             "file", text(false), [](T & t) -> auto& { return t.volume.file; }),
         member<T>(
             "box", if_given(fog_box()), [](T & t) -> auto& { return t.volume.box; }),
         member<T>(
             "preset", mapping_preset(), [](T & t) -> auto& { return t.volume.preset; }),
         member<T>(
             "grids", roles(), [](T & t) -> auto& { return t.volume.grids; }),
         member<T>(
             "half_voxel_shift", flag(), [](T & t) -> auto& { return t.volume.half_voxel_shift; }),
         member<T>(
             "up", up_axis(), [](T & t) -> auto& { return t.volume.up; }),
         member<T>(
             "world_from_file", matrix(), [](T & t) -> auto& { return t.volume.world_from_file; }),
         member<T>(
             "node", text(true), [](T & t) -> auto& { return t.volume.node; }),
         member<T>(
             "time", if_given(time_object()), [](T & t) -> auto& { return t.time; }),
         member<T>(
             "velocity", if_given(velocity_object()), [](T & t) -> auto& { return t.velocity; }),
         member<T>(
             "extinction_per_metre", if_given(real_float(radiometric())),
             [](T & t) -> auto& { return t.changes.extinction_per_metre; }),
         member<T>(
             "albedo", if_given(rgb({0.0, 1.0})), [](T & t) -> auto& { return t.changes.albedo; }),
         member<T>(
             "fire_model", if_given(fire_model()), [](T & t) -> auto& { return t.changes.model; }),
         member<T>(
             "fire_strength", if_given(real_float(radiometric())), [](T & t) -> auto& { return t.changes.strength; }),
         member<T>(
             "fire_threshold", if_given(real_float(radiometric())), [](T & t) -> auto& { return t.changes.threshold; }),
         member<T>(
             "fire_colour", if_given(rgb(tint())), [](T & t) -> auto& { return t.changes.colour; }),
         member<T>(
             "fire_ramp", if_given(ramp()), [](T & t) -> auto& { return t.changes.ramp; })});
}

}  // namespace

void add_volume_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "volume.file", "the .vdb file, relative to the shot's folder; frame tokens: ####, @@@, %04d, $F4, <frame04>",
        text(false), [](Shot & s) -> auto& { return s.volume.file; }));
    // A shot of surfaces alone, written down, must be read again.
    keys.back().get = [get = keys.back().get](const Shot& shot) {
        return shot.volume.file.empty() ? std::nullopt : get(shot);
    };
    keys.push_back(make_key(
        "volume.preset", "how grids are recognised by name", mapping_preset(),
        [](Shot & s) -> auto& { return s.volume.preset; }));
    keys.push_back(make_key(
        "volume.grids.density", "smoke", optional_text(), [](Shot & s) -> auto& { return s.volume.grids.density; }));
    keys.push_back(make_key(
        "volume.grids.temperature", "of black-body fire, mapped to kelvin by fire.temperature_*", optional_text(),
        [](Shot & s) -> auto& { return s.volume.grids.temperature; }));
    keys.push_back(make_key(
        "volume.grids.flame", "intensity of the fire", optional_text(),
        [](Shot & s) -> auto& { return s.volume.grids.flame; }));
    keys.push_back(make_key(
        "volume.grids.colour", "three channels; colour_role says of what", optional_text(),
        [](Shot & s) -> auto& { return s.volume.grids.colour; }));
    keys.push_back(make_key(
        "volume.grids.velocity", "a vector grid or three scalar ones [x, y, z]; moves smoke between frames",
        velocity_grids(), [](Shot & s) -> auto& { return s.volume.grids.velocity; }));
    keys.push_back(make_key(
        "volume.half_voxel_shift", "true: the sample of index i lies at i + 1/2 (Blender means this) instead of at i",
        flag(), [](Shot & s) -> auto& { return s.volume.half_voxel_shift; }));
    keys.push_back(make_key(
        "volume.up", "the world's axis that the file's y becomes; y: as it is", up_axis(),
        [](Shot & s) -> auto& { return s.volume.up; }));
    keys.push_back(make_key(
        "volume.world_from_file", "moves the volume, after volume.up; affine, lengths in metres", matrix(),
        [](Shot & s) -> auto& { return s.volume.world_from_file; }));
    keys.push_back(make_key(
        "volume.node", "a node of the shot's glTF files that carries the volume, with its animation; empty: none",
        text(true), [](Shot & s) -> auto& { return s.volume.node; }));
    keys.push_back(make_key(
        "volumes", "further volumes, whose coefficients add; what they do not say of smoke and fire is the shot's",
        list_of("a list of volumes [{\"file\" or \"box\": ...}]", further_volume()),
        [](Shot & s) -> auto& { return s.volumes; }));
}

}  // namespace brisance
