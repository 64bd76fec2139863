#include "forecast/costs.h"

#include <algorithm>
#include <cmath>

#include "camera/camera.h"
#include "camera_rays/automatic_samples.h"
#include "camera_rays/picture.h"
#include "core/parallel.h"
#include "gathering/gather.h"
#include "gathering/map_layouts.h"
#include "medium_lighting/lit_lattice.h"
#include "reference/trace_picture.h"

namespace brisance {

namespace {

// Seconds of one core at 2.5 GHz, fitted to nine pictures of 0.04 to 0.7 million nodes, which are within 30 %.
// Evaluations of a light at a node, with what else a node takes: so many for each node at alpha 1 where all of its
// light is interpolated, where all is its own, and as alpha's power 1.9.
constexpr double kEvaluation = 11e-9, kDirectional = 1.25, kPowerOfAlpha = 1.9;
constexpr double kEvaluationsBetween = 190.0, kEvaluationsOfOwn = 360.0;
// Values of shadow maps of 12^2 texels and 10 distances: so many for each node in the same two cases, and those of the
// few top levels.
constexpr double kMapValue = 7e-9, kMapValuesBetween = 75.0, kMapValuesOfOwn = 180.0, kMapValuesAtTop = 26e6,
                 kKnownMap = 12.0 * 12.0 * 10.0;
// The operator and the series, for each node of their lattice. A level has about a sixth of the next finer one's nodes.
constexpr double kCoarseNode = 80e-6, kNodesOfParent = 6.0;
constexpr double kFineBounce = 0.3;  // the evaluations of one, over those of a flight whose nodes gather all
constexpr double kFrame = 0.25;
constexpr double kSegment = 1.2e-6;       // of a path: 0.7 to 1.9
constexpr double kSegmentOfSet = 2.5e-6;  // beside surfaces or lamps: 2.3 to 2.7
constexpr double kCameraRay = 2.4e-6;
constexpr double kTrackingOfVoxel = 0.25e-6;  // set-up of the path tracer
// With a set, a guess from seven (costs.h): lights for surfaces and what those send into smoke, over the lighting of
// smoke alone; virtual lights; what lights the surface that a camera ray meets.
constexpr double kSmokeOfSet = 3.2, kVirtualLights = 6.0, kSurfaceRay = 4e-6;

constexpr int kPilotSamples = 8;

double camera_rays(const Shot& shot, const CountedMedium& counted, const CameraSettings& settings) {
    int side = settings.samples_per_axis;
    if (side <= 0)
        side = automatic_samples(Camera(settings, counted.medium), counted.medium, counted.changes).few;
    return double(shot.camera.width) * shot.camera.height * side * side;
}

bool has_set(const Plan& plan) {
    return plan.surfaces || plan.emitters;
}

bool has_virtual_lights(const Shot& shot, const Plan& plan) {
    return plan.surfaces && shot.virtual_lights.count > 0 && (plan.needs(Cell::SS) || plan.needs(Cell::MS));
}

double surface_rays(const Plan& plan, const CameraSettings& camera) {
    const int side = camera.samples_per_axis > 0 ? camera.samples_per_axis : kSurfaceSamples;
    return plan.surfaces ? double(side * side) * double(camera.width) * camera.height : 0.0;
}

// The samples of one pixel: variance of one, and the square of their mean without its own noise, over all colours.
struct PilotPixel {
    double variance = 0.0, square = 0.0;
    PathStatistics paths;
};

PilotPixel trace_pilot_pixel(const PathTracer& tracer, const Camera& camera, std::size_t pixel) {
    PilotPixel out;
    dvec3 sum(0.0), squares(0.0);
    for (std::uint64_t k = 0; k < kPilotSamples; ++k) {
        dvec3 light(0.0);
        for (const Rgb& order : trace_sample(tracer, camera, pixel, k, out.paths))
            light += dvec3(order);
        if (!std::isfinite(light.x + light.y + light.z))
            continue;
        sum += light;
        squares += light * light;
    }
    const dvec3 mean = sum / double(kPilotSamples);
    const dvec3 variance = (squares - mean * sum) / double(kPilotSamples - 1);
    out.variance = variance.x + variance.y + variance.z;
    out.square = glm::dot(mean, mean) - out.variance / double(kPilotSamples);
    return out;
}

}  // namespace

CountedMedium::CountedMedium(const Medium& counted) : medium(counted), changes(changes_in_bricks(counted)) {
    const std::vector<std::uint8_t> needed = nodes_beside_extinction(medium);
    lit_nodes = double(std::count_if(needed.begin(), needed.end(), [](std::uint8_t n) { return n != 0; }));
}

ScatteringSettings orders_of(const Shot& shot) {
    return settings_of_orders(shot.scattering, shot.output.bounce_layers);
}

LatticeChoice forecast_lattice(const Shot& shot, const Medium& medium, int smoke_level) {
    ScatteringSettings settings = orders_of(shot);
    if (settings.lattice_level >= 0)
        settings.lattice_level = std::max(0, settings.lattice_level - smoke_level);
    return lattice_of_series(smoke_met(medium).coarser(smoke_level), settings, shot.lighting.error,
                             ExtinctionPyramid::kMaxLevels - 1);
}

double lighting_seconds(const Shot& shot, const CountedMedium& counted, const Plan& plan) {
    const std::optional<LightingLevels> stated = stated_levels(shot.lighting);
    return lighting_seconds(shot, counted, plan, stated ? *stated : lighting_levels(counted.medium, shot.lighting));
}

double lighting_seconds(const Shot& shot, const CountedMedium& counted, const Plan& plan,
                        const LightingLevels& levels) {
    const auto nodes_of = [&](const LightingLevel& level) {
        const double parents = level.share_of_coarser > 0.0f ? 1.0 / kNodesOfParent : 0.0;
        return counted.lit_nodes / std::pow(kNodesOfParent, level.level) * (1.0 + parents);
    };
    const double nodes = nodes_of(levels.first), of_smoke = plan.multiple ? nodes_of(levels.smoke) : 0.0;
    const double own = own_share_of(shot.lighting, counted.medium.mean_cosine);
    const double evaluations_of_node = std::lerp(kEvaluationsBetween, kEvaluationsOfOwn, own);
    double evaluations = evaluations_of_node * nodes * std::pow(double(shot.lighting.alpha), kPowerOfAlpha);
    double coarse = 0.0;
    if (plan.multiple) {
        const ScatteringSettings orders = orders_of(shot);
        const LatticeChoice series = forecast_lattice(shot, counted.medium, levels.smoke.level);
        const bool bounces = share_of_fine_bounces(series, orders, shot.lighting.error) > 0.0f;
        const double bounce = bounces ? kFineBounce * kEvaluationsOfOwn * count_of_fine_bounces(orders) : 0.0;
        evaluations +=
            (evaluations_of_node + bounce) * of_smoke * std::pow(double(shot.scattering.alpha), kPowerOfAlpha);
        coarse = of_smoke / std::pow(kNodesOfParent, double(series.level) + series.share_of_coarser);
    }
    const double map =
        std::pow(double(shadow_resolution(shot.lighting)), 2.0) * shadow_distances(shot.lighting) / kKnownMap;
    const double values = 0.5 * map *
                          (std::lerp(kMapValuesBetween, kMapValuesOfOwn, own) * (nodes + of_smoke) +
                           (plan.multiple ? 2.0 : 1.0) * kMapValuesAtTop);
    const double of_smoke_alone =
        kEvaluation * (plan.directional ? kDirectional : 1.0) * evaluations + kMapValue * values + kCoarseNode * coarse;
    return kFrame + (has_set(plan) ? kSmokeOfSet : 1.0) * of_smoke_alone +
           (has_virtual_lights(shot, plan) ? kVirtualLights : 0.0);
}

double grid_seconds(const Shot& shot, const CountedMedium& counted, const Plan& plan, const CameraSettings& camera) {
    return lighting_seconds(shot, counted, plan) + camera_seconds(shot, counted, plan, camera);
}

double camera_seconds(const Shot& shot, const CountedMedium& counted, const Plan& plan, const CameraSettings& camera) {
    return kCameraRay * camera_rays(shot, counted, camera) + kSurfaceRay * surface_rays(plan, camera);
}

bool grid_is_forecast(const Plan& plan) {
    return grid_is_estimated(plan) && !has_set(plan);
}

bool grid_is_estimated(const Plan& plan) {
    return !plan.scattering_method && !plan.fire_sampling && !plan.unified_sampling;
}

double tracer_seconds(const Medium& medium) {
    return kTrackingOfVoxel * double(medium.lattice.node_count());
}

double PathPilot::ray_seconds() const {
    return segment_seconds * segments;
}

double PathPilot::lit_ray_seconds() const {
    return ray_seconds() / lit;
}

double pilot_seconds(const PathPilot& pilot, std::size_t pixels) {
    return pilot.ray_seconds() * double(pixels) * kPilotSamples;
}

PathPilot trace_pilot(const PathTracer& tracer, const Camera& camera, std::size_t wanted) {
    const CameraSettings& settings = camera.settings();
    const std::size_t all = std::size_t(settings.width) * settings.height, count = std::min(all, wanted);
    std::vector<PilotPixel> pixels(count);
    parallel_for(count, [&](std::size_t i) {
        // Golden-ratio steps: no column or row is met more often than others.
        const double at = std::fmod(double(i) * 0.61803398874989484820, 1.0);
        pixels[i] = trace_pilot_pixel(tracer, camera, std::min(all - 1, static_cast<std::size_t>(at * double(all))));
    });
    double variance = 0.0, square = 0.0;
    std::uint64_t segments = 0;
    std::size_t lit = 0;
    for (const PilotPixel& p : pixels) {
        lit += p.variance > 0.0 || p.square > 0.0;
        variance += p.variance;
        square += p.square;
        segments += p.paths.paths + p.paths.scatterings;
    }
    // A black pilot needs no paths. Where noise hides all light, paths are taken to need far too many.
    const double noise = variance > 0.0 ? variance / std::max(square, 1e-12 * variance) : 0.0;
    return {noise, double(segments) / (double(count) * double(kPilotSamples)),
            double(std::max<std::size_t>(lit, 1)) / double(count),
            tracer.direct().surroundings() ? kSegmentOfSet : kSegment};
}

}  // namespace brisance
