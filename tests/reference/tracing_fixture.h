// Media with known answers, and rays into them.
#pragma once

#include <functional>
#include <memory>

#include "fixtures/estimate.h"
#include "fixtures/media.h"
#include "reference/path_tracer.h"

namespace brisance::testing {

// Plane-parallel layers along z, "infinite" across: voxels are 1 x 10^4 x 10^4 m. Density and flame by node, zero
// outside [1, nodes]; the linear ramp at either end holds half a node.
Recipe layers(int nodes, const std::function<float(int z)>& density, const std::function<float(int z)>& flame);

// A uniform layer of `nodes` nodes with source function 1 and that optical depth, exactly; an isothermal layer's light
// depends on nothing else.
Recipe slab(int nodes, double depth, const Rgb& albedo);

// A ray from z < 0 into the middle of layers, with cosine `mu` to their normal.
Ray ray_into_layers(double mu);

// The ball of glowing_ball, with albedo; and rays through its middle, in every direction.
Recipe scattering_ball(int nodes, double optical_radius, const Rgb& albedo);
Ray ray_through_middle(double u, double v);

// One of all the parallel rays through a disc of `radius` around the origin, for all directions: what leaves a body
// inside the ball of that radius is 4 pi^2 radius^2 times their mean radiance.
Ray ray_through_disc(double radius, double u, double v, Rng& rng);

// A medium and a tracer in it, which keep their places.
struct Traced {
    Traced(const Recipe& recipe, const TracingSettings& settings = {}, int bounces = -1);
    Traced(Medium m, const TracingSettings& settings = {}, int bounces = -1);

    // Writes what one path along `ray` brings, all orders, to out[0 ... 2].
    void look(const Ray& ray, double place, Rng& rng, double* out) const;

    std::unique_ptr<Medium> medium;
    PathTracer tracer;
};

// Power that the medium emits, 4 pi times the integral of j; the trilinear field's integral is the nodes' sum.
dvec3 emitted_power(const Medium& medium);

}  // namespace brisance::testing
