// What resampling has chosen at one vertex, in a form that other vertices can reuse.
//
// A sample is a light and two random numbers y = (light, u), u in [0, 1)^2: the light's kind makes a direction of u at
// any vertex (Kind::direction). All vertices thus have one space of samples with one measure, which is that of the
// random numbers: the density of a direction at a vertex, pdf(direction), becomes that of y by the factor
// |d direction / du| = 1 / pdf(direction). A vertex x wants the integral over all y of
//
//     F_x(y) = f_x(direction) / pdf_x(direction)    with f_x the light that it scatters from there
//
// and a vertex nearby that uses the same y needs no Jacobian (random replay: D. Lin et al., Generalized Resampled
// Importance Sampling: Foundations of ReSTIR, ACM Transactions on Graphics 41(4), 2022, section 4). The direction leads
// to about the same point of the light's sphere there.
#pragma once

#include <cstddef>

#include "transport/path_vertex.h"
#include "virtual_lights/bounded_light.h"

namespace brisance {

struct LightReservoir {
    std::size_t light = 0;
    glm::dvec2 numbers{0.0};
    // For any function g that is 0 where the vertex's target is, the mean of weight times g(y) is the integral of g.
    double weight = 0.0;  // 0: empty
    double target = 0.0;  // at the vertex that chose it
};

// Gatherers that resample.
class ReservoirLights {
public:
    virtual ~ReservoirLights() = default;

    // Chooses one of the vertex's candidates by its target. With settings.resampling_visibility the reservoir is empty
    // where that does not reach the vertex. Returns the part of the light that rays of the vertex have
    // found themselves [W/(m^2 sr)], by the balance heuristic; the target holds the weight of the rest.
    virtual Rgb fill(const PathVertex& vertex, LightReservoir& reservoir, Rng& rng) const = 0;
    // What the sample would add at the vertex if nothing stood between, luminance [W/(m^2 sr)].
    virtual double target(const LightReservoir& sample, const PathVertex& vertex) const = 0;
    // Whether surfaces let any of it through.
    virtual bool reaches(const LightReservoir& sample, const PathVertex& vertex) const = 0;
    // What it adds, times its weight, with exact visibility and transmittance [W/(m^2 sr)].
    virtual BoundedLight from_reservoir(const LightReservoir& sample, const PathVertex& vertex, Rng& rng) const = 0;
};

}  // namespace brisance
