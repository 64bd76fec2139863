#include <gtest/gtest.h>

#include <cmath>

#include "camera/shutter.h"

namespace brisance {
namespace {

TEST(Shutter, AnOpenShutterDividesItsTimeEvenly) {
    ShutterSettings shutter;
    shutter.length = 0.5;
    EXPECT_EQ(shutter_moments(shutter, 2), (std::vector<double>{-0.125, 0.125}));
    shutter.position = ShutterPosition::Start;
    EXPECT_EQ(shutter_moments(shutter, 2), (std::vector<double>{0.125, 0.375}));
    shutter.position = ShutterPosition::End;
    EXPECT_EQ(shutter_moments(shutter, 2), (std::vector<double>{-0.375, -0.125}));
}

TEST(Shutter, AShutterOfNoLengthIsOneMoment) {
    ShutterSettings shutter;
    shutter.length = 0.0;
    EXPECT_EQ(shutter_moments(shutter, 8), std::vector<double>{0.0});
}

// A triangle opens as t^2 / 2: the middles of its quarters lie at sqrt(1/4), sqrt(3/4) of each half.
TEST(Shutter, MomentsAreMiddlesOfEqualSharesOfTheCurve) {
    ShutterSettings shutter;
    shutter.length = 1.0;
    shutter.position = ShutterPosition::Start;
    shutter.curve = {{0.0f, 0.0f}, {0.5f, 1.0f}, {1.0f, 0.0f}};
    const std::vector<double> moments = shutter_moments(shutter, 4);
    const double early = 0.5 * std::sqrt(0.25), late = 0.5 * std::sqrt(0.75);
    ASSERT_EQ(moments.size(), 4u);
    EXPECT_NEAR(moments[0], early, 1e-6);
    EXPECT_NEAR(moments[1], late, 1e-6);
    EXPECT_NEAR(moments[2], 1.0 - late, 1e-6);
    EXPECT_NEAR(moments[3], 1.0 - early, 1e-6);
}

TEST(Shutter, ACurveThatIsClosedAtFirstHasNoMomentThere) {
    ShutterSettings shutter;
    shutter.length = 1.0;
    shutter.position = ShutterPosition::Start;
    shutter.curve = {{0.0f, 0.0f}, {0.5f, 0.0f}, {0.75f, 1.0f}, {1.0f, 1.0f}};
    for (const double moment : shutter_moments(shutter, 16))
        EXPECT_GT(moment, 0.5);
}

}  // namespace
}  // namespace brisance
