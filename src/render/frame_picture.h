// The picture of a frame from its lights: once, or pass by pass, at one moment or at several.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "camera_rays/picture.h"
#include "render/shutter/moment_lights.h"
#include "surface_lighting/bound_account.h"
#include "surface_lighting/light_reuse.h"
#include "surface_lighting/screen_space_compensation.h"
#include "surface_lighting/surface_shader.h"
#include "virtual_lights/path_lengths.h"

namespace brisance {

// Moments of the open shutter that are lit together, at one of their own.
struct LitStretch {
    const OpenShutter& shutter;
    const Instant& lit;
    std::size_t first, count;  // moments
};

class FramePicture {
public:
    // `stretch`: null where nothing moves. Keeps references.
    FramePicture(const DrawInput& input, const ManyLights& lights, const LitStretch* stretch, Progress& progress);

    // `place_again`: makes `lights` those of another pass of virtual lights, before each but the first.
    Image draw(Statistics& statistics, const std::function<void(int pass)>& place_again);
    // The layers bounce1, bounce2, ... of one order of scattering each. `image`: as drawn.
    void add_order_layers(Image& image);

    double samples_per_pixel() const;  // of all moments
    double seconds_on_estimators() const { return seconds_on_estimators_; }
    const BoundTally& bound_costs() const { return bound_costs_; }  // of the layers of output.layers.bound
    // What noise leaves in light that pixels share, as expected from its samples: of each cell, the root of the sum of
    // squares over all pixels and channels.
    nlohmann::ordered_json errors_of_shared() const;
    // The same of light on surfaces that pixels do not share, of all cells together; with the little that is expected
    // of shared light before it is shared.
    double error_of_shading() const;
    const PathLengths* path_lengths() const { return lengths_ ? &*lengths_ : nullptr; }

private:
    // Pictures of all moments, averaged: draw(lights, camera, surroundings, number of the moment).
    template <class Draw>
    Image mean_of_moments(const Draw& draw);
    int rays_of_pixel() const { return settings_.samples_per_axis * settings_.samples_per_axis; }  // at one moment
    Image pass(const InScattering* estimator, int number);
    int light_passes() const;
    Image mean_of_light_passes(const std::function<void(int pass)>& place_again);
    Image picture(const InScattering* estimator, int number, const MomentLights& lights, const Camera& camera,
                  const Surroundings* surroundings);
    std::optional<LightReuse> light_reuse(const Camera& camera, SharedBounce* shared, BoundAccount* bound) const;
    std::vector<SharedBounce::Apart> told_of_shared(const InScattering* estimator, bool asks_for_bound) const;
    std::optional<ScreenSpaceCompensation> compensation(const Camera& camera) const;
    int samples_of_pixel(const Camera& camera) const;
    void set_tolerances(const Camera& camera, SurfaceLightingInput& lighting);
    void add_shared(Image& image, SharedBounce& shared);
    Image order_picture(const NodeSources& order, PictureSettings settings);

    const DrawInput& input_;
    const ManyLights& lights_;
    const LitStretch* stretch_;
    PictureSettings settings_;
    Progress& progress_;
    std::optional<PathLengths> lengths_;
    std::optional<float> typical_;  // luminance
    BoundTally bound_costs_;
    std::array<double, kCells> square_errors_of_shared_{};  // sums over the pictures
    double square_error_of_shading_ = 0.0;
    int pictures_ = 0;
    double seconds_on_estimators_ = 0.0;
};

}  // namespace brisance
