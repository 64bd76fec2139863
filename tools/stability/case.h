// One case of the stability matrix: what is rendered, what it ought to be, and how near is near enough.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emitters/surroundings.h"
#include "media/node_media.h"
#include "render/render_frame.h"
#include "stability/methods.h"

namespace brisance::stability {

// A medium, the surfaces and lamps around it if any, and a shot whose camera looks at them. The method is filled in by
// whoever renders.
struct Scene {
    Medium medium;
    Shot shot;
    std::shared_ptr<const Surroundings> surroundings = nullptr;
};

// How far a picture is from what it ought to be, both as parts of the latter.
struct Measured {
    double error = 0.0;
    double noise = 0.0;  // standard error of `error`, where the method or the reference is random
};

// Of a method that shares its noise, `image` is the mean of the pictures in `halves`, each by lights of its own.
using Render = std::function<RenderedFrame(const Scene&, const Method&)>;
using Measure = std::function<Measured(const Scene&, const RenderedFrame&, const Method&, const Render&)>;

// A method that a case is beyond: how wrong it may be there at most, and why.
struct Limit {
    double tolerance = 0.0;
    std::string reason;
};

struct Tolerance {
    std::optional<double> lighting_grid, path;  // empty: the method does not render this case
    std::string reason;                         // why no smaller
    std::map<std::string, Limit> limits = {};   // by the method's name, instead of those above
};

struct Case {
    std::string name;   // family/what
    std::string truth;  // what the picture is held against
    Tolerance tolerance;
    std::function<Scene()> scene;
    Measure measure;
    bool quick = false;  // of the subset that every test run renders

    std::string family() const { return name.substr(0, name.find('/')); }

    // Empty: the method does not render this case. Of methods that own MM and SM, what they leave of the picture is the
    // grid's, so that they are as wrong as it is where they are not worse.
    std::optional<double> tolerance_of(const Method& method) const;
    const Limit* limit_of(const Method& method) const;
};

// Whether the method has a part in the case: the lighting grid and the path tracer always, others where they own a
// cell.
bool owns_a_cell(const Method& method, const Scene& scene);

// Measures. Pictures of the lighting grid have no noise and are judged by the relative L2 distance over all pixels;
// those of the others, and of the grid where there are surfaces or emitters, which are sampled, by the relative error
// of their mean. Its standard error comes from the path tracer's two halves, from pictures by other lights, or from the
// spread of pixels that are sampled independently.

// All pixels of `layer` ought to have this radiance.
Measure every_pixel_is(const Rgb& radiance, const std::string& layer = "");

// Each pixel of `layer` ought to have the radiance of the ray through its middle; origin and direction in world space.
using RadianceOfRay = std::function<double(const dvec3& origin, const dvec3& direction)>;
Measure every_ray_is(const RadianceOfRay& radiance, const std::string& layer = "");

// Like the picture of another scene by the same method, or the same path by path: noise is no excuse then.
Measure same_picture_as(const std::function<Scene()>& other);
Measure same_paths_as(const std::function<Scene()>& other);

// Power through the picture, times 4 pi: for media seen from afar that look the same from everywhere. `power` is over
// 4 pi [W/sr].
Measure power_is(const std::function<double(const Scene&)>& power);

// Like the path tracer's picture, of this many paths per pixel; the path tracer itself is held against its other
// estimators (null collisions, ratio tracking, emission at collisions).
Measure like_the_reference(int samples);

// The families.
std::vector<Case> depth_cases();
std::vector<Case> albedo_cases();
std::vector<Case> phase_cases();
std::vector<Case> contrast_cases();
std::vector<Case> emission_cases();
std::vector<Case> scale_cases();
std::vector<Case> lattice_cases();
std::vector<Case> shadow_cases();
std::vector<Case> camera_cases();
std::vector<Case> light_cases();
std::vector<Case> surface_cases();

std::vector<Case> all_cases();

}  // namespace brisance::stability
