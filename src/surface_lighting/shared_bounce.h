// Light between surfaces (SS) that Lambert bases and rough lobes reflect, shared among the pixels of a picture. Light
// of an even sky on bases (light_of_emitters.h) is shared likewise.
//
// A pixel has few paths and much noise, while the light that arrives at a matt surface from others changes slowly: over
// a distance that is a part of the distance to the surfaces around (G. Ward, F. Rubinstein, R. Clear, A Ray Tracing
// Solution for Diffuse Interreflection, SIGGRAPH 1988, on the split sphere). So each pixel takes the mean of what its
// neighbours found on the same surface, without its colour, weighted by area, by distance, by normals, and by how far
// they lie off the plane. Weights depend on the surfaces alone, never on the light: the mean keeps its energy but for
// what crosses edges, and a bright grain is divided among as many pixels as any other sample.
//
// A glossy lobe sees less of the surroundings: the distances over which its light changes are shorter by its width, and
// so are the differences of normals. Where the lobe is narrower than pixels, nothing is shared.
//
// The radius shrinks with the sixth root of the rays of a pixel, so that bias and noise go to zero together. Where
// surfaces are close, as in corners, it ends at about a pixel. Steps of 1, 4 and 16 pixels reach far with few
// neighbours each (H. Dammertz et al., Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination Filtering,
// HPG 2010).
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace brisance {

class SharedBounce {
public:
    // What one path found.
    struct Sample {
        std::uint32_t pixel = 0;
        vec3 position{0.0f};     // local [m]
        vec3 normal{0.0f};       // unit, the shading normal
        float pixel_size = 0.0;  // of the picture at the point [m]
        float area = 0.0f;       // of the surface that the pixel shows, as far as it shows this one [m^2]
        float lobe = 1.0f;       // width of the lobe: 1 for a base, less for others
        Rgb light{0.0f};         // radiance that the lobe reflects, over its colour [W/(m^2 sr)]
        Rgb weight{0.0f};        // the pixel shows light times weight
        float closeness = 0.0f;  // inverse distance of the surface that the path met first; 0: none [1/m]
        Rgb residual{0.0f};      // a part of `light` that is shared likewise, and told apart
    };

    // `radius`: over the distance to surrounding surfaces, for 16 rays per pixel. `rays`: of a pixel. `tells_residual`:
    // residual_pixels() is asked for.
    SharedBounce(int width, int height, double radius, int rays, bool tells_residual = false);

    // That a picture with surfaces everywhere takes while it is shared, about: a pixel shows two lobes of a surface.
    static std::uint64_t bytes_of(int width, int height, bool tells_residual = false);

    // Samples of a pixel in any order that does not depend on threads. Not thread-safe. False: the pixel has samples of
    // too many surfaces already, and this one is not taken.
    bool add(const Sample& sample);

    // Radiance of each pixel. Uses up the samples.
    std::vector<Rgb> take_pixels();
    // After that: the part of it that comes from Sample::residual.
    std::vector<Rgb> residual_pixels() const;

private:
    // The samples of a pixel that lie on one surface, of lobes of one width: sums, then their means, but for `weight`.
    struct Patch {
        vec3 position{0.0f}, normal{0.0f};
        float pixel_size = 0.0f, area = 0.0f, lobe = 0.0f;
        Rgb light{0.0f}, weight{0.0f};
        float closeness = 0.0f, met = 0.0f;  // and how many samples met a surface
        float samples = 0.0f;
        std::uint32_t next = kNone;  // of the pixel
    };
    static constexpr std::uint32_t kNone = ~0u;

    void take_means();
    // Calls take(neighbour, weight) for all patches within `radius` metres that lie `step` pixels apart.
    template <class Take>
    void for_neighbours(std::size_t pixel, const Patch& patch, float radius, int step, const Take& take) const;
    std::vector<float> radii() const;
    void share(const std::vector<float>& radius, int step);
    template <class Visit>
    void for_each_patch(const Visit& visit) const;  // visit(pixel, patch), in parallel

    int width_, height_;
    float radius_;
    bool tells_residual_;
    std::vector<std::uint32_t> first_;  // patch of each pixel
    std::vector<Patch> patches_;
    std::vector<Rgb> residual_;  // of each patch, as Patch::light; empty: not told
};

}  // namespace brisance
