// What is seen fills the picture; what is not seen does not count.
#include <gtest/gtest.h>

#include <cmath>

#include "ball.h"
#include "camera/camera.h"
#include "medium/medium.h"
#include "shot/read_shot.h"

namespace brisance {
namespace {

dvec3 point_of(const Json& json) {
    return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

// Height of a ball in the picture of the look's camera, over the picture's height.
double height_of_ball(const Look& look, const dvec3& centre, double radius) {
    const double distance = glm::length(point_of(value_of(look, "camera.eye")) - centre);
    return std::tan(std::asin(radius / distance)) / std::tan(0.5 * 35.0 * 3.14159265358979 / 180.0);
}

// The transform of a file whose y is up.
dvec3 turned(const dvec3& p) {
    return {p.x, -p.z, p.y};
}

TEST(FirstLookCamera, ABallFillsMostOfThePictureWhereverItIs) {
    for (const double metres : {0.01, 10.0}) {
        const BlockGrid ball = ball_grid(1.0, 0.5, metres);
        const Look look = decide_look(survey_of(&ball), {});
        const dvec3 centre = turned(dvec3(31.5 * metres));
        const double fill = height_of_ball(look, centre, 16.0 * metres);
        EXPECT_GT(fill, 0.70);
        EXPECT_LT(fill, 0.90);
        const dvec3 eye = point_of(value_of(look, "camera.eye")), target = point_of(value_of(look, "camera.target"));
        const dvec3 aside = glm::cross(glm::normalize(target - eye), centre - eye);
        EXPECT_LT(glm::length(aside), metres) << "the middle of the picture is the ball's";
    }
}

TEST(FirstLookCamera, AVeilThatNobodySeesDoesNotCount) {
    const BlockGrid ball = ball_grid(1.0, 0.3);
    const BlockGrid veiled = shape_grid([](const dvec3& p) {
        return glm::length(p) < 0.3 ? 1.0 : glm::length(p) < 0.95 ? 1e-5 : 0.0;
    });
    const double alone = height_of_ball(decide_look(survey_of(&ball), {}), turned(dvec3(3.15)), 0.96);
    const double with_veil = height_of_ball(decide_look(survey_of(&veiled), {}), turned(dvec3(3.15)), 0.96);
    EXPECT_NEAR(with_veil, alone, 0.05);
}

TEST(FirstLookCamera, FireThatReachesBeyondTheSmokeIsSeenWhole) {
    const BlockGrid smoke = ball_grid(1.0, 0.2), fire = ball_grid(1.0, 0.7);
    const Look look = decide_look(survey_of(&smoke, &fire), {});
    const double fill = height_of_ball(look, turned(dvec3(3.15)), 0.7 * 3.2);
    EXPECT_GT(fill, 0.70);
    EXPECT_LT(fill, 0.95);
}

TEST(FirstLookCamera, APictureOfAnotherAspectKeepsTheSubjectWithinIt) {
    const BlockGrid wide = shape_grid([](const dvec3& p) { return std::abs(p.z) < 0.1 && glm::length(p) < 0.9; });
    SequenceSurvey survey = survey_of(&wide);
    survey.writer = "Blender";
    const Look look = decide_look(survey, {});
    Stated square;
    square.shot.camera.width = square.shot.camera.height = 512;
    const Json as_made = shot_of_look(look, {}), refitted = shot_of_look(look, square);
    const dvec3 target = point_of(as_made["camera"]["target"]);
    const double before = glm::length(point_of(as_made["camera"]["eye"]) - target);
    const double after = glm::length(point_of(refitted["camera"]["eye"]) - target);
    EXPECT_NEAR(after / before, 16.0 / 9.0, 0.05) << "its width counts";
}

}  // namespace
}  // namespace brisance
