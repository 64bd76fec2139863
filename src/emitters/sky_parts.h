// An environment in parts, each a light at infinity: rectangles of its picture that send about the same irradiance.
//
// Parts are divided where they are brightest, in halves along their longer side, down to single texels. A direction of
// a part is drawn evenly over its solid angle.
#pragma once

#include <vector>

#include "emitters/environment.h"

namespace brisance {

struct SkyPart {
    // Of the picture: columns from `left` to `right`, rows from `top` to `bottom`, without the last.
    int left = 0, right = 0, top = 0, bottom = 0;
    double irradiance = 0.0;      // of a plane that faces each direction, luminance [W/m^2]
    dvec3 toward{0.0, 0.0, 1.0};  // unit: of a cone around all its directions ...
    double spread = 0.0;          // ... and of its half angle
};

class SkyParts {
public:
    // Up to `most` of them. Keeps a reference.
    SkyParts(const Environment& environment, std::size_t most);

    const std::vector<SkyPart>& parts() const { return parts_; }
    // A unit vector, from two numbers in [0, 1).
    dvec3 sample(const SkyPart& part, double u, double v) const;
    double solid_angle(const SkyPart& part) const;  // [sr]

private:
    double light_between(int left, int right, int top, int bottom) const;
    SkyPart part_of(int left, int right, int top, int bottom) const;
    bool halves(const SkyPart& part, SkyPart& first, SkyPart& second) const;
    double polar(int row) const;

    const Environment& environment_;
    int width_, height_;
    double even_ = 0.0;         // added to the luminance everywhere: dark texels next to bright ones are lit by them
    std::vector<double> sums_;  // luminance times solid angle of all texels above and to the left
    std::vector<SkyPart> parts_;
};

}  // namespace brisance
