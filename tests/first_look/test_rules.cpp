// Each rule of a first look on shapes whose answer is known.
#include <gtest/gtest.h>

#include <cmath>

#include "ball.h"
#include "first_look/up_axis.h"
#include "first_look/view.h"
#include "shot/read_shot.h"

namespace brisance {
namespace {

std::string model_of(const SequenceSurvey& survey) {
    return value_of(decide_look(survey, {}), "fire.model").get<std::string>();
}

TEST(FirstLookFire, AnEmptyFlameGridIsNoFireWhateverTheTemperature) {
    const BlockGrid smoke = ball_grid(0.7), nothing = ball_grid(0.0), lukewarm = ball_grid(1.0), hot = ball_grid(2.9);
    EXPECT_EQ(model_of(survey_of(&smoke, &nothing, &lukewarm)), "none");
    EXPECT_EQ(model_of(survey_of(&smoke, &nothing, &hot)), "none");
}

TEST(FirstLookFire, ATemperatureOfFewUnitsIsNoFireAndKelvinThatGlowIs) {
    const BlockGrid smoke = ball_grid(0.7), few = ball_grid(4.0), room = ball_grid(320.0), hot = ball_grid(1800.0);
    EXPECT_EQ(model_of(survey_of(&smoke, nullptr, &few)), "none");
    EXPECT_EQ(model_of(survey_of(&smoke, nullptr, &room)), "none");
    const Look look = decide_look(survey_of(&smoke, nullptr, &hot), {});
    EXPECT_EQ(value_of(look, "fire.model"), "blackbody");
    EXPECT_EQ(value_of(look, "fire.temperature_kelvin")[1], 1800.0);
    EXPECT_EQ(value_of(look, "fire.modulate_by_flame"), false);
}

TEST(FirstLookFire, AFlameBurnsAndTemperaturesInKelvinGiveItsColour) {
    const BlockGrid smoke = ball_grid(0.7), flame = ball_grid(5.0), few = ball_grid(2.9), kelvin = ball_grid(1900.0);
    EXPECT_EQ(model_of(survey_of(&smoke, &flame, &few)), "flame");
    const Look look = decide_look(survey_of(&smoke, &flame, &kelvin), {});
    EXPECT_EQ(value_of(look, "fire.model"), "blackbody");
    EXPECT_EQ(value_of(look, "fire.modulate_by_flame"), true);
}

TEST(FirstLookFire, FlameWithoutSmokeAroundItShinesDirectly) {
    const BlockGrid smoke = ball_grid(0.7, 0.4), wide = ball_grid(1.0, 0.8), inside = ball_grid(1.0, 0.35);
    EXPECT_EQ(value_of(decide_look(survey_of(&smoke, &wide), {}), "fire.convention"), "direct");
    EXPECT_EQ(value_of(decide_look(survey_of(&smoke, &inside), {}), "fire.convention"), "times_absorption");
    EXPECT_EQ(value_of(decide_look(survey_of(nullptr, &wide), {}), "fire.convention"), "direct");
}

TEST(FirstLookFire, BrightPartsAreOfOrderOneWhateverTheUnits) {
    for (const double flame : {0.01, 1.0, 40.0}) {
        const BlockGrid smoke = ball_grid(1.0), fire = shape_grid([&](const dvec3&p) {
                                                    return flame * std::max(0.0, 1.0 - 1.5 * glm::length(p));
                                                });
        const SequenceSurvey survey = survey_of(&smoke, &fire);
        const Look look = decide_look(survey, {});
        const Shot shot = parse_shot(shot_of_look(look, {}).dump(), "look", {}, {{}, {"volume.file=a.vdb"}});
        const ViewAxes axes = first_view();
        const double bright = look_through(make_view(survey.seen[0], dmat4(1.0), axes), axes, shot.medium).brightness;
        EXPECT_GT(bright, 1.0);
        EXPECT_LT(bright, 1.4);
    }
}

TEST(FirstLookSmoke, WithoutFireAKeyAndASkyShine) {
    const BlockGrid smoke = ball_grid(0.7);
    const Json lights = value_of(decide_look(survey_of(&smoke), {}), "scene.lights");
    ASSERT_EQ(lights.size(), 2u);
    EXPECT_EQ(lights[0]["kind"], "sun");
    EXPECT_EQ(lights[1]["kind"], "environment");
}

TEST(FirstLookSmoke, FireGetsDarkSmokeAndADimSky) {
    const BlockGrid smoke = ball_grid(0.7), flame = ball_grid(1.0);
    const Look look = decide_look(survey_of(&smoke, &flame), {});
    EXPECT_LT(value_of(look, "smoke.albedo")[0], 0.5);
    const Json with_fire = value_of(look, "scene.lights");
    const Json without = value_of(decide_look(survey_of(&smoke), {}), "scene.lights");
    ASSERT_EQ(with_fire.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_LT(with_fire[i]["power"][1], 0.5 * without[i]["power"][1].get<double>());
}

// A ball's mean line of sight, weighted by itself, is three quarters of its diameter.
TEST(FirstLookSmoke, TheOpticalDepthDoesNotDependOnUnits) {
    for (const double density : {0.01, 30.0})
        for (const double metres : {0.001, 1.0}) {
            const BlockGrid smoke = ball_grid(density, 0.5, metres);
            const double extinction = value_of(decide_look(survey_of(&smoke), {}), "smoke.extinction_per_metre");
            const double depth = extinction * density * 0.75 * 32.0 * metres;
            EXPECT_GT(depth, 4.0);
            EXPECT_LT(depth, 8.0);
        }
}

TEST(FirstLookSmoke, ALoneTemperatureThatDoesNotGlowIsShownAsSmoke) {
    const BlockGrid warm = ball_grid(1.0);
    const Look look = decide_look(survey_of(nullptr, nullptr, &warm), {});
    EXPECT_EQ(value_of(look, "volume.grids.density"), "temperature");
    EXPECT_EQ(value_of(look, "fire.model"), "none");
}

TEST(FirstLookSmoke, NothingIsDividedByNothing) {
    const BlockGrid nothing = ball_grid(0.0);
    const Look look = decide_look(survey_of(&nothing, &nothing, &nothing), {});
    EXPECT_EQ(value_of(look, "smoke.extinction_per_metre"), 1.0);
    EXPECT_EQ(look.find("camera.eye"), nullptr);
    EXPECT_FALSE(look.warnings.empty());
}

SequenceSurvey moving(const dvec3& way) {
    SequenceSurvey survey;
    for (int frame = 1; frame <= 3; ++frame) {
        const BlockGrid ball =
            shape_grid([&](const dvec3& p) { return glm::length(p - 0.2 * (frame - 2.0) * way) < 0.3 ? 1.0 : 0.0; });
        survey.seen.push_back(survey_frame(frame, &ball, nullptr, nullptr));
        survey.frames.push_back(frame);
    }
    return survey;
}

TEST(FirstLookUp, TheWriterDecidesThenMovementThenAFloorThenY) {
    SequenceSurvey rising_y = moving({0.1, 1.0, 0.2}), rising_z = moving({0.1, 0.2, 1.0});
    EXPECT_EQ(guess_up_axis(rising_y).axis, 'y');
    EXPECT_EQ(guess_up_axis(rising_z).axis, 'z');
    rising_y.writer = "Blender 3.4.1 Mantaflow";
    EXPECT_EQ(guess_up_axis(rising_y).axis, 'z');
    rising_z.writer = "Houdini 20.5.584/GEO_VDBTranslator";
    EXPECT_EQ(guess_up_axis(rising_z).axis, 'y');
    const auto dome = [](int axis) {
        return shape_grid([axis](const dvec3& p) { return p[axis] > 0.0 && glm::length(p) < 0.8 ? 1.0 : 0.0; });
    };
    const BlockGrid on_y = dome(1), on_z = dome(2), ball = ball_grid(1.0);
    EXPECT_EQ(guess_up_axis(survey_of(&on_y)).axis, 'y');
    EXPECT_EQ(guess_up_axis(survey_of(&on_z)).axis, 'z');
    EXPECT_EQ(guess_up_axis(survey_of(&ball)).axis, 'y');
}

TEST(FirstLookUp, AFileWithYUpIsTurned) {
    SequenceSurvey survey = moving({0.0, 1.0, 0.0});
    EXPECT_EQ(value_of(decide_look(survey, {}), "volume.up"), "z");
    survey.writer = "Blender";
    EXPECT_EQ(value_of(decide_look(survey, {}), "volume.up"), "y");
}

}  // namespace
}  // namespace brisance
