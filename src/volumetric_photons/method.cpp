#include "volumetric_photons/method.h"

#include "volumetric_photons/volumetric_photons.h"

namespace brisance {

std::vector<SettingKey<VolumetricPhotonSettings>> VolumetricPhotonsMethod::keys() {
    using S = VolumetricPhotonSettings;
    return {
        setting_key("paths", "particles that are followed through smoke and surfaces", whole(1, 1000000000), &S::paths),
        setting_key("neighbours", "photons around a point of a surface that estimate the light arriving there",
                    whole(1, 65536), &S::neighbours),
        setting_key(
            "filter_radius",
            "for comparison: light in the medium is filtered by a Gaussian of this standard deviation [voxels], "
            "which biases it; 0: not",
            real_float({0.0, 8.0}), &S::filter_radius),
        setting_key("seed", "another number gives other particles", whole(0, 2147483647), &S::seed)};
}

MadeInScattering VolumetricPhotonsMethod::make(const InScatteringRequest& request, const Settings& settings) {
    // Glossy surfaces trace rays that do not lead to the camera.
    const Surroundings* const surroundings = request.scene.surroundings();
    const bool other_rays = surroundings && surroundings->scene().is_glossy();
    auto photons =
        std::make_unique<VolumetricPhotons>(request.scene, settings, request.bounces, request.eye, other_rays);
    const VolumetricPhotonReport& r = photons->report();
    MadeInScattering made{nullptr, photons->bytes(), {}, 0.0};
    made.detail = {{"particles", r.paths},
                   {"flights", r.flights},
                   {"surface_photons", r.surface_photons},
                   {"not_finite", r.not_finite}};
    made.estimator = std::move(photons);
    return made;
}

}  // namespace brisance
