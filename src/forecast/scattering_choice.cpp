#include "forecast/scattering_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/stopwatch.h"
#include "forecast/mean_escape.h"

namespace brisance {

namespace {

constexpr double kDense = 0.125, kThin = 0.2;
constexpr float kSmooth = 0.4f, kSharp = 0.6f;

// Of the picture, with both weights.
std::string reason_of(double escape, float thin, float mean_cosine, float share) {
    const std::string weighed = fmt::format("scattering.method is auto: mean escape probability {:.3g}", escape);
    if (thin == 0.0f)
        return weighed + fmt::format(", up to {} the lighting grid", kDense);
    const std::string both = weighed + fmt::format(" and abs(mean_cosine) {:.3g}: ", std::abs(mean_cosine));
    const std::string photons = VolumetricPhotonsMethod::kName;
    return both + (share == 1.0f ? photons : fmt::format("{:.3g} {}, the rest the lighting grid", share, photons));
}

bool is_automatic(const Shot& shot) {
    return shot.scattering_methods.method == kAutomaticMethod;
}

}  // namespace

float thinness(double escape) {
    return static_cast<float>(glm::smoothstep(kDense, kThin, escape));
}

float sharpness(float mean_cosine) {
    return glm::smoothstep(kSmooth, kSharp, std::abs(mean_cosine));
}

ScatteringChoice choose_scattering(const Shot& shot, const Medium& medium, bool twice, bool lamps) {
    const std::string& asked = shot.scattering_methods.method;
    const bool automatic = is_automatic(shot), grid = asked == kLightingGridMethod;
    const float sharp = twice ? sharpness(medium.mean_cosine) : 0.0f;
    ScatteringChoice out{automatic ? kLightingGridMethod : asked, 0.0f, 0.0f, "scattering.method is " + asked, {}};
    if (!automatic && !grid && twice) {
        out.share = 1.0f;
        out.emitters_by_rays = lamps ? 1.0f : 0.0f;
    }
    if (automatic)
        out.reason += fmt::format(": abs(mean_cosine) up to {} the lighting grid", kSmooth);
    const bool open = (automatic && sharp > 0.0f) || (lamps && out.share == 0.0f);
    if (!open)
        return out;
    const Stopwatch watch;
    const double escape = shot.scattering.escape >= 0.0f ? double(shot.scattering.escape) : mean_escape(medium);
    const float thin = thinness(escape), by_photons = thin * sharp;
    if (automatic && sharp > 0.0f) {
        out.reason = reason_of(escape, thin, medium.mean_cosine, by_photons);
        out.share = by_photons;
        if (by_photons > 0.0f)
            out.method = VolumetricPhotonsMethod::kName;
    }
    if (lamps)
        out.emitters_by_rays = thin;
    out.cost = {"choice of the scattering method",
                watch.seconds(),
                0,
                {{"method", out.method},
                 {"mean_escape", escape},
                 {"thinness", thin},
                 {"sharpness", sharp},
                 {"share_of_method", out.share},
                 {"emitters_by_rays", out.share + (1.0f - out.share) * out.emitters_by_rays},
                 {"reason", out.reason}}};
    return out;
}

bool leaves_escape_open(const Shot& shot) {
    const bool may_be_sharp = is_automatic(shot) && sharpness(shot.medium.smoke.mean_cosine) > 0.0f;
    return shot.method != RenderMethod::Path && shot.scattering.escape < 0.0f && (may_be_sharp || !shot.scene.empty());
}

}  // namespace brisance
