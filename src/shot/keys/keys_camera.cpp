#include "shot/keys/keys.h"

namespace brisance {
namespace {

bool& placed(Shot& shot) {
    return shot.camera_given;
}

// These keys are written only when no matrix replaces them, so that the written shot can be read.
Key unless_matrix(Key key) {
    key.get = [get = key.get](const Shot& shot) { return shot.camera.world_from_camera ? std::nullopt : get(shot); };
    return key;
}

Key matrix_key() {
    const Codec<dmat4> codec = matrix();
    return {"camera.world_from_camera",
            "instead of eye, target and up: x right, y up, looking along -z; rigid",
            codec.expected,
            codec.schema,
            [codec](Shot& shot, const Json& json) {
                const std::optional<dmat4> value = codec.read(json);
                if (!value)
                    return false;
                shot.camera.world_from_camera = value;
                shot.camera_given = true;
                return true;
            },
            [codec](const Shot& shot) -> std::optional<Json> {
                return shot.camera.world_from_camera ? std::optional<Json>(codec.write(*shot.camera.world_from_camera))
                                                     : std::nullopt;
            }};
}

}  // namespace

void add_camera_keys(std::vector<Key>& keys) {
    keys.push_back(unless_matrix(make_flagged_key(
        "camera.eye", "where the camera is [m]", point(), [](Shot & s) -> auto& { return s.camera.eye; }, placed)));
    keys.push_back(unless_matrix(make_flagged_key(
        "camera.target", "what it looks at [m]", point(), [](Shot & s) -> auto& { return s.camera.target; }, placed)));
    keys.push_back(unless_matrix(make_key(
        "camera.up", "points up in the picture: [0, 0, 1] or [0, 1, 0] by habit", point(),
        [](Shot & s) -> auto& { return s.camera.up; })));
    keys.push_back(matrix_key());
    keys.push_back(make_key(
        "camera.vertical_fov_degrees", "the full vertical angle [degrees]", real({0.0, 180.0, true, true}),
        [](Shot & s) -> auto& { return s.camera.vertical_fov_degrees; }));
    keys.push_back(make_key(
        "camera.width", "[pixels]", whole(1, 16384), [](Shot & s) -> auto& { return s.camera.width; }));
    keys.push_back(make_key(
        "camera.height", "[pixels]", whole(1, 16384), [](Shot & s) -> auto& { return s.camera.height; }));
    keys.push_back(make_key(
        "camera.samples_per_axis", "anti-aliasing samples along each side of a pixel", or_word(whole(1, 64), "auto", 0),
        [](Shot & s) -> auto& { return s.camera.samples_per_axis; }));
    keys.push_back(make_key(
        "camera.edge_refinement",
        "as many times more samples along a side, of what shines by itself, where it has edges in a set; 1: none",
        whole(1, 16), [](Shot & s) -> auto& { return s.camera.edge_refinement; }));
    keys.push_back(make_key(
        "camera.filter", "of a pixel",
        choice<PixelFilter>({{"box", PixelFilter::Box}, {"gaussian", PixelFilter::Gaussian}}),
        [](Shot & s) -> auto& { return s.camera.filter; }));
    keys.push_back(make_key(
        "camera.filter_width_pixels", "full width of the box, or four standard deviations of the Gaussian [pixels]",
        real_float({0.0, 16.0, true}), [](Shot & s) -> auto& { return s.camera.filter_width_pixels; }));
}

}  // namespace brisance
