// Light between surfaces (SS) that Lambert bases and rough lobes reflect, shared among the pixels of a picture. Light
// of an even sky on bases (light_of_emitters.h) is shared likewise, and so is all other light that rough lobes reflect.
//
// A pixel has few paths and much noise, while the light that arrives at a matt surface from others changes slowly: over
// a distance that is a part of the distance to the surfaces around (G. Ward, F. Rubinstein, R. Clear, A Ray Tracing
// Solution for Diffuse Interreflection, SIGGRAPH 1988, on the split sphere). So each pixel takes the mean of what its
// neighbours found on the same surface, without its colour, weighted by area, by distance, by normals, and by how far
// they lie off the plane. Smoke counts as a surface as far as it hides what is behind it. Weights depend on the
// surfaces alone, never on the light: the mean keeps its energy but for what crosses edges, and a bright grain is
// divided among as many pixels as any other sample.
//
// A glossy lobe sees less of the surroundings: the distances over which its light changes are shorter by its width, and
// so are the differences of normals. Where the lobe is narrower than pixels, nothing is shared.
//
// The radius shrinks with the sixth root of the rays of a pixel, so that bias and noise go to zero together. Where
// surfaces are close, as in corners, it ends at about a pixel. Steps of 1, 4 and 16 pixels reach far with few
// neighbours each (H. Dammertz et al., Edge-Avoiding A-Trous Wavelet Transform for fast Global Illumination Filtering,
// HPG 2010). What noise is left then, as in corners, is told from light by two halves of the samples (noise_bands.h).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "pixel_sharing/patches.h"

namespace brisance {

class SharedBounce {
public:
    // Light that is shared by the same weights and told apart [W/(m^2 sr)]: a part of Sample::light, and what the lobe
    // reflects of other cells, which is no part of it.
    enum class Apart : std::uint8_t { Residual, SV, SM, SA };
    static constexpr std::size_t kAparts = 4;
    using Aparts = std::array<Rgb, kAparts>;

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
        Aparts apart{};          // as `light`
        float rays = 1.0f;       // of the pixel, for which the sample stands
        Rgb& of(Apart which) { return apart[std::size_t(which)]; }
        const Rgb& of(Apart which) const { return apart[std::size_t(which)]; }
        Rgb of_other_cells() const { return of(Apart::SV) + of(Apart::SM) + of(Apart::SA); }
        Rgb shown() const { return weight * (light + of_other_cells()); }  // by the pixel, of all cells
    };

    // `radius`: over the distance to surrounding surfaces, for 16 rays per pixel. `rays`: of a pixel. `told`: for what
    // told_pixels() is asked. `calms`: noise is told from light; otherwise what comes out is linear in the samples'
    // light.
    SharedBounce(int width, int height, double radius, int rays, std::vector<Apart> told = {}, bool calms = true);

    // Over how much pixels share: the radius over the distance to surrounding surfaces [rad].
    double angle(float lobe) const { return double(radius_) * lobe; }

    // That a picture with surfaces everywhere takes while it is shared, about: a pixel shows two lobes of a surface.
    // `told`: how many lights are told apart.
    static std::uint64_t bytes_of(int width, int height, std::size_t told = 0);

    // Samples of a pixel in any order that does not depend on threads. Not thread-safe. False: the pixel has samples of
    // too many surfaces already, and this one is not taken.
    bool add(const Sample& sample);

    // Radiance of each pixel. Uses up the samples.
    std::vector<Rgb> take_pixels();
    // After that: what comes from Sample::apart, of those told.
    std::vector<Rgb> told_pixels(Apart which) const;
    bool tells(Apart which) const;
    // After that, of all pixels and channels: the expected sum of squares of what noise leaves in take_pixels(), and in
    // told_pixels(); 0 where it is not told from light.
    double square_error() const { return square_errors_[0]; }
    double square_error(Apart which) const;

    // About how many pixels like this one share, where the mean of 1 / distance around it is `closeness` [1/m]; the
    // noise of a sample falls by the square root of that. Within the radius: before noise is told from light.
    float pixels_sharing(const Sample& at, float closeness) const;
    float pixels_within(const Sample& at, float closeness) const;

private:
    void take_means();
    // Calls take(neighbour, weight) for all patches within `radius` metres that lie `step` pixels apart.
    template <class Take>
    void for_neighbours(std::size_t pixel, const Patch& patch, float radius, int step, const Take& take) const;
    std::vector<float> radii() const;
    void share(const std::vector<float>& radius, int step);
    void take_noise();
    std::vector<Rgb> pixels(std::size_t kind) const;
    std::size_t kinds() const { return 1 + told_.size(); }
    std::size_t kind_of(Apart which) const;  // none: as many as there are

    float radius_;
    std::vector<Apart> told_;
    bool calms_;
    PatchMap map_;
    HalvedLight light_;  // Sample::light, then what is told
    // Of each patch, Sample::light and what is told, and over all pixels: after take_pixels().
    std::vector<Rgb> calm_;
    std::vector<double> square_errors_;
};

}  // namespace brisance
