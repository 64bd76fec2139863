// Materials and textures of a glTF file, as far as they are used.
#pragma once

#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "scene/gltf/gltf_file.h"
#include "scene/memory_budget.h"
#include "scene/scene.h"

namespace brisance {

// Adds materials (glTF 2.0, section 3.9) and their textures to a scene when they are first used. Factors beyond their
// range are clamped with a warning. KHR_materials_unlit becomes a Lambertian surface of the base colour: "unlit" is no
// property of a surface that light falls on. Vertex colours, occlusion and absorption within volumes are left out with
// a notice.
class GltfMaterials {
public:
    // Takes the textures of `same_pictures`, as far as they go, instead of reading any; null: reads all.
    GltfMaterials(const GltfFile& file, Scene& scene, MemoryBudget& budget, Progress& progress,
                  const Scene* same_pictures)
        : file_(file), scene_(scene), budget_(budget), progress_(progress), same_pictures_(same_pictures) {}

    // The scene's material for one of the file; -1: glTF's default material.
    int scene_material(int material);
    // The set of texture coordinates that all its textures use; -1 where it has none. Those of other sets are left out.
    int uv_set(int scene_material) const { return uv_sets_.at(scene_material); }

private:
    // What a texture reference says, whatever its class in tinygltf.
    struct Reference {
        int texture = -1, uv_set = 0;
        glm::mat3x2 texture_from_uv{1.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f};
    };

    SceneMaterial convert(const tinygltf::Material& material);
    void read_base(const tinygltf::Material& material, SceneMaterial& result);
    void read_extensions(const tinygltf::Material& material, SceneMaterial& result);
    void read_emission(const tinygltf::Material& material, SceneMaterial& result);
    void read_alpha(const tinygltf::Material& material, SceneMaterial& result);

    Reference reference(int texture, int uv_set, const tinygltf::ExtensionMap& extensions) const;
    Reference reference(const tinygltf::Value& info) const;
    TextureUse use(const Reference& reference, bool srgb);
    int load(const tinygltf::Texture& texture, int index, bool srgb);
    std::shared_ptr<const Texture> read(int image, Wrap u, Wrap v, bool nearest, bool srgb);
    Texture decode(int image, bool srgb);

    float clamped(double value, double low, double high, const char* what);
    [[noreturn]] void reject(const std::string& why) const;

    const GltfFile& file_;
    Scene& scene_;
    MemoryBudget& budget_;
    Progress& progress_;
    const Scene* same_pictures_;
    std::map<int, int> materials_;                                   // of the file to of the scene
    std::map<int, int> uv_sets_;                                     // by material of the scene
    std::map<std::tuple<int, int, int, bool, bool>, int> textures_;  // image, wraps, nearest, srgb to of the scene
    std::string label_;                                              // of the material that is being read
    int uv_set_ = -1;                                                // of that material
};

}  // namespace brisance
