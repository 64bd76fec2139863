// Ray lights with a radius: virtual beam lights (Novak, Nowrouzezahrai, Dachsbacher, Jarosz, Progressive Virtual Beam
// Lights, EGSR 2012). Every point v of a light stands for a ball of that radius around it, as in virtual spherical
// lights (Hasan, Krivanek, Walter, Bala, Virtual Spherical Lights for Many-Light Rendering of Glossy Scenes, SIGGRAPH
// Asia 2009). For a point at the distance w, the scattering functions at either end are not evaluated in the one
// direction between the points, but averaged over all directions that meet the ball:
//   f(direction) / w^2   becomes   1 / (pi r^2) * the integral of f over the cone around the ball.
// Neither 1 / w^2 nor a peak of f is then evaluated at a single point. Transmittance and visibility are those of the
// line between the two points, and the smoke at v is that of v.
//
// Departs from the latter: inside the ball the cone remains a half space instead of the whole sphere. This makes the
// kernel continuous at the boundary of the ball, and it is the one constant that conserves energy. With solid angle 2
// pi (1 - sqrt(1 - r^2 / w^2)) outside, the integral of solid angle / (pi r^2) over all space differs from that of 1 /
// w^2 by -8 pi r / 3 outside the ball plus (4 r / 3) * the solid angle inside, which is 0 for 2 pi. The whole sphere
// would add 8 pi r / 3: a bias that grows like r. Cones are symmetric about the line between the points, so that no f
// is lost over a shell of points around v, and the remaining bias is of the order r^2. At surfaces the part of a cone
// below the tangent plane is reflected about that plane, so that it is not lost: every line through the ball is still
// met once.
//
// Progression: the blur is over directions, which have two dimensions. The variance of a sample grows like one over the
// solid angle of the blur, 1 / r^2, as the area pi r^2 in the kernel shows, whatever the medium; nothing is blurred
// along the light. By Knaus and Zwicker (Progressive Photon Mapping: A Probabilistic Approach, TOG 2011), whose k is
// that dimension, r_{i+1}^2 = r_i^2 (i + alpha) / (i + 1): the bias of the mean over n passes then vanishes like
// n^(alpha - 1), and its variance like n^-alpha.
//
// What is bounded: at surfaces the variance, for every BSDF and phase function; along rays of the camera 1 / w^2 and
// one of the two phase functions. Where a light is nearly parallel to the ray, light that is hardly deflected at v or u
// passes both peaks. That contribution still grows like 1 / (1 - g)^2, as the directions of lights are not blurred.
#pragma once

#include "core/rng.h"
#include "core/vec.h"
#include "geometry/surface_point.h"
#include "light_selection/gloss_split.h"

namespace brisance {

// The cone of directions between a point and a ball.
class BallCone {
public:
    // `axis`: unit, along the line through the point and the ball's centre; `distance` > 0 and `radius` >= 0 [m].
    BallCone(const dvec3& axis, double distance, double radius);

    const dvec3& axis() const { return axis_; }
    // Replaces 1 / distance^2 [1/m^2]: the solid angle over pi radius^2, or its limit for a radius of 0.
    double kernel() const { return kernel_; }
    double solid_angle() const;  // [sr]
    bool thin() const { return !(one_minus_cosine_ > 0.0); }
    bool holds(const dvec3& direction) const;
    dvec3 sample(Rng& rng) const;  // uniform; unit

private:
    dvec3 axis_;
    double one_minus_cosine_;  // of half the opening
    double kernel_;
};

// The mean over the cone of the product of two phase functions [1/sr^2]: light travels along `arriving`, scatters into
// the cone, whose axis is its direction of travel, and from there to `leaving`. Three sampling densities are combined
// by the balance heuristic, with a few samples each: the cone, and either phase function. Exact for a radius of 0, and
// where mean_cosine is 0.
double mean_phases(const BallCone& cone, const dvec3& arriving, const dvec3& leaving, double mean_cosine, Rng& rng);

// The mean over the cone, whose axis points from the surface to the light, of phase function times BSDF times cosine
// [1/sr^2]. `arriving`: the direction of travel of the light before it scatters toward the surface. Three sampling
// densities are combined: the cone, the BSDF and the phase function. The lobes shared with rays are so much less sharp
// that they need no density of their own.
Rgb mean_reflected(const BallCone& cone, const dvec3& arriving, double mean_cosine, const SurfacePoint& point,
                   const ReceiverLobes& lobes, const dvec3& toward_viewer, Rng& rng);

}  // namespace brisance
