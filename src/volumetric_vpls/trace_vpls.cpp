#include "volumetric_vpls/trace_vpls.h"

namespace brisance {

std::vector<VolumetricVpl> trace_vpls(const DirectLight& scene, const VolumetricVplSettings& settings, int bounces,
                                      VolumetricVplReport& report) {
    if (bounces >= 0 && bounces < 2)
        return {};
    const TrackingField& field = scene.field();
    const auto leave = [&](const ParticleFlight& f, std::vector<VolumetricVpl>& lights) {
        if (!f.collision)
            return;
        const Collision& c = *f.collision;
        VolumetricVpl light;
        light.position = f.ray().origin + c.distance * f.ray().direction;
        light.direction = f.ray().direction;
        light.power = f.power * field.albedo(c.brick, c.position);
        light.scatterings = f.before + 1;
        light.extinction = field.extinction(c.brick, c.position);
        light.scattered = luminance(light.power);
        if (light.scattered > 0.0)
            lights.push_back(light);
    };
    std::vector<VolumetricVpl> lights = lights_of_flights<VolumetricVpl>(
        scene, {Stream::VolumetricVpl, settings.paths, settings.seed}, bounces < 0 ? -1 : bounces - 2, leave, report);
    report.collisions = report.lights = lights.size();
    return lights;
}

}  // namespace brisance
