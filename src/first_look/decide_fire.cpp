#include "first_look/decide_fire.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

constexpr double kGlows = 800.0;       // [K], Draper's point: below it nothing glows visibly
constexpr double kHottest = 3000.0;    // [K], of a sooty flame's brightest part
constexpr double kOutsideSmoke = 0.1;  // share of the flame where there is next to no smoke, to shine without it
constexpr double kNextToNone = 0.02;   // of the densest smoke
constexpr float kSteepness = 2.5f;     // power of the flame that the luminance follows

float three_digits(double value) {
    if (!(value > 0.0))
        return 0.0f;
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
    return static_cast<float>(std::round(value / unit) * unit);
}

// Colours of soot as it gets hotter, of luminance 1.
Rgb soot_colour(float share) {
    static const std::vector<RampStop> colours = {{0.0f, {1.0f, 0.06f, 0.004f}},
                                                  {0.35f, {1.0f, 0.2f, 0.02f}},
                                                  {0.7f, {1.0f, 0.42f, 0.08f}},
                                                  {1.0f, {1.0f, 0.62f, 0.22f}}};
    const auto above = std::ranges::find_if(colours, [&](const RampStop& s) { return s.value > share; });
    const RampStop& high = above == colours.end() ? colours.back() : *above;
    const RampStop& low = above == colours.begin() ? colours.front() : *(above - 1);
    const float t = high.value > low.value ? (share - low.value) / (high.value - low.value) : 0.0f;
    const Rgb colour = glm::mix(low.colour, high.colour, t);
    return colour / luminance(colour);
}

std::vector<RampStop> soot_ramp(float most) {
    std::vector<RampStop> ramp;
    for (const float share : {0.0f, 0.15f, 0.3f, 0.45f, 0.6f, 0.8f, 1.0f}) {
        const Rgb colour = soot_colour(share) * std::pow(share, kSteepness - 1.0f);
        ramp.push_back(
            {three_digits(share * most), Rgb(three_digits(colour.x), three_digits(colour.y), three_digits(colour.z))});
    }
    return ramp;
}

// Share of the flame where there is next to no smoke.
double flame_outside_smoke(const SequenceSurvey& survey) {
    const double dense = most_of(survey, &FrameSurvey::density);
    double outside = 0.0, all = 0.0;
    for (const FrameSurvey& frame : survey.seen)
        for (const SurveyCell& cell : frame.cells) {
            const double flame = double(cell.flame) * double(cell.flame_share);
            all += flame;
            outside += cell.density < kNextToNone * dense ? flame : 0.0;
        }
    return all > 0.0 ? outside / all : 0.0;
}

}  // namespace

double most_of(const SequenceSurvey& survey, std::optional<ValueSummary> FrameSurvey::*role) {
    double most = 0.0;
    for (const FrameSurvey& frame : survey.seen)
        if (frame.*role)
            most = std::max(most, (frame.*role)->most);
    return most;
}

FireChoice choose_fire(const SequenceSurvey& survey) {
    const double flame = most_of(survey, &FrameSurvey::flame);
    const double hottest = most_of(survey, &FrameSurvey::temperature);
    const bool smoke = most_of(survey, &FrameSurvey::density) > 0.0;
    if (hottest >= kGlows && (flame > 0.0 || !survey.mapping.flame))
        return {Fire::Kelvin, false,
                fmt::format("temperature up to {:.4g} is kelvin and glows{}", hottest,
                            flame > 0.0 ? fmt::format("; the flame grid says how much of it") : "")};
    if (flame > 0.0)
        return {
            Fire::Flame, false,
            fmt::format(
                "flame up to {:.3g}{}", flame,
                hottest > 0.0 ? fmt::format("; temperature up to {:.3g} is not kelvin and left out", hottest) : "")};
    FireChoice none;
    if (survey.mapping.flame)
        none.why = "the flame grid is empty";
    if (survey.mapping.temperature)
        none.why += fmt::format("{}temperature up to {:.4g} does not glow", none.why.empty() ? "" : ", and ", hottest);
    if (none.why.empty())
        none.why = "there is no flame and no temperature grid";
    if (!smoke && hottest > 0.0) {
        none.temperature_is_smoke = true;
        none.why += "; there is no smoke either, so that the temperature is shown as smoke";
    }
    return none;
}

FireSettings fire_of(const FireChoice& choice, const SequenceSurvey& survey) {
    FireSettings fire;
    fire.model = FireModel::None;
    const bool flame = most_of(survey, &FrameSurvey::flame) > 0.0;
    if (choice.fire == Fire::Flame) {
        fire.model = FireModel::Flame;
        fire.ramp = soot_ramp(static_cast<float>(most_of(survey, &FrameSurvey::flame)));
        if (flame_outside_smoke(survey) > kOutsideSmoke)
            fire.convention = EmissionConvention::Direct;
    }
    if (choice.fire == Fire::Kelvin) {
        const double hottest = most_of(survey, &FrameSurvey::temperature);
        fire.model = FireModel::Blackbody;
        fire.modulate_by_flame = flame;
        fire.temperature_in = vec2(0.0f, three_digits(hottest));
        fire.temperature_kelvin = vec2(0.0f, three_digits(std::min(hottest, kHottest)));
    }
    if (choice.fire != Fire::None && !(most_of(survey, &FrameSurvey::density) > 0.0))
        fire.convention = EmissionConvention::Direct;
    return fire;
}

}  // namespace brisance
