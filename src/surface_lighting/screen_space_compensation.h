// What the bound of virtual point lights takes away, found among the surfaces that the picture shows.
//
// [1] J. Novak, T. Engelhardt, C. Dachsbacher, Screen-Space Bias Compensation for Interactive High-Quality Global
//     Illumination with Virtual Point Lights, I3D 2011.
//
// The rest that Kollig and Keller find by paths (virtual_lights/kinds/bounded_geometry.h), as an integral over surface:
//
//     T_r L(x) = f_r(x) integral of L(y) G(x, y) (1 - min(G, b) / G) dA(y)
//
// G - b is above 0 only within 1 / sqrt(b) metres of x, where most surface is seen together with x. So y runs over what
// pixels show, and L(y) is what they have found: direct light and bounded lights. L_0 = that, L_(k+1) = T_r L_k, and
// the picture gets L_1 + L_2 + ...
//
// Pixels form a pyramid of boxes with the mean position, normal and radiance of their surface, weighted by area. From x
// a node counts as one disc where it is small beside its distance and has one normal; else its children are looked at.
// A disc of area A sends by cos cos / (d^2 + A / pi), so that no single pixel sends more than all.
//
// It is biased: surface that is off screen, hidden or seen by mirrors gives nothing and gets nothing, L(y) is taken as
// alike in all directions, only Lambert bases receive, and nothing stands between x and y, be it surface or smoke.
//
// From [1] are the integral over pixels, hierarchical buffers and repeated rounds. How the pyramid is walked is not:
// sizes and distances in the scene decide, so that what is near in the scene but far on the screen counts as well.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"
#include "virtual_lights/settings.h"

namespace brisance {

class ScreenSpaceCompensation {
public:
    // A surface that one ray of a pixel meets.
    struct Sample {
        std::uint32_t pixel = 0;
        vec3 position{0.0f};  // local [m]
        vec3 normal{0.0f};    // unit, the shading normal, on the camera's side
        float area = 0.0f;    // of the surface, if the whole pixel shows it [m^2]
        Rgb light{0.0f};      // that it scatters toward the camera so far [W/(m^2 sr)]
        Rgb albedo{0.0f};     // of its Lambert base
        float share = 0.0f;   // of its light, what the pixel shows
    };

    // `settings`: the bound. `rays`: of a pixel.
    ScreenSpaceCompensation(int width, int height, const VirtualLightSettings& settings, int rays);

    // That a picture with surfaces everywhere takes, about: one surface in each pixel, and boxes around them.
    static std::uint64_t bytes_of(int width, int height);

    // In any order that does not depend on threads. Not thread-safe.
    void add(const Sample& sample);

    // What is to be added to each pixel [W/(m^2 sr)]. Uses up the samples.
    std::vector<Rgb> take_pixels();

private:
    static constexpr std::uint32_t kNone = ~0u;
    // The samples of a pixel on one surface: sums, then their means, but for `weight`.
    struct Patch {
        vec3 position{0.0f}, normal{0.0f};
        float area = 0.0f, samples = 0.0f;
        Rgb light{0.0f}, albedo{0.0f}, weight{0.0f};  // the pixel shows irradiance / pi times weight
        std::uint32_t next = kNone;                   // of the pixel
    };
    struct Node {
        vec3 low{0.0f}, high{0.0f};  // box around the positions
        vec3 centre{0.0f};           // mean position
        vec3 normal{0.0f};           // mean of unit normals: shorter where they differ
        float area = 0.0f;           // 0: shows no surface
        Rgb light{0.0f};
    };
    struct Level {
        int width, height;
        std::vector<Node> nodes;
    };
    struct Place {
        std::size_t level;
        int x, y;
    };
    struct Receiver;

    Patch& patch_of(const Sample& sample);
    void take_means();
    void build_levels();
    Node node_of_pixel(std::size_t pixel) const;
    Node node_of_children(const Level& below, int x, int y) const;
    std::vector<Rgb> irradiances() const;  // of each patch, over pi
    Rgb irradiance(const Receiver& at) const;
    template <class Take>
    void send_from(const Place& place, const Receiver& at, std::vector<Place>& open, const Take& take) const;
    template <class Visit>
    void for_patches(std::size_t pixel, const Visit& visit) const;

    VirtualLightSettings settings_;
    int width_, height_;
    float rays_;
    std::vector<std::uint32_t> first_;  // patch of each pixel
    std::vector<Patch> patches_;
    std::vector<Level> levels_;  // pixels first
};

}  // namespace brisance
