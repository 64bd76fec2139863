#include "forecast/correction_plan.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// Errors from which on samples take nothing of a frame's time, and as much as they may.
constexpr float kNoSamples = 0.02f, kAllSamples = 0.015f;
// The least error that lights are built for beside samples. Finer ones would take hours, and keep some of it.
constexpr float kFinestLights = 0.01f;
// Seconds of samples over those of the picture: at most, and as they usually are where kUsualError is asked. The square
// of what noise leaves falls with their number.
constexpr double kMostShare = 8.0, kUsualShare = 3.0, kUsualError = 0.01;

// Pixels of the pilot that tells what a sample costs.
constexpr std::size_t kPilot = 512;
// Fewer tell nothing that is worth their set-up.
constexpr double kFewest = 4096.0, kMost = double(1 << 28);

bool is_automatic(const Shot& shot, const Plan& plan) {
    const bool scatters = plan.needs(Cell::MV) || plan.needs(Cell::MA) || plan.needs(Cell::SV) || plan.needs(Cell::SS);
    return shot.correction.samples == kAutomaticCorrection && grid_is_estimated(plan) && scatters;
}

double part_of_share(const Shot& shot, const Plan& plan) {
    if (!is_automatic(shot, plan))
        return 0.0;
    return std::clamp((kNoSamples - shot.lighting.error) / (kNoSamples - kAllSamples), 0.0f, 1.0f);
}

}  // namespace

float error_of_lights(const Shot& shot, const Plan& plan) {
    const float asked = shot.lighting.error;
    return is_automatic(shot, plan) ? std::max(asked, std::clamp(2.0f * asked, kFinestLights, kNoSamples)) : asked;
}

Shot shot_of_lights(Shot shot, const Plan& plan) {
    shot.lighting.error = error_of_lights(shot, plan);
    return shot;
}

double most_of_correction(const Shot& shot, const Plan& plan) {
    return kMostShare * part_of_share(shot, plan);
}

double usual_correction(const Shot& shot, const Plan& plan) {
    const double usual = kUsualShare * std::pow(kUsualError / shot.lighting.error, 2.0);
    return part_of_share(shot, plan) * std::min(usual, kMostShare);
}

double corrected_seconds(const Shot& shot, const CountedMedium& counted, const Plan& plan,
                         const CameraSettings& camera) {
    return (1.0 + usual_correction(shot, plan)) * grid_seconds(shot_of_lights(shot, plan), counted, plan, camera);
}

std::size_t samples_of_share(double share, const Shot& shot, const CountedMedium& counted, const Plan& plan,
                             const Camera& camera, const Surroundings* surroundings) {
    if (!(share > 0.0))
        return 0;
    const PathTracer tracer(counted.medium, shot.tracing, shot.scattering.bounces, surroundings);
    const PathPilot pilot = trace_pilot(tracer, camera, kPilot);
    const double seconds = share * grid_seconds(shot, counted, plan, camera.settings()) -
                           tracer_seconds(counted.medium) - pilot_seconds(pilot, kPilot);
    const double samples = seconds * pilot.lit / std::max(pilot.ray_seconds(), 1e-9);
    return samples < kFewest ? 0 : static_cast<std::size_t>(std::min(samples, kMost));
}

}  // namespace brisance
