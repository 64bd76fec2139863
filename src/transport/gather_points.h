// Points at which the light of many lights is gathered, on a camera ray through smoke or on the surface that it meets,
// and gatherers that treat every point by itself.
//
// A gatherer is made of lights and settings as the ways of light_gathering.h are. Beside what these ask of them, lights
// have a type Light, Rgb or what adds up and has a luminance() likewise, and
//   estimate(light, probability, point, rng)
// what the point scatters of one light, over the probability with which it was chosen [W/(m^2 sr)].
//
// Most lights of a fire in dense smoke reach no point at all. Cuts that count no smoke are all but blind there: they
// take the smoke between to be as dense as at the point. A random choice remains right whatever the guess is, and the
// guess falls off slowly (guessed_transmittance()); a deterministic cut may stop too early by it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tracking/ray_medium.h"
#include "transport/direct_light.h"
#include "transport/light_gathering.h"

namespace brisance {

struct GatherPoint {
    PathVertex vertex;
    Rgb weight;         // of what it scatters, by its phase function or BSDF alone, in the light of the ray
    double extinction;  // there [1/m]
    // On a surface, its Lambert base, where lights shine on that alone; null: there is none. Not read in smoke.
    const PathVertex* base = nullptr;
};

// Appends stratified ends of `count` free flights along a camera ray. With opacity O of the ray, each point of albedo a
// counts by O a / count. `seen`: the medium on `ray`; `shift`: in [0, 1).
inline void add_flight_ends(const DirectLight& scene, const RayMedium& seen, const Ray& ray, int count, double shift,
                            std::vector<GatherPoint>& points) {
    const auto part = float(seen.opacity() / count);
    for (int i = 0; i < count; ++i) {
        const std::optional<Collision> c = seen.collision_at(seen.sample_flight((i + shift) / count));
        if (!c)
            continue;
        const Rgb weight = part * scene.field().albedo(c->brick, c->position);
        if (weight != Rgb(0.0f))
            points.push_back({scene.in_smoke(ray, *c), weight, scene.field().extinction(c->brick, c->position)});
    }
}

template <class Light>
class PointGatherer {
public:
    virtual ~PointGatherer() = default;
    // The light of all lights at all points of a ray, which come in their order along it, or at a single point of a
    // surface [W/(m^2 sr)].
    virtual Light at(std::span<const GatherPoint> points, Rng& rng) const = 0;
    virtual std::uint64_t bytes() const = 0;
};

// By one of the ways of light_gathering.h.
template <class Lights, class Way>
class AtEachPoint : public PointGatherer<typename Lights::Light> {
public:
    using Light = typename Lights::Light;
    template <class Settings>
    AtEachPoint(const Lights& lights, const Settings& settings) : lights_(lights), way_(lights, settings) {}
    Light at(std::span<const GatherPoint> points, Rng& rng) const override {
        auto sum = Light(Rgb(0.0f));
        for (const GatherPoint& p : points)
            sum += p.weight * way_.at(p.vertex, p.extinction, rng, [&](std::size_t light, double probability) {
                return lights_.estimate(light, probability, p, rng);
            });
        return sum;
    }
    std::uint64_t bytes() const override { return way_.bytes(); }

private:
    const Lights& lights_;
    Way way_;
};

}  // namespace brisance
