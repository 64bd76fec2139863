// Through mirrors and clear glass, to the first surface that scatters.
//
// What stands there is lit as if the camera saw it itself, by grids and virtual lights, and so is the smoke on the way:
// a path that goes on from a mirror would draw one line toward the fire for all of that.
#pragma once

#include "camera_rays/picture.h"
#include "surface_lighting/medium_along_ray.h"

namespace brisance {

// Whom to light in the place of what a ray of the camera met.
struct BehindMirrors {
    SurfacePoint point;
    dvec3 arriving{0.0};  // unit: the direction in which the ray meets it
    Rgb throughput{1.0f};
    int mirrors = 0;    // on the way
    bool lost = false;  // nothing stands there, or nothing of it arrives
};

class Mirrors {
public:
    // Keeps references. `beyond`: whether anything is wanted of surfaces behind mirrors (cell SS).
    Mirrors(const DirectLight& scene, const MediumAlongRay& medium, bool beyond)
        : scene_(scene), medium_(medium), beyond_(beyond) {}

    // From a surface that `sample` met. What the first mirror shows of the medium (SV, SM) and of emitters (SA), and
    // what later ones show of both (SS), is added to `light`; what the last surface scatters is SS, too. At each
    // mirror one way is drawn.
    BehindMirrors follow(const SurfaceSample& sample, const SurfacePoint& point, Rng& medium_rng, CellSum& light) const;

private:
    const DirectLight& scene_;
    const MediumAlongRay& medium_;
    bool beyond_;
};

}  // namespace brisance
