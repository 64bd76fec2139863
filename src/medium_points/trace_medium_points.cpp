#include "medium_points/trace_medium_points.h"

namespace brisance {

std::vector<MediumPoint> trace_medium_points(const DirectLight& scene, const PointLightSettings& settings, int bounces,
                                             MediumPointReport& report) {
    if (bounces >= 0 && bounces < 2)
        return {};
    const TrackingField& field = scene.field();
    const auto leave = [&](const ParticleFlight& f, std::vector<MediumPoint>& lights) {
        if (!f.collision)
            return;
        const Collision& c = *f.collision;
        MediumPoint light;
        light.position = f.ray.origin + c.distance * f.ray.direction;
        light.direction = f.ray.direction;
        light.power = f.power * field.albedo(c.brick, c.position);
        light.scatterings = f.before + 1;
        light.extinction = field.extinction(c.brick, c.position);
        light.scattered = luminance(light.power);
        if (light.scattered > 0.0)
            lights.push_back(light);
    };
    std::vector<MediumPoint> lights = lights_of_flights<MediumPoint>(
        scene, {Stream::MediumPoint, settings.paths, settings.seed}, bounces < 0 ? -1 : bounces - 2, leave, report);
    report.collisions = report.lights = lights.size();
    return lights;
}

}  // namespace brisance
