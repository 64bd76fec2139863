// Light that mirrors, glass and glossy surfaces, and surfaces that no virtual light covers, send into smoke, by
// particles.
//
// Virtual lights illuminate the medium as points with a cosine distribution (virtual_lights_as_points.h), which fits
// the base of a surface only, and no light lies on a mirror. Particles of fire and emitters are therefore traced. Where
// one meets a surface, the light reflected by lobes that the virtual lights do not hold is deposited along its track
// through the smoke: the nodes of the medium sum track length times transmitted power over the volume of a voxel, which
// is fluence (the track-length estimator; Spanier, Two Pairs of Families of Estimators for Transport Problems, SIAM J.
// Appl. Math. 14(4), 1966).
//
// Smoke fills a small part of what a surface sees. Each particle that meets one therefore sends light in two
// directions: one of the BSDF's lobes, and one toward a point of the smoke. The balance heuristic weights both (Veach,
// Robust Monte Carlo Methods for Light Transport Simulation, 1997, section 9.2.2.1). Most particles from infinity start
// toward the smoke and what is near it.
//
// Particles follow one another in rounds, each as many as all before it, until they are told that their light is known
// well enough: a room of haze needs millions, and what a floor sends into a flame is lost beside the fire.
//
// Unbiased up to the size of voxels; a voxel that surfaces cut is too dark.
#pragma once

#include <functional>

#include "gathering/gather.h"
#include "transport/cube_directions.h"
#include "virtual_lights/virtual_lights.h"

namespace brisance {

class SpecularPhotons {
public:
    // Keeps references. `lights`: the virtual lights that hold the rest; null: none. `share`: of what they hold, the
    // part that particles carry in their place, in [0, 1]. `samples`: of surfaces, of the whole picture: automatic
    // photons follow their number.
    SpecularPhotons(const DirectLight& scene, const VirtualLights* lights, const VirtualLightSettings& settings,
                    float share = 0.0f, double samples = 0.0);

    // Whether no surface reflects light that the virtual lights do not hold.
    bool empty() const { return particles_ == 0; }

    // Light at the nodes after some rounds, luminance of the fluence [W/m^2], and what it was before the last one, of
    // half as many particles: the root mean square of their difference is the standard error of all.
    struct Found {
        std::vector<float> by_all, by_half;
    };
    using Enough = std::function<bool(const Found&)>;
    struct Cast {
        Gathered light;
        std::size_t particles;
    };

    // Light at the needed nodes of the medium, planar over all nodes, as gather_at_nodes(). Sums are integers, and
    // so do not depend on the order. `medium`: the medium through which the light is traced, on the scene's own
    // lattice.
    // `share`: of the particles, in (0, 1], which carry all light. Those of another `set` are others: means of sets by
    // their shares have the noise of all particles. `enough`: empty, or may do with fewer, where the settings leave
    // their number open.
    Cast on(const Medium& medium, const LatticeRequest& request, float share = 1.0f, int set = 0,
            const Enough& enough = {}) const;

private:
    class Tracks;
    std::size_t particles(float share) const;
    void trace(std::size_t count, std::uint64_t first_stream, Tracks& tracks) const;
    void follow(std::uint64_t index, std::uint64_t stream, const Particles& particles, Tracks& tracks) const;
    void cast(const RaySegment& segment, const Rgb& power, Rng& rng, Tracks& tracks) const;
    void send(const Ray& ray, const Rgb& sent, const Rgb& arrived, Rng& rng, Tracks& tracks) const;

    const DirectLight& scene_;
    const VirtualLights* lights_;
    std::size_t particles_ = 0;  // that are worth while
    bool open_ = false;          // fewer may do
    CubeDirections smoke_;       // points that tracks are aimed at
    BoundingBall ball_;          // around everything
    BoundingBall around_smoke_;  // toward which particles start from infinity
    std::uint32_t seed_;
    float share_;
};

}  // namespace brisance
