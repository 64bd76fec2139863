#include "volumetric_vpls/method.h"

#include "light_selection/thin_lights.h"
#include "volumetric_vpls/volumetric_vpls.h"

namespace brisance {

std::vector<SettingKey<VolumetricVplSettings>> VolumetricVplsMethod::keys() {
    using S = VolumetricVplSettings;
    return {
        setting_key("paths", "particles whose collisions in the smoke become point lights", whole(1, 100000000),
                    &S::paths),
        setting_key("count", "collisions that are kept, on average: the important ones", whole(1, 100000000),
                    &S::count),
        setting_key("roulette_visibility",
                    "among those that compete for `count`, ones that surfaces hide from rays of the camera count less",
                    flag(), &S::roulette_visibility),
        setting_key("samples", "point lights sampled for every ray of the camera, and for every surface it meets",
                    whole(1, 65536), &S::samples),
        setting_key("bound_per_metre2",
                    "upper bound of 1 / distance^2 to a light [1/m^2]; 0: unbounded; auto: from the smoke and `paths`",
                    or_word(real(at_least(0.0)), "auto", kAutomaticBound), &S::bound),
        setting_key("compensation",
                    "of what the bound takes away. none: lost; exact: found by paths, unbiased; local: approximated "
                    "as if the smoke around every point were homogeneous",
                    choice<BiasCompensation>({{"none", BiasCompensation::None},
                                              {"exact", BiasCompensation::Exact},
                                              {"local", BiasCompensation::Local}}),
                    &S::compensation),
        setting_key("compensation_samples", "of it, on every ray of the camera and at every surface it meets",
                    whole(1, 65536), &S::compensation_samples),
        setting_key("seed", "another number gives other lights", whole(0, 2147483647), &S::seed)};
}

std::vector<MethodPreset> VolumetricVplsMethod::presets() {
    return {{"volumetric_vpls", {"bound_per_metre2=0"}},
            {"volumetric_vpls_bounded", {"compensation=none"}},
            {"volumetric_vpls_compensated", {"compensation=exact"}},
            {"volumetric_vpls_local", {"compensation=local"}}};
}

MadeInScattering VolumetricVplsMethod::make(const InScatteringRequest& request, const Settings& settings) {
    auto lights = std::make_unique<VolumetricVpls>(request.scene, settings, request.bounces, request.receivers);
    const VolumetricVplReport& r = lights->report();
    MadeInScattering made{nullptr, lights->bytes(), {}, 0.0};
    made.detail = {{"particles", r.paths},
                   {"flights", r.flights},
                   {"collisions", r.collisions},
                   {"lights", r.lights},
                   {"acceptance", acceptance(r.lights, r.collisions)},
                   {"not_finite", r.not_finite},
                   {"bound_per_metre2", lights->bound().per_metre2()},
                   {"bound_radius_metres", lights->bound().radius()}};
    made.estimator = std::move(lights);
    return made;
}

}  // namespace brisance
