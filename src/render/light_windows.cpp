#include "render/light_windows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "render/input/volume_in_time.h"
#include "volume/frame_path.h"

namespace brisance {

namespace {

constexpr int kCamerasPerSide = 2;  // of a window's middle

std::string own_pattern(const Shot& shot) {
    return shot.volume.file.empty() ? "" : (shot.folder / shot.volume.file).string();
}

// Whether some volume of the shot has a file for each frame.
bool has_sequence(const Shot& shot) {
    return has_frame_token(own_pattern(shot)) ||
           std::any_of(shot.volumes.begin(), shot.volumes.end(), [&](const FurtherVolume& v) {
               return !v.volume.box && has_frame_token((shot.folder / v.volume.file).string());
           });
}

// The set of a frame, if it is also that of others.
KeptInputs with_set_of(const FrameInput& input, const KeptInputs* kept) {
    KeptInputs out;
    if (kept && kept->set.surroundings == input.surroundings)
        out.set = kept->set;
    return out;
}

// At evenly spread times of the window.
std::vector<CameraSettings> cameras_of_window(const Shot& shot, const LightWindow& window, const FrameInput& middle) {
    const double width = shot.virtual_lights.window;
    std::vector<CameraSettings> cameras;
    for (int i = -kCamerasPerSide; i <= kCamerasPerSide; ++i) {
        cameras.push_back(camera_at(shot, width * (window.number + double(i) / kCamerasPerSide), middle));
        if (cameras.size() == 2 && stand_still(cameras[0], cameras[1]))
            cameras.pop_back();
    }
    return cameras;
}

PlacedLights place(const Shot& shot, const LightWindow& window, const FrameInput& middle) {
    std::vector<Camera> cameras;
    for (const CameraSettings& settings : cameras_of_window(shot, window, middle))
        cameras.emplace_back(settings, middle.medium);
    std::vector<PixelCamera> pixels;
    for (const Camera& camera : cameras)
        pixels.push_back({camera.settings().width, camera.settings().height,
                          [&camera](double x, double y) { return camera.ray(x, y); }});
    const DirectLight scene(middle.medium, shot.tracing, middle.surroundings.get());
    return place_lights(scene, pixels, shot.virtual_lights);
}

// The input of the frame that stands for a window, without its shutter.
FrameInput load_middle(const Shot& given, const FrameFile& frame, const FrameInput& like, const KeptInputs* kept) {
    Shot shot = given;
    shot.shutter.length = 0.0;
    Progress silent;
    Statistics unused;
    KeptInputs set = with_set_of(like, kept);
    return load_frame(shot, frame.file, frame.frame, unused, silent, &set);
}

using Placed = std::shared_ptr<const PlacedLights>;

// Those that another process has left, or new ones.
Placed find_or_place(const Shot& shot, int frame, const LightWindow& window, const FrameInput& input, KeptInputs* kept,
                     bool& found) {
    const int stands = frame_of_window(shot, window);
    const FrameFile of{stands, shot.volume.file.empty() ? std::filesystem::path() : own_files(shot, stands).nearest()};
    // What a time budget chooses depends on the machine.
    ResultStore* const results = kept && !(shot.seconds > 0.0) ? kept->results : nullptr;
    const std::string name = fmt::format("positions of virtual lights, {} of {} bytes", window.number, sizeof(Deposit));
    if (const std::optional<std::string> bytes = results ? results->find(name, of) : std::nullopt)
        if (std::optional<PlacedLights> lights = placed_lights_of(*bytes)) {
            found = true;
            return std::make_shared<PlacedLights>(std::move(*lights));
        }
    const Placed lights = std::make_shared<PlacedLights>(
        stands == frame ? place(shot, window, input) : place(shot, window, load_middle(shot, of, input, kept)));
    if (results)
        results->keep(name, of, to_bytes(*lights));
    return lights;
}

// Null where the window's files cannot be used, with a warning.
Placed lights_of_window(const Shot& shot, int frame, const LightWindow& window, const FrameInput& input,
                        KeptInputs* kept, bool& found, Progress& progress) {
    try {
        return find_or_place(shot, frame, window, input, kept, found);
    } catch (const Error& error) {
        if (error.code() == ExitCode::Usage)
            throw;
        progress.warning("light-window", std::string("virtual lights are placed without it: ") + error.what());
        return nullptr;
    }
}

}  // namespace

std::vector<LightWindow> light_windows(int frame, int width) {
    const int before = static_cast<int>(std::floor(double(frame) / width));
    const double share = double(frame) / width - before;
    if (share == 0.0)
        return {{before, 1.0}};
    return {{before, 1.0 - share}, {before + 1, share}};
}

bool may_share_lights(const Shot& shot) {
    const bool surfaces = !(shot.scene.files.empty() && shot.scene.quads.empty() && shot.scene.spheres.empty());
    return surfaces && shot.method != RenderMethod::Path && shot.virtual_lights.count > 0 &&
           shot.virtual_lights.window > 0 && has_positions(shot.virtual_lights) && has_sequence(shot);
}

int frame_of_window(const Shot& shot, const LightWindow& window) {
    const int middle = window.number * shot.virtual_lights.window;
    if (!has_frame_token(own_pattern(shot)))
        return middle;
    const std::vector<int> frames = covering_frames(shot);
    return *std::ranges::min_element(frames, {}, [&](int f) { return std::abs(f - middle); });
}

std::vector<SharedPositions> shared_positions(const Shot& shot, int frame, const FrameInput& input, KeptInputs* kept,
                                              Statistics& statistics, Progress& progress) {
    if (!input.surroundings || !may_share_lights(shot))
        return {};
    progress.stage("positions of virtual lights");
    const Stopwatch watch;
    std::map<int, Placed> known;
    std::vector<SharedPositions> out;
    double shares = 0.0;
    int placed = 0, found = 0;
    for (const LightWindow& window : light_windows(frame, shot.virtual_lights.window)) {
        Placed& lights = known[window.number];
        if (kept && kept->light_windows.contains(window.number)) {
            lights = kept->light_windows.at(window.number);
        } else {
            bool in_store = false;
            lights = lights_of_window(shot, frame, window, input, kept, in_store, progress);
            ++(in_store ? found : placed);
        }
        if (!lights)
            continue;
        out.push_back({lights, window.share, static_cast<std::uint64_t>(window.number & 1)});
        shares += window.share;
    }
    for (SharedPositions& positions : out)
        positions.share /= shares;
    if (kept)
        kept->light_windows = std::move(known);
    statistics.stages.push_back({"positions of virtual lights",
                                 watch.seconds(),
                                 0,
                                 {{"windows", out.size()}, {"placed", placed}, {"from_cache", found}}});
    return out;
}

}  // namespace brisance
