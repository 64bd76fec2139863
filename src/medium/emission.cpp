#include "medium/emission.h"

#include <algorithm>

namespace brisance {

Rgb ramp_colour(const std::vector<RampStop>& ramp, float value) {
    if (ramp.empty())
        return Rgb(1.0f);
    const auto above = std::find_if(ramp.begin(), ramp.end(), [&](const RampStop& s) { return s.value > value; });
    if (above == ramp.begin())
        return ramp.front().colour;
    if (above == ramp.end())
        return ramp.back().colour;
    const RampStop& below = *(above - 1);
    return glm::mix(below.colour, above->colour, (value - below.value) / (above->value - below.value));
}

SourceRadiance::SourceRadiance(const FireSettings& settings) : settings_(settings) {
    if (settings.model == FireModel::Blackbody)
        blackbody_.emplace(BlackbodyScale::Absolute);
    if (settings.model == FireModel::NormalizedBlackbody)
        blackbody_.emplace(BlackbodyScale::Normalized);
    if (blackbody_ && settings.threshold > 0.0f)
        at_threshold_ = blackbody(settings.threshold);
}

Rgb SourceRadiance::blackbody(float temperature) const {
    const vec2 in = settings_.temperature_in;
    const vec2 kelvin = settings_.temperature_kelvin;
    const float t = (temperature - in.x) / (in.y - in.x);
    return blackbody_->radiance(kelvin.x + t * (kelvin.y - kelvin.x));
}

Rgb SourceRadiance::operator()(const NodeValues& values) const {
    const Rgb tint = settings_.strength * settings_.colour * values.colour;
    switch (settings_.model) {
        case FireModel::None:
            return Rgb(0.0f);
        case FireModel::Flame:
            return tint * std::max(0.0f, values.flame - settings_.threshold) *
                   ramp_colour(settings_.ramp, values.flame);
        case FireModel::Blackbody:
        case FireModel::NormalizedBlackbody: {
            const float gain = settings_.modulate_by_flame ? std::max(0.0f, values.flame) : 1.0f;
            return tint * gain * glm::max(blackbody(values.temperature) - at_threshold_, Rgb(0.0f));
        }
    }
    return Rgb(0.0f);
}

}  // namespace brisance
