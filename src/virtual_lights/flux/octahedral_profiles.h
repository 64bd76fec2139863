// Directional profiles of rich lights: from light that arrived by direction to light that is reflected by direction.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "virtual_lights/flux/photon_splitting.h"

namespace brisance {

// Of the power that arrived at light `index`, what the Lambert base of its material reflects [W].
Rgb base_flux(const VirtualLight& light, std::size_t index, const LightAccounts& accounts, int resolution);

// The radiance that lights with profiles reflect, by direction in the light's own frame (octahedral_map.h).
class Profiles {
public:
    Profiles() = default;
    // Of the lights that have one (profile >= 0, numbered in order). Rounds their materials a little, so that lights of
    // similar materials share tables of reflection; base colours of what is no metal stay as they are.
    Profiles(std::span<VirtualLight> lights, const LightAccounts& accounts, int resolution);

    // Between texels linear [W/(m^2 sr)]. `toward`: unit, world.
    Rgb radiance(const VirtualLight& light, const dvec3& toward) const;

    // The number of equal photons whose mean would vary as much as the radiance along a direction does: of those that
    // arrived N E[f]^2 / E[f^2], f the BSDF between the direction and those of photons from everywhere alike. All N for
    // a Lambert surface, about 12 alpha^2 N for a narrow lobe. `cosine`: of the direction to the light's normal.
    static constexpr int kCosines = 8;
    struct Behind {
        double photons = 0.0, one = 0.0;  // and what one photon of the light adds to them
    };
    Behind photons_behind(const VirtualLight& light, double cosine) const;

    // Means of f and f^2: of the coat, of a white base beside it, and their product. A metal is all coat.
    struct MomentsOfCosine {
        double coat = 0.0, base = 0.0, coat_square = 0.0, base_square = 0.0, product = 0.0;
    };
    using Moments = std::array<MomentsOfCosine, kCosines>;  // by cosine, in even steps

    // Reflected power over area [W/m^2], and the largest radiance.
    Rgb exitance(const VirtualLight& light) const;
    float brightest(const VirtualLight& light) const;

    // Texels along a side of each map, 0 without any, and one light's map in rows (octahedral_map.h) [W/(m^2 sr)].
    int resolution() const { return static_cast<int>(side_); }
    std::span<const Rgb> map(const VirtualLight& light) const { return {map_of(light), side_ * side_}; }

    std::uint64_t bytes() const { return texels_.size() * sizeof(Rgb); }

private:
    const Rgb* map_of(const VirtualLight& light) const {
        return texels_.data() + static_cast<std::size_t>(light.profile) * side_ * side_;
    }

    std::size_t side_ = 0;
    std::vector<Rgb> texels_;
    std::vector<Moments> moments_;  // of materials
    struct Arrived {
        double photons = 0.0, one = 0.0;
        std::size_t material = 0;  // of moments_
    };
    std::vector<Arrived> arrived_;  // by profile
};

}  // namespace brisance
