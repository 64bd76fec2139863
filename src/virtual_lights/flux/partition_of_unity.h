// A partition of unity over surfaces: which virtual lights cover a point, and with what weight.
//
// Weights fall off from a light to the edge of its sphere and sum up to 1 wherever there is any light. The same weights
// divide a photon among lights and interpolate between lights what they received. A constant irradiance is therefore
// reproduced as a constant, at the edges of surfaces too, where kernels of fixed area would darken. The weight of a
// light that fades is multiplied by its share, so that the others take over continuously.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "virtual_lights/virtual_light.h"

namespace brisance {

struct LightShares {
    static constexpr int kMost = 8;
    int count = 0;  // 0: no light covers the point
    std::array<std::uint32_t, kMost> light;
    std::array<float, kMost> weight;  // their sum is 1
};

// A hierarchy of boxes around the lights' spheres.
class PartitionOfUnity {
public:
    PartitionOfUnity() = default;
    // Keeps a reference to the surfaces.
    PartitionOfUnity(const Intersector& surfaces, std::span<const VirtualLight> lights);

    // `normal`: unit, on the lit side. Only lights on the same material that face about the same way count, with
    // nothing in between: an object that stands on a surface hides the surface below it, which no photon reaches, from
    // the lights around.
    LightShares shares(const dvec3& position, const dvec3& normal, int scene_material) const;

    std::uint64_t bytes() const { return nodes_.size() * sizeof(Node) + spheres_.size() * sizeof(Sphere); }

private:
    struct Sphere {
        vec3 centre;
        float radius;
        float share;
        vec3 normal;
        std::int32_t scene_material;
        std::uint32_t light;
    };
    struct Node {
        vec3 low, high;
        std::uint32_t first;  // of its spheres, or the right child; the left one comes next
        std::uint32_t count;  // 0: no leaf
    };
    void build(std::span<const VirtualLight> lights, std::span<Sphere> spheres, std::size_t first);

    bool hidden(const Sphere& sphere, const vec3& position, const vec3& normal) const;

    const Intersector* surfaces_ = nullptr;
    std::vector<Sphere> spheres_;
    std::vector<Node> nodes_;
};

}  // namespace brisance
