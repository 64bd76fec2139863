#include "photon_density/method.h"

#include "photon_density/photon_density.h"

namespace brisance {

std::vector<SettingKey<PhotonDensitySettings>> PhotonDensityMethod::keys() {
    using S = PhotonDensitySettings;
    return {
        setting_key("estimator",
                    "point_point: photons in balls around points of a ray, blurred over 3 dimensions; point_beam: "
                    "photons around the whole ray, over 2; beam_beam: flights of photons around the whole ray, over 1",
                    choice<DensityEstimator>({{"point_point", DensityEstimator::PointPoint},
                                              {"point_beam", DensityEstimator::PointBeam},
                                              {"beam_beam", DensityEstimator::BeamBeam}}),
                    &S::estimator),
        setting_key("paths", "particles that are followed through smoke and surfaces, in each pass",
                    whole(1, 1000000000), &S::paths),
        setting_key(
            "radius",
            "of the blur in the smoke in the first pass [m]; auto: from the smoke and how many photons it holds",
            or_word(real({1e-9, 1e9}), "auto", kAutomaticBlur), &S::radius),
        setting_key("passes", "whole pictures that are averaged, each by photons of its own and with less blur",
                    whole(1, 65536), &S::passes),
        setting_key(
            "alpha",
            "the radius shrinks from pass to pass, its power of the blur's dimensions by (i + alpha) / (i + 1): "
            "small values lose the blur sooner, 1 keeps it; auto: noise and bias fall alike",
            or_word(real({0.0, 1.0, true, false}), "auto", kFastestAlpha), &S::alpha),
        setting_key("neighbours",
                    "photons around a point of a surface that estimate the light arriving there, in the first pass",
                    whole(1, 65536), &S::neighbours),
        setting_key("seed", "another number gives other photons", whole(0, 2147483647), &S::seed)};
}

std::vector<MethodPreset> PhotonDensityMethod::presets() {
    return {{"photon_points", {"estimator=point_beam"}},
            {"photon_points_3d", {"estimator=point_point"}},
            {"photon_beams", {"estimator=beam_beam"}}};
}

MadeInScattering PhotonDensityMethod::make(const InScatteringRequest& request, const Settings& settings) {
    auto photons = std::make_unique<PhotonDensity>(
        request.scene, settings_of_pass(settings, request.pass, request.first_radius), request.bounces, request.eye);
    const PhotonDensityReport& r = photons->report();
    MadeInScattering made{nullptr, photons->bytes(), {}, r.radius};
    made.detail = {{"particles", r.paths},       {"flights", r.flights},
                   {"stored", r.stored},         {"surface_photons", r.surface_photons},
                   {"not_finite", r.not_finite}, {"last_radius", r.radius}};
    made.estimator = std::move(photons);
    return made;
}

}  // namespace brisance
