// How many times light scatters, and how orders of scattering above the first are solved.
#pragma once

namespace brisance {

// What makes the light of one bounce on the coarse lattice, or of all.
enum class ScatteringSolver {
    Hierarchy,         // of lights, with shadow maps
    RadianceCascades,  // of probes (radiance_cascades.h)
    Diffusion          // all bounces at once (diffusion.h)
};

struct ScatteringSettings {
    int bounces = -1;         // scatterings: 0 emission only, 1 single scattering, -1 all orders
    float remainder = 1e-3f;  // with all orders: stop when the part not yet accounted for is below this
    int lattice_level = -1;   // orders above one are solved on voxels 2^level wide; -1: as the error allows
    float escape = -1.0f;     // the mean escape probability by which methods are chosen; below 0: the medium's own
    int fine_bounces = -1;    // on the light's own lattice, after those on a coarser one; -1: one, as the error allows
    float alpha = 1.5f;       // as LightingSettings::alpha, for scattered light
    ScatteringSolver solver = ScatteringSolver::Hierarchy;
    int cascade_side = 8;      // side^2 directions at the nodes, with radiance cascades
    bool flux_limiter = true;  // with diffusion: DiffusionSettings::flux_limiter
};

inline int count_of_fine_bounces(const ScatteringSettings& settings) {
    return settings.fine_bounces < 0 ? 1 : settings.fine_bounces;
}

// Settings without fine bounces where there are none: orders that are kept apart, or end at the second, are gathered on
// the light's own lattice anyway, and diffusion stands for all bounces.
inline ScatteringSettings settings_of_orders(ScatteringSettings settings, bool apart) {
    if (apart || settings.bounces == 2 || settings.solver == ScatteringSolver::Diffusion)
        settings.fine_bounces = 0;
    return settings;
}

}  // namespace brisance
