#include "ray_lights/trace_ray_lights.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "ray_lights/ray_light_tree.h"
#include "tracing/roulette.h"

namespace brisance {

namespace {

constexpr std::size_t kBlock = 256;
constexpr double kByPowerAlone = 0.1;

bool finite(const Rgb& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

// Lights are cut into pieces of this part of the medium's diagonal: a long one would be near every receiver, and the
// tree could not tell who asks for which of its ends. Pieces of a ray light are ray lights.
constexpr double kLongestPiece = 1.0 / 24.0;

class Flights {
public:
    Flights(const DirectLight& scene, RayLength length) : scene_(scene), long_(length == RayLength::Long) {
        const Medium& medium = scene.field().medium();
        const dvec3 nodes(scene.field().bricks().brick_extent() * BrickLattice::kSize);
        longest_ = kLongestPiece * glm::length(dmat3(medium.world_from_index) * nodes);
    }
    bool are_long() const { return long_; }

    // The light of a flight from the ray's origin to `end`, where there is smoke.
    void leave_light(const Ray& ray, double end, const Rgb& power, std::vector<RayLight>& lights) const {
        double depth = 0.0, from = 0.0, to = -1.0;
        const auto leave = [&] {
            const int pieces = std::max(1, static_cast<int>(std::ceil((to - from) / longest_)));
            for (int i = 0; to > from && i < pieces; ++i)
                leave_piece(ray, std::lerp(from, to, double(i) / pieces), std::lerp(from, to, (i + 1.0) / pieces),
                            power, depth, lights);
        };
        walk_bricks(scene_.field().bricks(), scene_.field().enter(ray, end), [&](const CellSegment& brick) {
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
    void leave_piece(const Ray& ray, double from, double to, const Rgb& power, double& depth,
                     std::vector<RayLight>& lights) const {
        RayLight light;
        light.segment = {ray.origin + from * ray.direction, ray.direction, to - from};
        const double own = optical_depth(scene_.field(), {light.segment.start, ray.direction}, light.segment.length);
        light.power = long_ ? power * float(std::exp(-depth)) : power;
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

// One particle. What is absorbed ends the path by roulette: powers stay about equal.
void follow(const DirectLight& scene, const Flights& flights, Ray ray, Rgb power, int bounces, Rng& rng,
            std::uint64_t& count, std::vector<RayLight>& lights) {
    // Scatterings before this flight; there are two more after it.
    for (int before = 0; bounces < 0 || before + 2 <= bounces; ++before) {
        const RaySegment segment = scene.segment_along(ray);
        const std::optional<Collision> collision = null_collision_flight(scene.field(), ray, segment.end, rng);
        const bool ends = collision && !flights.are_long();
        flights.leave_light(ray, ends ? collision->distance : segment.end, power, lights);
        ++count;
        if (!collision && !segment.point)
            return;
        const Scatterer place = collision ? scene.in_smoke(ray, *collision) : Scatterer(*segment.point, ray.direction);
        const std::optional<Scatterer::Sample> next = place.sample_particle(rng);
        if (!next)
            return;
        const Rgb left =
            power * (collision ? scene.field().albedo(collision->brick, collision->position) : next->weight);
        const float part = std::min(largest(left) / largest(power), before >= kManyScatterings ? kGoesOn : 1.0f);
        if (!(rng.next() < part))  // so for what is not finite
            return;
        power = left / part;
        ray = place.leaving(next->wi);
    }
}

void add(RayLightReport& to, const RayLightReport& r) {
    to.paths += r.paths;
    to.flights += r.flights;
    to.not_finite += r.not_finite;
    to.emitted += r.emitted;
}

// The factor on all weights with which the probabilities min(1, factor * weight) add up to `count`.
double factor_for(std::vector<double> weights, double count) {
    std::sort(weights.begin(), weights.end(), std::greater<>());
    double rest = 0.0;
    for (const double w : weights)
        rest += w;
    // The largest are certain, one after another, until none is any more.
    for (std::size_t certain = 0; certain < weights.size(); ++certain) {
        const double left = count - double(certain);
        if (left <= 0.0 || weights[certain] * left <= rest)
            return std::max(left, 0.0) / std::max(rest, 1e-300);
        rest -= weights[certain];
    }
    return 1e300;
}

}  // namespace

std::vector<RayLight> trace_ray_lights(const DirectLight& scene, const RayLightSettings& settings, int bounces,
                                       RayLightReport& report) {
    const auto total = static_cast<std::size_t>(settings.paths);
    const Particles particles(scene, ball_around(scene), total);
    const Flights flights(scene, settings.length);
    struct Part {
        std::vector<RayLight> lights;
        RayLightReport report;
    };
    std::vector<Part> parts((total + kBlock - 1) / kBlock);
    parallel_blocks(total, kBlock, [&](std::size_t begin, std::size_t end) {
        Part& part = parts[begin / kBlock];
        for (std::size_t i = begin; i < end; ++i) {
            Rng rng(Stream::RayLight, i, settings.seed);
            ++part.report.paths;
            const std::optional<EmittedParticle> particle = particles.emit(i, rng);
            if (!particle)
                continue;
            if (!finite(particle->power) || !(largest(particle->power) > 0.0f)) {
                part.report.not_finite += !finite(particle->power);
                continue;
            }
            part.report.emitted += luminance(particle->power);
            follow(scene, flights, particle->ray, particle->power, bounces, rng, part.report.flights, part.lights);
        }
    });
    std::vector<RayLight> lights;
    for (const Part& part : parts) {
        lights.insert(lights.end(), part.lights.begin(), part.lights.end());
        add(report, part.report);
    }
    report.pieces = report.lights = lights.size();
    return lights;
}

std::vector<RayLight> keep_important(std::vector<RayLight> lights, std::span<const RayLightReceiver> receivers,
                                     std::size_t count, double mean_cosine, std::uint32_t seed) {
    if (lights.size() <= count)
        return lights;
    std::vector<double> arriving(lights.size(), 0.0);
    parallel_for(
        lights.size(),
        [&](std::size_t i) {
            const RayLightBounds box = bounds_of(lights[i]);
            for (const RayLightReceiver& receiver : receivers)
                arriving[i] += importance(box, receiver, mean_cosine);
        },
        kBlock);
    double all_arriving = 0.0, all_power = 0.0;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        all_arriving += arriving[i];
        all_power += lights[i].scattered;
    }
    const double by_power = all_arriving > 0.0 ? kByPowerAlone : 1.0;
    for (std::size_t i = 0; i < lights.size(); ++i)
        arriving[i] = by_power * lights[i].scattered / all_power +
                      (all_arriving > 0.0 ? (1.0 - by_power) * arriving[i] / all_arriving : 0.0);
    const double factor = factor_for(arriving, double(count));
    std::vector<RayLight> kept;
    for (std::size_t i = 0; i < lights.size(); ++i) {
        const double part = std::min(1.0, factor * arriving[i]);
        if (!(Rng(Stream::RayLightRoulette, i, seed).next_double() < part))
            continue;
        kept.push_back(lights[i]);
        kept.back().power /= float(part);
        kept.back().scattered /= part;
    }
    return kept;
}

}  // namespace brisance
