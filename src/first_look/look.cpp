#include "first_look/look.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "first_look/decide_fire.h"
#include "first_look/up_axis.h"
#include "first_look/view.h"
#include "volume/settings.h"

namespace brisance {

namespace {

constexpr double kSmokeDepth = 6.0;      // optical depth of a mean line of sight through smoke that does not burn
constexpr double kSootDepth = 12.0;      // and through a fire's: it hides the core in places
constexpr double kSmokeAlbedo = 0.9;     // of steam, dust and thin smoke
constexpr double kSootAlbedo = 0.35;     // of a sooty fire's smoke
constexpr double kFireBrightness = 1.2;  // of a fire's bright parts at 0 stops [W/(m^2 sr)]

// Lights, for pictures at 0 stops.
const Rgb kSun(5.5f, 5.2f, 4.7f);       // irradiance [W/m^2]
const Rgb kDay(0.07f, 0.088f, 0.115f);  // radiance [W/(m^2 sr)]
const Rgb kMoon(1.2f, 1.35f, 1.6f);
const Rgb kDusk(0.025f, 0.031f, 0.042f);

double two_digits(double value) {
    if (!(value > 0.0) || !std::isfinite(value))
        return value;
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
    return std::stod(fmt::format("{:.2g}", std::round(value / unit) * unit));
}

class Decider {
public:
    Decider(const SequenceSurvey& survey, const Stated& stated, bool only_camera)
        : survey_(survey), stated_(stated), only_camera_(only_camera) {
        look_.volume = survey.name;
        look_.frames = survey.frames;
        for (const FrameSurvey& frame : survey.seen)
            look_.looked_at.push_back(frame.frame);
        look_.aspect = double(stated.shot.camera.width) / stated.shot.camera.height;
        medium_ = stated.shot.medium;
    }

    Look decide() {
        decide_grids();
        decide_up();
        const FireChoice fire = choose_fire(survey_);
        decide_fire(fire);
        make_views(fire.temperature_is_smoke);
        decide_smoke();
        decide_strength();
        decide_lights();
        decide_camera();
        decide("output.exposure_stops", 0.0, "fire and lights are as strong as a picture at 0 stops wants them");
        return std::move(look_);
    }

private:
    bool is_stated(const std::string& key) const {
        return stated_.has(key) || (only_camera_ && !key.starts_with("camera."));
    }

    // Does nothing where the user has stated the key. Returns whether it was open.
    bool decide(const std::string& key, Json value, const std::string& why) {
        if (is_stated(key))
            return false;
        look_.decisions.push_back({key, std::move(value), why});
        return true;
    }

    void decide_grids() {
        if (!survey_.mapping_of_all && survey_.frames.size() > 1) {
            look_.warnings.push_back("not every frame has the same grids: roles are found by name in each frame");
            return;
        }
        const GridMapping& mapping = survey_.mapping;
        for (const auto& [role, choice] :
             {std::pair("density", &mapping.density), {"flame", &mapping.flame}, {"temperature", &mapping.temperature}})
            if (*choice)
                decide(fmt::format("volume.grids.{}", role), (*choice)->shot_name(), (*choice)->reason);
    }

    void decide_up() {
        const UpAxis up = guess_up_axis(survey_);
        if (decide("volume.up", up.axis == 'y' ? "z" : "y", fmt::format("the file's {} is up: {}", up.axis, up.why)))
            up_ = up.axis == 'y' ? 'z' : 'y';
        else
            up_ = stated_.shot.volume.up;
    }

    void keep_stated(FireSettings& fire) const {
        const FireSettings& stated = stated_.shot.medium.fire;
        fire.threshold = stated.threshold, fire.colour = stated.colour;
        const auto keep = [&](const char* key, auto member) {
            if (stated_.has(key))
                fire.*member = stated.*member;
        };
        keep("fire.strength", &FireSettings::strength);
        keep("fire.convention", &FireSettings::convention);
        keep("fire.ramp", &FireSettings::ramp);
        keep("fire.modulate_by_flame", &FireSettings::modulate_by_flame);
        keep("fire.temperature_in", &FireSettings::temperature_in);
        keep("fire.temperature_kelvin", &FireSettings::temperature_kelvin);
    }

    void decide_fire(const FireChoice& choice) {
        FireSettings fire = fire_of(choice, survey_);
        static constexpr const char* kModels[] = {"none", "flame", "blackbody"};
        if (!decide("fire.model", kModels[static_cast<int>(choice.fire)], choice.why))
            return;  // the rest belongs to it
        keep_stated(fire);
        medium_.fire = fire;
        if (choice.temperature_is_smoke) {
            std::erase_if(look_.decisions, [](const LookDecision& d) { return d.key.starts_with("volume.grids."); });
            decide("volume.grids.density", survey_.mapping.temperature->shot_name(), "nothing else can be seen");
            decide("volume.grids.temperature", "", "it is shown as smoke");
        }
        if (choice.fire == Fire::None)
            return;
        const bool direct = fire.convention == EmissionConvention::Direct;
        decide("fire.convention", direct ? "direct" : "times_absorption",
               direct ? "much of the fire has no smoke around it and must shine without" : "what absorbs shines");
        if (choice.fire == Fire::Flame)
            decide("fire.ramp", ramp().write(fire.ramp), "soot, from dull red to yellow white");
        if (choice.fire != Fire::Kelvin)
            return;
        decide("fire.modulate_by_flame", fire.modulate_by_flame,
               fire.modulate_by_flame ? "where there is no flame, nothing glows" : "there is no flame grid");
        const auto range = [](const vec2& v) { return Json{shortest_decimal(v.x), shortest_decimal(v.y)}; };
        decide("fire.temperature_in", range(fire.temperature_in), "values of the grid");
        decide("fire.temperature_kelvin", range(fire.temperature_kelvin),
               fire.temperature_in == fire.temperature_kelvin ? "they are kelvin" : "the hottest soot that fires have");
    }

