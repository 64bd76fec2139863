// Ray lights with a radius: virtual beam lights (Novak, Nowrouzezahrai, Dachsbacher, Jarosz, Progressive Virtual Beam
// Lights, EGSR 2012). Every point v of a light stands for a ball of that radius around it, as virtual spherical lights
// do (Hasan, Krivanek, Walter, Bala, Virtual Spherical Lights for Many-Light Rendering of Glossy Scenes, SIGGRAPH Asia
// 2009): at a place w away, what is scattered at either end is not asked in the one direction between them, but in all
// that meet the ball:
//   f(direction) / w^2   becomes   1 / (pi r^2) * the integral of f over the cone around the ball.
// Neither 1 / w^2 nor a peak of f is then ever asked at a single place. Smoke and shadows between are those of the line
// between the two points, and the smoke at v is that of v.
//
// Departs from the latter: inside the ball the cone stays a half space, and is not the whole sphere. That makes the
// kernel continuous where a place enters the ball, and it is the one constant that keeps the energy: with solid angle
// 2 pi (1 - sqrt(1 - r^2 / w^2)) outside, the integral of solid angle / (pi r^2) over all space differs from that of
// 1 / w^2 by -8 pi r / 3 outside the ball plus (4 r / 3) * the solid angle inside, which is 0 for 2 pi. The whole
// sphere would add 8 pi r / 3: a bias that grows like r. Cones are symmetric about the line between, so that over a
// shell of places around v no f is lost either, and what remains is of the order r^2. At surfaces the part of a cone
// that dips under the tangent plane is folded up, so that it is not lost: by reflection about that plane every line
// through the ball is met once, as before.
//
// Progression: the blur is over directions, of two dimensions. A sample's variance grows like one over the solid angle
// that it is spread over, 1 / r^2, as the area pi r^2 in the kernel says, whatever the medium; along the light nothing
// is blurred. By Knaus and Zwicker (Progressive Photon Mapping: A Probabilistic Approach, TOG 2011), whose k is that
// dimension, r_{i+1}^2 = r_i^2 (i + alpha) / (i + 1): the bias of the mean over n passes then vanishes like
// n^(alpha - 1), and its variance like n^-alpha.
//
// What that bounds: at surfaces the variance, whatever BSDF and phase function. Along rays of the camera 1 / w^2 and
// one of the two phase functions: where a light happens to run as the ray does, what hardly turns at v nor at u passes
// both peaks, and that still grows like 1 / (1 - g)^2, as directions of lights are not blurred.
#pragma once

#include "core/rng.h"
#include "core/vec.h"
#include "geometry/surface_point.h"
#include "light_selection/gloss_split.h"

namespace brisance {

// The directions from a place that meet a ball, seen along any of them or against it.
class BallCone {
public:
    // `axis`: unit, between the place and the ball's middle; `distance` > 0 and `radius` >= 0 [m].
    BallCone(const dvec3& axis, double distance, double radius);

    const dvec3& axis() const { return axis_; }
    // In place of 1 / distance^2 [1/m^2]: the solid angle over pi radius^2, or what that becomes without a radius.
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

// The mean over the cone of the product of two phase functions [1/sr^2]: of light that travels along `arriving`, turns
// into the cone, whose axis is the way of light, and from there to `leaving`. Three directions share it by the balance
// heuristic, a few of each: of the cone, and of either phase function. Exact without a radius, and where mean_cosine is
// 0.
double mean_phases(const BallCone& cone, const dvec3& arriving, const dvec3& leaving, double mean_cosine, Rng& rng);

// The mean over the cone, whose axis leads from the surface to the light, of phase function times BSDF times cosine
// [1/sr^2]. `arriving`: the way of the light before it is scattered toward the surface. Three directions share it: of
// the cone, of the BSDF and of the phase function. What lobes share with rays is so much less sharp that it needs none
// of its own.
Rgb mean_reflected(const BallCone& cone, const dvec3& arriving, double mean_cosine, const SurfacePoint& point,
                   const AskedLobes& lobes, const dvec3& toward_viewer, Rng& rng);

// The radius of a pass, from 0, over that of the first.
double radius_shrunk(int pass, double alpha);

}  // namespace brisance
