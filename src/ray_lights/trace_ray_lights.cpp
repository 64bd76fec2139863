#include "ray_lights/trace_ray_lights.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// Lights are cut into pieces of this fraction of the medium's diagonal. A longer one would be near every receiver, and
// the tree could not distinguish its ends. Pieces of a ray light are ray lights.
constexpr double kLongestPiece = 1.0 / 24.0;

class Flights {
public:
    Flights(const DirectLight& scene, RayLength length) : scene_(scene), long_(length == RayLength::Long) {
        const Medium& medium = scene.field().medium();
        const dvec3 nodes(scene.field().bricks().brick_extent() * BrickLattice::kSize);
        longest_ = kLongestPiece * glm::length(dmat3(medium.world_from_index) * nodes);
    }
    // Leaves the light of a flight where there is smoke.
    void leave_light(const ParticleFlight& flight, std::vector<RayLight>& lights) const {
        const Ray& ray = flight.ray();
        const double end = flight.collision && !long_ ? flight.collision->distance : flight.segment.end;
        double depth = 0.0, from = 0.0, to = -1.0;
        const auto leave = [&] {
            const int pieces = std::max(1, static_cast<int>(std::ceil((to - from) / longest_)));
            for (int i = 0; to > from && i < pieces; ++i)
                leave_piece(flight, std::lerp(from, to, double(i) / pieces), std::lerp(from, to, (i + 1.0) / pieces),
                            depth, lights);
        };
        walk_bricks(scene_.field().bricks(), scene_.field().enter(ray, end), [&](const VoxelSegment& brick) {
            if (scene_.field().majorant(brick.brick) <= 0.0f)
                return true;
            if (to < brick.begin * (1.0 - 1e-12)) {
                leave();
                from = brick.begin;
            }
            to = brick.end;
            return true;
        });
        leave();
    }

private:
    void leave_piece(const ParticleFlight& flight, double from, double to, double& depth,
                     std::vector<RayLight>& lights) const {
        const Ray& ray = flight.ray();
        RayLight light;
        light.segment = {ray.origin + from * ray.direction, ray.direction, to - from};
        const double own = optical_depth(scene_.field(), {light.segment.start, ray.direction}, light.segment.length);
        light.power = long_ ? flight.power * float(std::exp(-depth)) : flight.power;
        light.from_smoke = flight.from_medium;
        light.dimmed = long_;
        light.extinction = own / light.segment.length;
        light.scattered = luminance(light.power) * (long_ ? -std::expm1(-own) : own);
        depth += own;
        if (light.scattered > 0.0)
            lights.push_back(light);
    }

    const DirectLight& scene_;
    bool long_;
    double longest_ = 0.0;  // piece [m]
};

}  // namespace

// A path has two scatterings more than its particle had before the flight.
std::vector<RayLight> trace_ray_lights(const DirectLight& scene, const RayLightSettings& settings, int bounces,
                                       RayLightReport& report) {
    std::vector<RayLight> lights;
    if (bounces >= 0 && bounces < 2)
        return lights;
    const Flights flights(scene, settings.length);
    lights = lights_of_flights<RayLight>(
        scene, {Stream::RayLight, settings.paths, settings.seed}, bounces < 0 ? -1 : bounces - 2,
        [&](const ParticleFlight& flight, std::vector<RayLight>& out) { flights.leave_light(flight, out); }, report);
    report.pieces = report.lights = lights.size();
    return lights;
}

}  // namespace brisance
