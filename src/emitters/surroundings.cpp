#include "emitters/surroundings.h"

#include "surfaces/energy_tables.h"

namespace brisance {

namespace {

std::vector<const Texture*> pointers_to(const std::vector<Texture>& pictures) {
    std::vector<const Texture*> out;
    out.reserve(pictures.size());
    for (const Texture& picture : pictures)
        out.push_back(picture.width > 0 ? &picture : nullptr);
    return out;
}

}  // namespace

Surroundings::Surroundings(Scene scene, std::vector<LightSettings> lights, std::vector<Texture> pictures)
    : scene_(std::move(scene)),
      lights_(std::move(lights)),
      pictures_(std::move(pictures)),
      intersector_(scene_),
      emitters_(intersector_, lights_, pointers_to(pictures_)) {
    // Computes the tables now, before threads use them concurrently.
    for (const SceneMaterial& material : scene_.materials) {
        if (needs_energy_tables(material.surface))
            energy_tables(material.surface.ior);
        if (needs_interface_tables(material.surface))
            interface_tables(material.surface.ior);
    }
}

}  // namespace brisance
