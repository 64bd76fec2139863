// One case of the stability matrix: a scene, its true result, and a tolerance.
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

// A medium, the surfaces and lamps around it if any, and a shot whose camera looks at them. The caller that
// renders sets the method.
struct Scene {
    Medium medium;
    Shot shot;
    std::shared_ptr<const Surroundings> surroundings = nullptr;
};

// The error of a picture and its uncertainty, relative to the truth.
struct Measured {
    double error = 0.0;
    double noise = 0.0;  // standard error of `error`, where the method or the reference is random
};

// For a method that shares its noise, `image` is the mean of the pictures in `halves`, each by lights of its own.
using Render = std::function<RenderedFrame(const Scene&, const Method&)>;
using Measure = std::function<Measured(const Scene&, const RenderedFrame&, const Method&, const Render&)>;

// The limit of a method that cannot solve a case: its largest error there, and the reason.
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
    std::string truth;  // what the picture is compared with
    Tolerance tolerance;
    std::function<Scene()> scene;
    Measure measure;
    bool quick = false;  // of the subset that every test run renders
    // Whether light is scattered more than once, so that the methods that share their noise own a cell.
    bool scatters_twice = true;
    // Of a method that shares its noise: their mean is judged, and their spread is its noise. Pictures that ought to be
    // the same number by number have no noise, and one of them is enough.
    int pictures = 4;
    std::map<std::string, int> paths = {};  // particles, by the method's name, where fewer will do

    std::string family() const { return name.substr(0, name.find('/')); }

    // Empty: the method does not render this case. Methods that own MM and SM take the rest of the picture from the
    // grid, so that the grid's tolerance is a lower bound of theirs.
    std::optional<double> tolerance_of(const Method& method) const;
    std::optional<int> paths_of(const Method& method) const;
    const Limit* limit_of(const Method& method) const;
};

// Whether the method contributes to the case: the lighting grid and the path tracer always, others where they own a
// cell.
bool owns_a_cell(const Method& method, const Scene& scene);

// Measures. Pictures of the lighting grid have no noise and are judged by the relative L2 distance over all pixels;
// those of the others, and of the grid where there are surfaces or emitters, which are sampled, by the relative error
// of their mean. Its standard error comes from the path tracer's two halves, from pictures by other lights, or from the
// spread of pixels that are sampled independently.

// Expects this radiance in all pixels of `layer`.
Measure every_pixel_is(const Rgb& radiance, const std::string& layer = "");

// Expects in each pixel of `layer` the radiance of the ray through its centre; origin and direction in world space.
using RadianceOfRay = std::function<double(const dvec3& origin, const dvec3& direction)>;
Measure every_ray_is(const RadianceOfRay& radiance, const std::string& layer = "");

// Expects the picture of another scene by the same method. same_paths_as() allows no noise: both have the same paths.
Measure same_picture_as(const std::function<Scene()>& other);
Measure same_paths_as(const std::function<Scene()>& other);

// Expects this power through the picture, times 4 pi, of a medium seen from afar that is the same from all directions.
// `power` is over 4 pi [W/sr].
Measure power_is(const std::function<double(const Scene&)>& power);

// Expects the path tracer's picture, of this many paths per pixel. The path tracer itself is compared with its other
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
