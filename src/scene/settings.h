// What a shot says of its set: glTF files, quick quads and spheres, lights.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/vec.h"

namespace brisance {

// A glTF 2.0 file and where it stands. glTF is right-handed with y up, in metres.
struct SceneFile {
    std::string file;            // .glb or .gltf, relative to the shot's folder
    char up = 'y';               // the world's axis that glTF's y becomes: 'y' as it is, 'z': (x, y, z) -> (x, -z, y)
    dmat4 world_from_file{1.0};  // applied after `up`
};

// The material of a quick quad or sphere; both of its sides scatter, its front side emits.
struct QuickMaterial {
    Rgb colour{0.5f};           // [1] 0..1
    float metallic = 0.0f;      // [1] 0..1
    float roughness = 1.0f;     // [1] 0..1
    float ior = 1.5f;           // [1] 1..10
    float specular = 0.0f;      // [1] 0..1; 0: a dielectric reflects nothing, plain Lambert
    float transmission = 0.0f;  // [1] 0..1
    Rgb emission{0.0f};         // radiance [W/(m^2 sr)]
};

struct QuickQuad {
    std::array<dvec3, 4> corners{};  // world [m], in order around; counter-clockwise as seen from the front
    QuickMaterial material;
};

struct QuickSphere {
    dvec3 centre{0.0};  // world [m]
    double radius = 1.0;
    QuickMaterial material;
};

enum class LightKind { Point, Spot, Sun, Quad, Environment };

struct LightSettings {
    LightKind kind = LightKind::Point;
    std::string name;
    dvec3 position{0.0};              // Point, Spot: world [m]
    dvec3 direction{0.0, 0.0, -1.0};  // Spot, Sun: of travel; any length above 0
    // Point, Spot: intensity [W/sr]; Sun: irradiance on a surface that faces it [W/m^2]; Quad: radiance [W/(m^2 sr)];
    // Environment: factor of the picture's radiance, or the radiance itself where there is no file.
    Rgb power{1.0f};
    double inner_degrees = 30.0, outer_degrees = 45.0;  // Spot: half angles of full intensity and of none
    double angle_degrees = 0.0;                         // Sun: its angular diameter; 0: a point
    std::array<dvec3, 4> corners{};                     // Quad: as QuickQuad's; its front emits
    std::string file;                                   // Environment: latitude-longitude picture; relative to the shot
    char up = 'z';                                      // Environment: the world's axis at the picture's top
    double rotate_degrees = 0.0;                        // Environment: turns it about `up`, counter-clockwise
};

struct SceneSettings {
    std::vector<SceneFile> files;
    std::vector<QuickQuad> quads;
    std::vector<QuickSphere> spheres;
    std::vector<LightSettings> lights;
    std::string camera;               // of a file, by name; "": the first there is, where the shot gives no other
    double frames_per_second = 24.0;  // from frames to the seconds of the files' animations
    bool empty() const { return files.empty() && quads.empty() && spheres.empty() && lights.empty(); }
};

}  // namespace brisance
