#include "farm/input_files.h"

#include <algorithm>

#include "core/error.h"
#include "render/input/volume_in_time.h"
#include "render/light_windows.h"
#include "scene/gltf/gltf_inputs.h"

namespace brisance {

namespace {

namespace fs = std::filesystem;

void add_once(std::vector<fs::path>& files, const fs::path& file) {
    const fs::path plain = file.lexically_normal();
    if (std::find(files.begin(), files.end(), plain) == files.end())
        files.push_back(plain);
}

void add_volumes(std::vector<fs::path>& files, const Shot& shot, const FrameFile& frame) {
    const auto add = [&](const SourceFiles& volume) {
        for (const fs::path& file : {volume.first, volume.second})
            if (!file.empty())
                add_once(files, file);
    };
    if (shot.time.identity())
        add({frame.file, frame.file, {}});
    else
        add(own_files(shot, frame.frame));
    for (const FurtherVolume& v : shot.volumes)
        if (!v.volume.box)
            add(source_files((shot.folder / v.volume.file).string(), time_of(shot, v), frame.frame));
}

// A window whose files are not there is left out when the frame is rendered, too.
void add_volumes_of_window(std::vector<fs::path>& files, const Shot& shot, const LightWindow& window) {
    try {
        const int frame = frame_of_window(shot, window);
        add_volumes(files, shot, {frame, shot.volume.file.empty() ? fs::path() : own_files(shot, frame).nearest()});
    } catch (const Error& error) {
        if (error.code() == ExitCode::Usage)
            throw;
    }
}

}  // namespace

std::vector<fs::path> volume_files(const Shot& shot, const FrameFile& frame) {
    std::vector<fs::path> files;
    add_volumes(files, shot, frame);
    if (may_share_lights(shot))
        for (const LightWindow& window : light_windows(frame.frame, shot.virtual_lights.window))
            add_volumes_of_window(files, shot, window);
    return files;
}

std::vector<fs::path> set_files(const Shot& shot) {
    std::vector<fs::path> files;
    for (const SceneFile& scene : shot.scene.files)
        for (const fs::path& file : files_of_gltf(shot.folder / scene.file))
            add_once(files, file);
    for (const LightSettings& light : shot.scene.lights)
        if (light.kind == LightKind::Environment && !light.file.empty())
            add_once(files, shot.folder / light.file);
    return files;
}

std::vector<fs::path> input_files(const Shot& shot, const FrameFile& frame) {
    std::vector<fs::path> files = volume_files(shot, frame);
    for (const fs::path& file : set_files(shot))
        add_once(files, file);
    return files;
}

}  // namespace brisance
