// From the files that a shot names to the triangles of one frame.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "scene/scene.h"
#include "scene/settings.h"

namespace brisance {

// Everything of the settings but the lights that are not surfaces: files at `seconds` of their animations with their
// meshes, cameras and lights, then quads, spheres, and lights of kind Quad, relative to `origin`. Relative files are
// relative to `folder`. All animations of a file play together; what of glTF 2.0 is read, and what of it is left out
// with a notice or a warning, stands in gltf_nodes.h, gltf_animation.h, gltf_meshes.h, gltf_morph.h,
// gltf_skins.h, gltf_materials.h and gltf_cameras.h.
//
// Throws Error MissingInput (no such file, buffer or texture) or BadData (what the file says cannot be used), Temporary
// (more memory than `memory_limit` bytes would be needed, reported before allocation; that counts the files' bytes,
// triangles with the tree over them, and textures). Triangles without area, or with positions that are not finite, are
// left out with a warning that counts them.
//
// For further moments of a scene, `same_pictures` is the scene of another moment, of the same settings, folder and
// files: its textures are shared, no picture is opened or decoded again, and the pictures do not count as memory again.
// Where settings or files differ, materials would have the wrong textures.
Scene load_scene(const SceneSettings& settings, const std::filesystem::path& folder, double seconds,
                 const dvec3& origin, std::uint64_t memory_limit, Progress& progress,
                 const Scene* same_pictures = nullptr);

// Where the first node of that name is, in the world, at a moment; nothing where the file has none. Adds the names of
// all its nodes to `known`.
std::optional<dmat4> load_node(const SceneFile& file, const std::filesystem::path& folder, double seconds,
                               const std::string& name, std::vector<std::string>& known);

// The cameras of one glTF file at a moment. For choosing one before anything else is read.
std::vector<SceneCamera> load_cameras(const SceneFile& file, const std::filesystem::path& folder, double seconds);

}  // namespace brisance
