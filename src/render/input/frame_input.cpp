#include "render/input/frame_input.h"

#include <optional>

#include "camera/camera.h"
#include "camera/shutter.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "render/input/kept_inputs.h"
#include "render/input/load_medium.h"
#include "scene/load_scene.h"
#include "scene/read_texture.h"

namespace brisance {

namespace {

constexpr std::uint64_t kSceneMemory = std::uint64_t{12} << 30;

// The camera that the shot names, or the first of the first file that has one.
std::optional<SceneCamera> camera_of_files(const Shot& shot, double seconds) {
    std::string known;
    for (const SceneFile& file : shot.scene.files)
        for (SceneCamera& camera : load_cameras(file, shot.folder, seconds)) {
            if (shot.scene.camera.empty() || camera.name == shot.scene.camera)
                return std::move(camera);
            known += (known.empty() ? "" : ", ") + camera.name;
        }
    if (!shot.scene.camera.empty())
        throw Error(ExitCode::Usage, "scene.camera: no glTF file has a camera \"" + shot.scene.camera + "\"; there " +
                                         (known.empty() ? "is none at all" : "are " + known));
    return std::nullopt;
}

CameraSettings with_file_camera(CameraSettings settings, const SceneCamera& camera, Progress& progress) {
    settings.world_from_camera = camera.world_from_camera;
    settings.vertical_fov_degrees = camera.vertical_fov_degrees;
    const double aspect = double(settings.width) / settings.height;
    if (camera.aspect && std::abs(aspect / *camera.aspect - 1.0) > 0.01)
        progress.notice("camera " + camera.name + " is made for pictures of " + std::to_string(*camera.aspect) +
                        " times their height; this one's sides are " + (aspect < *camera.aspect ? "cut" : "wider"));
    return settings;
}

// An empty medium whose local space begins at `origin`.
Medium empty_medium(const dvec3& origin) {
    Medium medium;
    medium.world_from_index[3] = glm::dvec4(origin, 1.0);
    return medium;
}

dvec3 origin_of(const Medium& medium) {
    return medium.world_of_local(vec3(0.0f));
}

// Around, but not over the poles. Pictures with eight bits a channel are meant for screens.
Texture read_environment(const std::filesystem::path& file) {
    Texture picture = read_texture(file, false, kSceneMemory);
    picture.srgb = !picture.bytes.empty();
    picture.wrap_u = Wrap::Repeat;
    picture.wrap_v = Wrap::Clamp;
    return picture;
}

// `same_pictures`: as load_scene.
KeptSet load_set(const Shot& shot, double seconds, const dvec3& origin, Progress& to,
                 const Scene* same_pictures = nullptr) {
    SaidLines progress(to);
    Scene scene = load_scene(shot.scene, shot.folder, seconds, origin, kSceneMemory, progress, same_pictures);
    std::vector<LightSettings> lights = shot.scene.lights;
    lights.insert(lights.end(), scene.lights.begin(), scene.lights.end());
    std::vector<Texture> pictures;
    for (const LightSettings& light : lights)
        pictures.push_back(light.kind == LightKind::Environment && !light.file.empty()
                               ? read_environment(shot.folder / light.file)
                               : Texture{});
    const bool animated = scene.animated;
    auto out = std::make_shared<Surroundings>(std::move(scene), std::move(lights), std::move(pictures));
    return {std::move(out), origin, seconds, animated, std::move(progress.lines)};
}

// The set of this frame: that of an earlier one, where nothing of it moves.
std::shared_ptr<const Surroundings> surroundings_for(const Shot& shot, double seconds, const dvec3& origin,
                                                     KeptInputs* kept, Statistics& statistics, Progress& progress) {
    progress.stage("surfaces");
    const Stopwatch watch;
    KeptSet own;
    KeptSet& set = kept ? kept->set : own;
    const bool holds = set.holds_at(seconds, origin);
    if (holds)
        say_again(set.said, progress);
    else
        set = load_set(shot, seconds, origin, progress);
    const Surroundings& out = *set.surroundings;
    statistics.stages.push_back(
        {"surfaces",
         watch.seconds(),
         out.bytes(),
         {{"triangles", out.scene().triangle_count()}, {"emitters", out.emitters().near_count()}}});
    if (holds)
        statistics.stages.back().detail["kept"] = true;
    return set.surroundings;
}

// Files without animations have the same camera at all times.
std::optional<SceneCamera> camera_of_set(const Shot& shot, double seconds, const KeptInputs* kept) {
    if (kept && kept->set.surroundings && !kept->set.animated)
        for (const SceneCamera& camera : kept->set.surroundings->scene().cameras)
            if (shot.scene.camera.empty() || camera.name == shot.scene.camera)
                return camera;
    return camera_of_files(shot, seconds);
}

CameraSettings choose_camera(const Shot& shot, const std::optional<SceneCamera>& of_file, const FrameInput& input,
                             Progress& progress) {
    if (shot.camera_given)
        return shot.camera;
    if (of_file)
        return with_file_camera(shot.camera, *of_file, progress);
    if (input.medium.lattice.brick_count() > 0 || !input.surroundings)
        return framed_camera(input.medium, shot.camera);
    const bool y_up = !shot.scene.files.empty() && shot.scene.files.front().up == 'y';
    progress.notice("no camera: the picture is framed on the scene");
    return framed_camera(input.surroundings->scene(), y_up ? dvec3(0, 1, 0) : dvec3(0, 0, 1), shot.camera);
}

// The animation of the files between the instants at which the shutter opens and closes. What is the same at both does
// not move. Further moments are loaded in silence: what there is to say has been said.
Animation animation_of_files(const Shot& shot, int frame, bool camera_of_file, const FrameInput& input) {
    Animation out;
    const double rate = shot.scene.frames_per_second;
    const ShutterSpan span = shutter_span(shot.shutter);
    const auto camera = [&shot, rate, frame, &like = shot.camera](double frames) {
        Progress silent;
        return with_file_camera(like, *camera_of_files(shot, (frame + frames) / rate), silent);
    };
    if (camera_of_file &&
        !(stand_still(camera(span.opens), input.camera) && stand_still(camera(span.closes), input.camera)))
        out.camera = camera;
    if (!input.surroundings || !input.surroundings->scene().animated)
        return out;
    const Surroundings& now = *input.surroundings;
    const auto surroundings = [&shot, &now, rate, frame, origin = origin_of(input.medium)](double frames) {
        Progress silent;
        return load_set(shot, (frame + frames) / rate, origin, silent, &now.scene()).surroundings;
    };
    if (!stand_still(*surroundings(span.opens), now) || !stand_still(*surroundings(span.closes), now))
        out.surroundings = surroundings;
    return out;
}

}  // namespace

FrameInput load_frame(const Shot& shot, const std::filesystem::path& volume, int frame, Statistics& statistics,
                      Progress& progress, KeptInputs* kept) {
    FrameInput input;
    const double seconds = frame / shot.scene.frames_per_second;
    std::optional<SceneCamera> of_file;
    if (!shot.camera_given && !shot.scene.files.empty())
        of_file = camera_of_set(shot, seconds, kept);
    if (volume.empty() && shot.volumes.empty()) {
        dvec3 eye(0.0);
        if (shot.camera_given)
            eye = shot.camera.world_from_camera ? dvec3((*shot.camera.world_from_camera)[3]) : shot.camera.eye;
        else if (of_file)
            eye = dvec3(of_file->world_from_camera[3]);
        input.medium = empty_medium(eye);
    } else {
        input.medium = load_medium(shot, volume, frame, statistics, progress, kept);
    }
    if (!shot.scene.empty())
        input.surroundings = surroundings_for(shot, seconds, origin_of(input.medium), kept, statistics, progress);
    input.camera = choose_camera(shot, of_file, input, progress);
    if (shot.shutter.length > 0.0)
        input.animation = animation_of_files(shot, frame, of_file.has_value(), input);
    return input;
}

CameraSettings camera_at(const Shot& shot, double frame, const FrameInput& like) {
    if (shot.camera_given || !like.surroundings || !like.surroundings->scene().animated)
        return like.camera;
    Progress silent;
    const std::optional<SceneCamera> of_file = camera_of_files(shot, frame / shot.scene.frames_per_second);
    return of_file ? with_file_camera(shot.camera, *of_file, silent) : like.camera;
}

}  // namespace brisance
