// Follows rays through mirrors and clear glass to the first surface that scatters.
//
// That surface is lit by grids and virtual lights, as if the camera saw it directly, and so is the smoke along the ray.
// A path continued from the mirror would instead sample a single line toward the fire for all of that light. The same
// holds for narrow lobes: what a puddle shows of a wall is lit as that wall is.
#pragma once

#include "camera_rays/picture.h"
#include "surface_lighting/medium_along_ray.h"

namespace brisance {

// The surface point to shade instead of the one that the camera ray hit.
struct BehindMirrors {
    SurfacePoint point;
    dvec3 arriving{0.0};  // unit: direction of the ray that reaches the point
    Rgb throughput{1.0f};
    int mirrors = 0;    // along the path
    bool lost = false;  // no surface was found, or none of its light arrives
};

// Whether a surface has lobes beside its base that are too narrow for virtual lights, and nothing passes through it.
// Deltas are among them.
bool has_narrow_lobes(const SurfaceMaterial& m);

class Mirrors {
public:
    // Keeps references. `beyond`: light of surfaces behind mirrors (cell SS) is needed. `samples`: rays of a pixel.
    // `through_panes`: the caller lights surfaces by what of the medium is seen straight through panes. Other seeds
    // draw other numbers.
    Mirrors(const DirectLight& scene, const MediumAlongRay& medium, bool beyond, int samples, bool through_panes,
            std::uint32_t seed = 0)
        : scene_(scene),
          medium_(medium),
          beyond_(beyond),
          samples_(samples),
          through_panes_(through_panes),
          seed_(seed) {}

    // Starts at a surface that `sample` hit. Adds to `light` the medium (SV, SM) and the emitters (SA) seen in the
    // first mirror; those seen in later mirrors count as SS, as does the light that the last surface scatters. One
    // direction is sampled at each mirror.
    BehindMirrors follow(const SurfaceSample& sample, const SurfacePoint& point, Rng& medium_rng, CellSum& light) const;

    // From a surface whose other lobes are narrow: the first surface that scatters where one of their directions leads.
    // Adds what mirrors on the way show (SS). The medium and the emitters that the lobes see themselves are not part of
    // it. Lost as well where something else ends the ray, and where too little of the light arrives.
    BehindMirrors reflected(const SurfaceSample& sample, const BehindMirrors& from, Rng& medium_rng,
                            CellSum& light) const;

private:
    void go_on(BehindMirrors& at, bool seen_by_first, Rng& rng, Rng& medium_rng, CellSum& light) const;

    const DirectLight& scene_;
    const MediumAlongRay& medium_;
    bool beyond_;
    int samples_;
    bool through_panes_;
    std::uint32_t seed_;
};

}  // namespace brisance
