// glTF files with all they hold: meshes, materials, pictures, cameras and lights.
#include "scene/load_scene.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace brisance;
    SceneSettings settings;
    settings.files.emplace_back().file = fuzz::file_with(fuzz::text_of(data, size), ".glb").string();
    Progress silent;
    constexpr std::uint64_t memory = std::uint64_t{256} << 20;
    fuzz::expect_answer([&] { load_scene(settings, {}, 0.5, dvec3(0.0), memory, silent); });
    return 0;
}
