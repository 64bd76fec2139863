// What a camera would see of a surveyed frame, roughly: enough to frame it and to choose strengths.
#pragma once

#include <span>
#include <vector>

#include "core/vec.h"
#include "first_look/survey.h"
#include "medium/settings.h"

namespace brisance {

// Axes of the picture. The camera is far along `back`.
struct ViewAxes {
    dvec3 right{1.0, 0.0, 0.0}, up{0.0, 0.0, 1.0}, back{0.0, -1.0, 0.0};
};

// From the front, slightly above and from the right, in a world with z up.
ViewAxes first_view();

// A cell in the world. Sorted from the camera on.
struct ViewCell {
    dvec3 position{0.0};
    double volume = 0.0;  // [m^3]
    SurveyCell cell;
};

struct View {
    std::vector<ViewCell> cells;
    double cell_metres = 0.0;
};

View make_view(const FrameSurvey& frame, const dmat4& world_from_file, const ViewAxes& axes);

// Mean of density times metres along the columns of the picture, weighted by itself: that of a ball of density 1 is
// three quarters of its diameter. 0 without smoke.
double column_depth(const View& view, const ViewAxes& axes);

// What is seen of each cell, without scattered light.
struct Seen {
    std::vector<double> weight;  // per cell: area that it covers or makes shine [m^2]
    double brightness = 0.0;     // of the picture's fire: mean luminance weighted by itself [W/(m^2 sr)]
    double opacity = 0.0;        // mean over the picture, weighted by itself [1]
};

// `medium`: with fire.strength 1 the brightness is that per strength.
Seen look_through(const View& view, const ViewAxes& axes, const MediumSettings& medium);

struct Framing {
    dvec3 eye{0.0}, target{0.0};
    double fill[2] = {0.0, 0.0};  // of the picture's width and height
};

// All but a small share of what is seen, of every frame, fills `fill` of the picture's width or height. Nothing where
// nothing is seen.
std::optional<Framing> frame_on(std::span<const View> views, std::span<const Seen> seen, const ViewAxes& axes,
                                double vertical_fov_degrees, double aspect, double fill);

}  // namespace brisance
