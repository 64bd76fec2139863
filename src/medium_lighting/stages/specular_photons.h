// What mirrors, glass and glossy surfaces cast on smoke, and surfaces that no virtual light speaks for: by particles.
//
// Virtual lights shine on the medium as points of Lambert's lobe (virtual_lights_as_points.h): as blunt as the base of
// a surface, and no light lies on a mirror. So particles of fire and emitters are followed, and wherever one meets a
// surface, what the lobes that lights do not hold send on is laid down along its way through the smoke: the medium's
// nodes count the length of ways times power, transmitted, over the volume of a voxel, which is fluence (the
// track-length estimator; Spanier, Two Pairs of Families of Estimators for Transport Problems, SIAM J. Appl. Math.
// 14(4), 1966).
//
// Unbiased up to the size of voxels, a part of which surfaces may cut off: there it is dimmed.
#pragma once

#include "gathering/gather.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

class SpecularPhotons {
public:
    // Keeps references. `lights`: who holds the rest; null: nobody.
    SpecularPhotons(const DirectLight& scene, const VirtualLights* lights, const VirtualLightSettings& settings);

    // No surface reflects what lights do not hold.
    bool empty() const { return particles_ == 0; }
    std::size_t particles() const { return particles_; }

    // At the nodes of the medium that ask, planar over them, as gather_from_outside(). Sums are integers, the same in
    // any order. `medium`: through which the light is followed, on the scene's own lattice.
    Gathered on(const Medium& medium, const LatticeRequest& request) const;

private:
    class Ways;
    void follow(std::uint64_t index, const Particles& particles, Ways& ways) const;
    void cast(const RaySegment& segment, const Rgb& power, Rng& rng, Ways& ways) const;

    const DirectLight& scene_;
    const VirtualLights* lights_;
    std::size_t particles_ = 0;
    std::uint32_t seed_;
};

}  // namespace brisance