    void make_views(bool temperature_is_smoke) {
        VolumeSettings volume = stated_.shot.volume;
        volume.up = up_;
        const dmat4 world_from_file = placement(volume, survey_.name);
        for (const FrameSurvey& frame : survey_.seen) {
            views_.push_back(make_view(frame, world_from_file, axes_));
            for (ViewCell& c : views_.back().cells)
                if (temperature_is_smoke)
                    c.cell.density = c.cell.temperature;
        }
    }

    bool burns() const { return medium_.fire.model != FireModel::None; }

    void decide_smoke() {
        const bool soot = burns();
        const double albedo = soot ? kSootAlbedo : kSmokeAlbedo;
        if (decide("smoke.albedo", {albedo, albedo, albedo},
                   soot ? "soot: dark around a bright core" : "nothing burns: bright smoke"))
            medium_.smoke.albedo = Rgb(static_cast<float>(albedo));
        double most = 0.0;
        for (const View& view : views_)
            most = std::max(most, column_depth(view, axes_));
        const double depth = soot ? kSootDepth : kSmokeDepth;
        const double extinction = most > 0.0 ? two_digits(depth / most) : 1.0;
        if (decide("smoke.extinction_per_metre", extinction,
                   most > 0.0 ? fmt::format("the thickest frame's line of sight, {:.3g} of density times metres in the "
                                            "mean, gets an optical depth of {:g}",
                                            most, depth)
                              : "there is no density above zero"))
            medium_.smoke.extinction_per_metre = static_cast<float>(extinction);
    }

    void decide_strength() {
        double brightest = 0.0;
        for (const View& view : views_)
            brightest = std::max(brightest, look_through(view, axes_, medium_).brightness);
        if (!burns() || !(brightest > 0.0) || is_stated("fire.strength"))
            return;
        const double strength = two_digits(kFireBrightness / brightest);
        decide("fire.strength", strength,
               fmt::format("the bright parts of the brightest frame get a luminance near {:g}", kFireBrightness));
        medium_.fire.strength = static_cast<float>(strength);
    }

    void decide_lights() {
        const auto power = [](const Rgb& p) {
            return Json{shortest_decimal(p.x), shortest_decimal(p.y), shortest_decimal(p.z)};
        };
        const bool fire = burns();
        if (fire && stated_.shot.seconds > 0.0) {
            decide("scene.lights", Json::array(), "a time is given, and times of lamps cannot be forecast: fire alone");
            return;
        }
        const Json key = {{"kind", "sun"},
                          {"name", "key"},
                          {"direction", {0.85, 0.25, -0.55}},
                          {"angle_degrees", 2.0},
                          {"power", power(fire ? kMoon : kSun)}};
        const Json sky = {{"kind", "environment"}, {"name", "sky"}, {"power", power(fire ? kDusk : kDay)}};
        decide("scene.lights", Json::array({key, sky}),
               fire ? "a dim sky and key, so that smoke can be seen where its fire has gone out"
                    : "nothing burns: a key light from the left and above, and a soft sky");
    }

    void decide_camera() {
        if (stated_.shot.camera_given)
            return;
        std::vector<Seen> seen;
        for (const View& view : views_)
            seen.push_back(look_through(view, axes_, medium_));
        const std::optional<Framing> framing =
            frame_on(views_, seen, axes_, stated_.shot.camera.vertical_fov_degrees, look_.aspect, kLookFill);
        if (!framing) {
            look_.warnings.push_back("there is nothing to see in the frames that were looked at: no smoke, no fire");
            return;
        }
        const auto point = [&](const dvec3& p) {
            const double unit = std::pow(10.0, std::floor(std::log10(glm::length(framing->eye - framing->target))) - 3);
            const auto rounded = [&](double v) {
                return std::stod(fmt::format("{:.10g}", std::round(v / unit) * unit));
            };
            return Json{rounded(p.x), rounded(p.y), rounded(p.z)};
        };
        decide("camera.eye", point(framing->eye), "from the front, slightly above and from the right");
        decide("camera.target", point(framing->target),
               fmt::format("all frames' visible smoke and fire fill {:.0f} % of the width and {:.0f} % of the height",
                           100.0 * framing->fill[0], 100.0 * framing->fill[1]));
        decide("camera.up", {0.0, 0.0, 1.0}, "the world's z is up");
        std::copy_n(framing->fill, 2, look_.fill);
    }

    const SequenceSurvey& survey_;
    const Stated& stated_;
    const bool only_camera_;
    const ViewAxes axes_ = first_view();
    Look look_;
    MediumSettings medium_;
    std::vector<View> views_;
    char up_ = 'y';
};

}  // namespace

const LookDecision* Look::find(const std::string& key) const {
    const auto found = std::ranges::find(decisions, key, &LookDecision::key);
    return found == decisions.end() ? nullptr : &*found;
}

Look decide_look(const SequenceSurvey& survey, const Stated& stated) {
    return Decider(survey, stated, false).decide();
}

Look decide_camera(const SequenceSurvey& survey, const Stated& stated) {
    return Decider(survey, stated, true).decide();
}

}  // namespace brisance
