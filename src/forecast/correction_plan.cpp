#include "forecast/correction_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "medium_lighting/levels/lighting_level.h"

namespace brisance {

namespace {

// Errors from which on samples take nothing of a frame's time, and as much as they may.
constexpr float kNoSamples = 0.04f, kAllSamples = 0.02f;
// The coarsest lights beside samples that reach less; and the least error that lights are built for beside them: finer
// ones would take hours, and keep some of it.
constexpr float kCoarsestLights = 0.02f, kFinestLights = 0.01f;
// What lattices may add to the picture over the error that is asked for, and over what they may add by default: on
// voxels twice as wide pictures of four volumes take a half to two thirds of the time, and 20,000 samples leave less of
// their error than the finer voxels had.
constexpr float kLatticeOfAsked = 1.5f, kMostLattice = 3.0f;
// What wider lattices save, over what samples usually take: from the first on they are used, from the second as far as
// they may be.
constexpr double kSavesTooLittle = 0.75, kSavesEnough = 1.25;
// Seconds of samples over those of the picture: at most, and as they usually are where kUsualError is asked. The square
// of what noise leaves falls with their number. At 0.01 eight times left 1.2 % of a hot core, and twelve 1.07 %. The
// power makes that twice at 0.02, which is enough there: with three times the built-in explosion has 1.7 % and takes 12
// % longer.
constexpr double kMostShare = 12.0, kUsualShare = 3.0, kUsualError = 0.01;
constexpr double kPowerOfMost = 2.6, kPowerOfUsual = 2.0;

// Pixels of the pilot that tells what a sample costs.
constexpr std::size_t kPilot = 512;
constexpr double kMost = double(1 << 28);

// Baselines are rendered for what they are, errors and all.
bool is_baseline(const Shot& shot) {
    const VirtualLightSettings& lights = shot.virtual_lights;
    const VirtualLightSettings usual;
    return shot.lighting.clusters > 0 || shot.lighting.shadows != ShadowMethod::Maps ||
           lights.placement != usual.placement || lights.flux != usual.flux || lights.kind != usual.kind ||
           lights.sampling != usual.sampling;
}

bool is_automatic(const Shot& shot, const Plan& plan) {
    const bool lights_smoke = plan.needs(Cell::MV) || plan.needs(Cell::MA) || plan.needs(Cell::SV);
    return shot.correction.samples == kAutomaticCorrection && grid_is_estimated(plan) && lights_smoke &&
           !is_baseline(shot);
}

// A share of kUsualError for another error.
double share_for(float error, double share, double power) {
    return std::min(share * std::pow(kUsualError / error, power), kMostShare);
}

// Of what samples and lattices may do beside each other.
double part_of_share(const Shot& shot, const Plan& plan) {
    if (!is_automatic(shot, plan))
        return 0.0;
    return std::clamp((kNoSamples - shot.lighting.error) / (kNoSamples - kAllSamples), 0.0f, 1.0f);
}

// What a set misses is mostly too fine for samples.
Plan of_smoke_alone(Plan plan) {
    plan.surfaces = plan.emitters = false;
    return plan;
}

// How far wider lattices are worth their errors, from 0 to 1, by forecasts: what they save over what samples usually
// take.
double worth_of_wider(const Shot& usual, const Shot& wide, double usual_share, const Plan& plan,
                      const FrameOfLights& frame) {
    const std::array<LightingSettings, 2> settings{usual.lighting, wide.lighting};
    const std::vector<LightingLevels> levels = levels_for_each(frame.medium, settings, frame.surroundings);
    const auto is_wider = [](const LightingLevel& a, const LightingLevel& b) {
        return float(a.level) + a.share_of_coarser > float(b.level) + b.share_of_coarser;
    };
    if (!is_wider(levels[1].first, levels[0].first) && !is_wider(levels[1].smoke, levels[0].smoke))
        return 0.0;
    std::optional<CountedMedium> counted_here;
    const CountedMedium& counted = frame.counted ? *frame.counted : counted_here.emplace(frame.medium);
    const double lights = lighting_seconds(wide, counted, plan, levels[1]),
                 saved = lighting_seconds(usual, counted, plan, levels[0]) - lights;
    const Plan smoke = of_smoke_alone(plan);
    const double samples = usual_share * (lighting_seconds(wide, counted, smoke, levels[1]) +
                                          camera_seconds(wide, counted, smoke, frame.camera));
    return samples > 0.0 ? glm::smoothstep(kSavesTooLittle, kSavesEnough, saved / samples) : 1.0;
}

}  // namespace

float error_of_lights(const Shot& shot, const Plan& plan) {
    const float asked = shot.lighting.error;
    return is_automatic(shot, plan) ? std::max(asked, std::clamp(2.0f * asked, kFinestLights, kCoarsestLights)) : asked;
}

Shot shot_of_lights(Shot shot, const Plan& plan, const FrameOfLights& frame) {
    const float asked = shot.lighting.error, part = float(part_of_share(shot, plan));
    const double usual_share = usual_correction(shot, plan);
    shot.lighting.error = error_of_lights(shot, plan);
    if (part == 0.0f || shot.lighting.lattice_error >= 0.0f || stated_levels(shot.lighting))
        return shot;
    const float usual = kShareOfLattice * shot.lighting.error;
    Shot wide = shot;
    shot.lighting.lattice_error = usual;
    wide.lighting.lattice_error =
        std::lerp(usual, std::clamp(kLatticeOfAsked * asked, usual, kMostLattice * usual), part);
    shot.lighting.lattice_error =
        std::lerp(usual, wide.lighting.lattice_error, float(worth_of_wider(shot, wide, usual_share, plan, frame)));
    return shot;
}

double most_of_correction(const Shot& shot, const Plan& plan) {
    return share_for(shot.lighting.error, kMostShare, kPowerOfMost) * part_of_share(shot, plan);
}

double usual_correction(const Shot& shot, const Plan& plan) {
    return share_for(shot.lighting.error, kUsualShare, kPowerOfUsual) * part_of_share(shot, plan);
}

double corrected_seconds(const Shot& shot, const CountedMedium& counted, const Plan& plan,
                         const CameraSettings& camera) {
    const Shot of_lights = shot_of_lights(shot, plan, {counted.medium, nullptr, camera, &counted});
    return (1.0 + usual_correction(shot, plan)) * grid_seconds(of_lights, counted, plan, camera);
}

std::size_t samples_of_share(double share, const Shot& shot, const CountedMedium& counted, const Plan& plan,
                             const PathTracer& tracer, const Camera& camera) {
    if (!(share > 0.0))
        return 0;
    const PathPilot pilot = trace_pilot(tracer, camera, kPilot);
    const double seconds = share * grid_seconds(shot, counted, of_smoke_alone(plan), camera.settings()) -
                           tracer_seconds(counted.medium) - pilot_seconds(pilot, kPilot);
    const double samples = seconds / std::max(pilot.lit_ray_seconds(), 1e-9);
    return samples < kFewestCorrections ? 0 : static_cast<std::size_t>(std::min(samples, kMost));
}

}  // namespace brisance
