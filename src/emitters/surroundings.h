// The surroundings of a frame: surfaces, their ray-tracing hierarchy, and all light sources except the fire.
#pragma once

#include "emitters/emitters.h"
#include "geometry/intersector.h"
#include "scene/scene.h"

namespace brisance {

class Surroundings {
public:
    // `pictures`: per light, of environments that have one; else empty. Computes the tables of the materials.
    Surroundings(Scene scene, std::vector<LightSettings> lights, std::vector<Texture> pictures = {});

    const Scene& scene() const { return scene_; }
    const Intersector& intersector() const { return intersector_; }
    const Emitters& emitters() const { return emitters_; }
    bool has_surfaces() const { return !intersector_.empty(); }
    std::uint64_t bytes() const { return scene_.bytes() + intersector_.bytes() + emitters_.bytes(); }

private:
    Scene scene_;
    std::vector<LightSettings> lights_;
    std::vector<Texture> pictures_;
    Intersector intersector_;
    Emitters emitters_;
};

}  // namespace brisance
