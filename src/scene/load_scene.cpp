#include "scene/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <new>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/error.h"
#include "core/up_axis.h"
#include "scene/gltf/gltf_cameras.h"
#include "scene/gltf/gltf_meshes.h"
#include "scene/quick_shapes.h"

namespace brisance {
namespace {

// Passes every line on once: a file may have a thousand materials with the same trait.
class Once : public Progress {
public:
    explicit Once(Progress& listener) : listener_(listener) {}
    void notice(const std::string& line) override {
        if (told_.insert(line).second)
            listener_.notice(line);
    }
    void warning(const std::string& code, const std::string& line) override {
        if (told_.insert(line).second)
            listener_.warning(code, line);
    }

private:
    Progress& listener_;
    std::set<std::string> told_;
};

dmat4 world_from_gltf(const SceneFile& file) {
    if (file.up != 'y' && file.up != 'z')
        throw Error(ExitCode::Usage, fmt::format("{}: up is '{}', it may be y or z", file.file, file.up));
    return file.world_from_file * turned_up(file.up);
}

// One file and where its nodes are.
struct Opened {
    GltfFile gltf;
    std::vector<PlacedNode> nodes;
};

Opened open(const SceneFile& file, const std::filesystem::path& folder, double seconds, MemoryBudget& budget,
            Progress& progress) {
    GltfFile gltf = read_gltf(folder / file.file, budget, progress);
    std::vector<PlacedNode> nodes = place_nodes(gltf, world_from_gltf(file), seconds, progress);
    return {std::move(gltf), std::move(nodes)};
}

template <class T>
void append(std::vector<T>& to, std::vector<T>&& from) {
    std::move(from.begin(), from.end(), std::back_inserter(to));
}

[[noreturn]] void out_of_memory(const std::filesystem::path& file) {
    throw Error(ExitCode::Temporary, fmt::format("{}: there is not enough memory for it; use a simpler file, or a "
                                                 "machine with more memory",
                                                 file.string()));
}

// Adds what is in one file.
void add_file(const SceneFile& file, const std::filesystem::path& folder, double seconds, Scene& scene,
              MemoryBudget& budget, Progress& progress, const Scene* same_pictures) {
    const Opened opened = open(file, folder, seconds, budget, progress);
    const std::size_t meshes = scene.meshes.size();
    read_meshes(opened.gltf, opened.nodes, scene, budget, progress, same_pictures);
    std::vector<SceneCamera> cameras = read_cameras(opened.gltf, opened.nodes, progress);
    std::vector<LightSettings> lights = read_lights(opened.gltf, opened.nodes, progress);
    if (scene.meshes.size() == meshes && cameras.empty() && lights.empty())
        progress.warning("empty-file", opened.gltf.path.string() + ": no surface, camera or light of it can be used");
    append(scene.cameras, std::move(cameras));
    append(scene.lights, std::move(lights));
    scene.animated = scene.animated || moves_camera_or_light(opened.gltf, opened.nodes);
}

}  // namespace

Scene load_scene(const SceneSettings& settings, const std::filesystem::path& folder, double seconds,
                 const dvec3& origin, std::uint64_t memory_limit, Progress& progress, const Scene* same_pictures) {
    Scene scene;
    scene.origin = origin;
    MemoryBudget budget(memory_limit);
    Once once(progress);
    for (const SceneFile& file : settings.files)
        try {
            add_file(file, folder, seconds, scene, budget, once, same_pictures);
        } catch (const std::bad_alloc&) {
            out_of_memory(folder / file.file);
        } catch (const std::length_error&) {  // more than any memory holds
            out_of_memory(folder / file.file);
        }
    for (std::size_t i = 0; i < settings.quads.size(); ++i)
        add_quad(settings.quads[i], fmt::format("quad {}", i), scene, once);
    for (std::size_t i = 0; i < settings.spheres.size(); ++i)
        add_sphere(settings.spheres[i], fmt::format("sphere {}", i), scene, budget);
    const double extent = settings.lights.empty() ? 0.0 : scene.largest_coordinate();
    for (const LightSettings& light : settings.lights)
        if (light.kind == LightKind::Quad)
            add_quad_light(light, extent, scene, once);
    return scene;
}

std::optional<dmat4> load_node(const SceneFile& file, const std::filesystem::path& folder, double seconds,
                               const std::string& name, std::vector<std::string>& known) {
    MemoryBudget unlimited(std::numeric_limits<std::uint64_t>::max());
    Progress silent;
    const Opened opened = open(file, folder, seconds, unlimited, silent);
    for (const PlacedNode& placed : opened.nodes) {
        known.push_back(opened.gltf.model.nodes[static_cast<std::size_t>(placed.node)].name);
        if (known.back() == name)
            return placed.world_from_node;
    }
    return std::nullopt;
}

std::vector<SceneCamera> load_cameras(const SceneFile& file, const std::filesystem::path& folder, double seconds) {
    MemoryBudget unlimited(std::numeric_limits<std::uint64_t>::max());
    Progress silent;
    const Opened opened = open(file, folder, seconds, unlimited, silent);
    return read_cameras(opened.gltf, opened.nodes, silent);
}

}  // namespace brisance
