#include "emitters/emitter_lights.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace brisance {

namespace {

// Of an environment.
constexpr std::size_t kMostParts = 256;

// `irradiance`: luminance [W/m^2].
LightBounds at_infinity(const dvec3& toward, double spread, double irradiance, double distance) {
    LightBounds out;
    out.low = out.high = distance * toward;
    out.axis = -toward;
    out.spread = spread;
    out.intensity = irradiance * distance * distance;
    out.distance = distance;
    return out;
}

}  // namespace

EmitterLights::EmitterLights(const Emitters& emitters, double distance)
    : emitters_(emitters), bounds_(emitters.near_bounds()) {
    for (std::size_t i = 0; i < emitters.far_.size(); ++i) {
        const Emitters::Far& far = emitters.far_[i];
        if (!far.environment) {
            far_.push_back({i});
            bounds_.push_back(at_infinity(far.toward, std::acos(far.cosine), luminance(far.light->power), distance));
            continue;
        }
        skies_.push_back(std::make_unique<SkyParts>(*far.environment, kMostParts));
        const SkyParts& sky = *skies_.back();
        for (std::size_t part = 0; part < sky.parts().size(); ++part) {
            const SkyPart& p = sky.parts()[part];
            far_.push_back({i, &sky, part});
            bounds_.push_back(at_infinity(p.toward, p.spread, p.irradiance, distance));
        }
    }
}

std::optional<EmitterSample> EmitterLights::sample(std::size_t light, const LitPoint& point, Rng& rng) const {
    const std::size_t near = emitters_.near_.size();
    if (light >= near)
        return sample_far(far_[light - near], rng);
    std::optional<EmitterSample> s = emitters_.sample_on(emitters_.near_[light], point, rng);
    if (s && s->pdf > 0.0)
        s->pdf *= (1.0 - emitters_.far_probability()) * emitters_.tree_.probability(point, light);
    return s;
}

std::optional<EmitterSample> EmitterLights::sample_far(const Far& far, PointNumbers on) const {
    const Emitters::Far& light = emitters_.far_[far.light];
    std::optional<EmitterSample> s;
    if (far.sky) {
        const SkyPart& part = far.sky->parts()[far.part];
        const glm::dvec2 u = on();
        s = EmitterSample{far.sky->sample(part, u.x, u.y), std::numeric_limits<double>::infinity(), {}};
        s->weight = emitters_.radiance_of_far(light, s->direction) * float(far.sky->solid_angle(part));
        s->pdf = 1.0;
    } else {
        s = emitters_.sample_far(light, on);
    }
    if (s && s->pdf > 0.0)
        s->pdf = emitters_.pdf_of_background(s->direction);
    return s;
}

// The irradiance of a surface of radiance L is pi L at most, and its intensity L times its area.
std::vector<double> EmitterLights::least_squared_distances() const {
    std::vector<double> out;
    out.reserve(bounds_.size());
    for (const Emitters::Near& near : emitters_.near_)
        out.push_back(near.area / std::numbers::pi);
    for (std::size_t i = out.size(); i < bounds_.size(); ++i)
        out.push_back(bounds_[i].distance * bounds_[i].distance);
    return out;
}

std::uint64_t EmitterLights::bytes() const {
    std::uint64_t sum = bounds_.size() * sizeof(LightBounds) + far_.size() * sizeof(Far);
    for (const auto& sky : skies_)
        sum += sky->parts().size() * sizeof(SkyPart);
    return sum;
}

}  // namespace brisance
