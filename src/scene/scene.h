// One frame's surfaces as triangles in one space, with their materials and textures. Files, nodes and animation have
// been resolved for one moment.
//
// Positions are "local": metres relative to `origin`, axes parallel to the world's, so that a set 10^6 m from the
// world's origin keeps its digits in single precision.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/vec.h"
#include "scene/settings.h"
#include "scene/texture.h"
#include "surfaces/material.h"

namespace brisance {

// A texture as a material uses it: `uv` of the mesh, moved by the affine map (KHR_texture_transform), looks it up.
struct TextureUse {
    int texture = -1;  // of the scene; -1: none, the factor stands alone
    glm::mat3x2 texture_from_uv{1.0f, 0.0f, 0.0f, 1.0f, 0.0f, 0.0f};
};

enum class AlphaMode {
    Opaque,
    Mask,  // cut out where alpha is below the cutoff
    Blend  // lets through 1 - alpha
};

// Each texture multiplies the factor beside it, in the channels that glTF gives it. They are left out where a mesh has
// no texture coordinates.
struct SceneMaterial {
    std::string name;
    SurfaceMaterial surface;  // factors
    TextureUse base_colour;   // rgb; its a multiplies alpha
    TextureUse metal_rough;   // b: metallic, g: roughness
    TextureUse transmission;  // r
    TextureUse specular;      // a
    TextureUse specular_colour;
    TextureUse emission_colour;
    TextureUse normal;
    float normal_scale = 1.0f;
    Rgb emission{0.0f};  // radiance [W/(m^2 sr)]; emissiveFactor times KHR_materials_emissive_strength
    AlphaMode alpha_mode = AlphaMode::Opaque;
    float alpha = 1.0f, alpha_cutoff = 0.5f;
    bool double_sided = false;  // false: emits from the front only. Both sides scatter in either case
    bool emits() const { return emission != Rgb(0.0f); }
};

// Triangles of one material. Counter-clockwise as seen from the front.
struct SceneMesh {
    std::string name;
    std::vector<vec3> positions;  // local [m]
    std::vector<vec3> normals;    // unit, per position; empty: flat
    std::vector<vec2> uv;         // per position; empty: no textures
    std::vector<glm::uvec3> triangles;
    int material = 0;
};

struct SceneCamera {
    std::string name;
    dmat4 world_from_camera{1.0};  // rigid; x right, y up, looking along -z
    double vertical_fov_degrees = 35.0;
    std::optional<double> aspect;  // width over height, where the file says
};

struct Scene {
    dvec3 origin{0.0};  // world [m]
    std::vector<SceneMesh> meshes;
    std::vector<SceneMaterial> materials;                  // at least one where there are meshes
    std::vector<std::shared_ptr<const Texture>> textures;  // none is null; the moments of a scene may share them
    std::vector<SceneCamera> cameras;
    std::vector<LightSettings> lights;  // of the files: Point, Spot and Sun
    // Whether anything of it may be elsewhere, or of another shape, at another moment: an animation of a file moves a
    // mesh, a joint of a mesh's skin, a camera or a light, or their ancestors, or changes the weights of a mesh's morph
    // targets, with keys that differ. False: every moment has this scene. What triangles show, and whether a camera or
    // a light is used, is not looked at.
    bool animated = false;

    std::size_t triangle_count() const;
    // Whether any surface has lobes other than Lambert's.
    bool is_glossy() const;
    // Whether all triangles lie in one plane, as those of a floor do: none of them sends light to another. A slanted
    // plane whose first triangle is small may be missed, for that does not know its normal well.
    bool is_flat() const;
    double largest_coordinate() const;  // of all vertices, absolute [m]
    std::uint64_t bytes() const;        // shared textures included
};

}  // namespace brisance
