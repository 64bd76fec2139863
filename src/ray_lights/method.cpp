#include "ray_lights/method.h"

#include "light_selection/thin_lights.h"
#include "ray_lights/pair_sampling.h"
#include "ray_lights/ray_lights.h"

namespace brisance {

namespace {

std::vector<std::pair<std::string, RaySampling>> sampling_words() {
    std::vector<std::pair<std::string, RaySampling>> words;
    for (const PairSampling& row : pair_samplings())
        words.emplace_back(row.name, row.value);
    return words;
}

std::string sampling_help() {
    std::string help = "how points on a ray light are drawn.";
    for (const PairSampling& row : pair_samplings())
        help += (help.back() == '.' ? " " : "; ") + row.name + ": " + row.help;
    return help;
}

}  // namespace

std::vector<SettingKey<RayLightSettings>> RayLightsMethod::keys() {
    using S = RayLightSettings;
    return {
        setting_key("paths", "particles whose flights through the smoke become ray lights", whole(1, 100000000),
                    &S::paths),
        setting_key("count", "pieces of their flights that are kept, on average: the important ones",
                    whole(1, 100000000), &S::count),
        setting_key("roulette_visibility",
                    "among those that compete for `count`, ones that surfaces hide from rays of the camera count less",
                    flag(), &S::roulette_visibility),
        setting_key("samples", "ray lights sampled for every ray of the camera, and for every surface it meets",
                    whole(1, 65536), &S::samples),
        setting_key("length", "short: to the particle's next collision; long: to where the smoke or a surface ends it",
                    choice<RayLength>({{"short", RayLength::Short}, {"long", RayLength::Long}}), &S::length),
        setting_key("sampling", sampling_help(), choice<RaySampling>(sampling_words()), &S::sampling),
        setting_key("seed", "another number gives other rays", whole(0, 2147483647), &S::seed),
        setting_key("radius",
                    "of beams in the first pass [m]: a blur that lowers the noise of sharp lobes; 0: none, without "
                    "bias; auto: from the distance between the lights",
                    or_word(real(at_least(0.0)), "auto", kAutomaticRadius), &S::radius),
        setting_key("passes", "whole pictures that are averaged, each by ray lights of its own and thinner beams",
                    whole(1, 65536), &S::passes),
        setting_key("radius_reduction",
                    "of beams from pass to pass: alpha of r^2 (i + alpha) / (i + 1); small values lose the blur sooner",
                    real({0.0, 1.0, true, true}), &S::radius_reduction)};
}

MadeInScattering RayLightsMethod::make(const InScatteringRequest& request, const Settings& settings) {
    auto lights =
        std::make_unique<RayLights>(request.scene, settings_of_pass(settings, request.pass, request.first_radius),
                                    request.bounces, request.receivers);
    const RayLightReport& r = lights->report();
    MadeInScattering made{nullptr, lights->bytes(), {}, lights->radius()};
    made.detail = {{"particles", r.paths},
                   {"flights", r.flights},
                   {"pieces", r.pieces},
                   {"lights", r.lights},
                   {"acceptance", acceptance(r.lights, r.pieces)},
                   {"not_finite", r.not_finite},
                   {"last_radius", lights->radius()}};
    made.estimator = std::move(lights);
    return made;
}

}  // namespace brisance
