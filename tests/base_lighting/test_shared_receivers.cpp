// Sharing of receivers by the surface samples of a pixel.
#include "base_lighting/shared_receivers.h"

#include <gtest/gtest.h>

#include "fixtures/media.h"

namespace brisance {
namespace {

using namespace testing;

const vec3 kUp(0, 0, 1);

const SurfaceReceiver& of_sample(const SharedReceivers& shared, std::size_t sample) {
    return shared[shared.receiver_of()[sample]];
}

// A ball of radius 1 m around the origin; bricks of 8 voxels reach about a metre farther.
Medium ball() {
    return make_medium(glowing_ball(8, 2.0f));
}

TEST(SharedReceivers, LieInTheMiddleOfTheirSamples) {
    const Medium medium = ball();
    SharedReceivers shared(medium);
    shared.add(7, {0.0f, 0.0f, -20.0f}, kUp);
    shared.add(7, {0.2f, 0.0f, -20.0f}, kUp);
    shared.add(7, {0.1f, 0.3f, -20.0f}, glm::normalize(vec3(0.02f, 0.0f, 1.0f)));
    ASSERT_EQ(shared.receivers().size(), 1u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(glm::distance(of_sample(shared, i).local, vec3(0.1f, 0.1f, -20.0f)), 0.0f, 1e-6f);
        EXPECT_NEAR(glm::length(of_sample(shared, i).normal), 1.0f, 1e-6f);
    }
}

TEST(SharedReceivers, OneSampleKeepsItsPosition) {
    const Medium medium = ball();
    SharedReceivers shared(medium);
    const vec3 position(0.3f, -0.7f, -3.1f), normal = glm::normalize(vec3(0.3f, 0.2f, 0.9f));
    shared.add(1, position, normal);
    ASSERT_EQ(shared.receivers().size(), 1u);
    EXPECT_EQ(of_sample(shared, 0).local, position);
    EXPECT_EQ(of_sample(shared, 0).normal, normal);
}

TEST(SharedReceivers, AreNotSharedFromPixelToPixelNorRoundACorner) {
    const Medium medium = ball();
    SharedReceivers shared(medium);
    shared.add(1, {0, 0, -20}, kUp);
    shared.add(1, {0, 0, -20}, {1, 0, 0});
    shared.add(2, {0, 0, -20}, kUp);
    shared.add(2, {0, 5, -20}, kUp);
    shared.add(2, {0, 0.1f, -20}, kUp);
    EXPECT_EQ(shared.receivers().size(), 4u);
    EXPECT_EQ(of_sample(shared, 2).local, of_sample(shared, 4).local);
}

// In the smoke light changes from voxel to voxel: 0.125 m.
TEST(SharedReceivers, ReachLessFarNearTheSmoke) {
    const Medium medium = ball();
    const auto shares = [&](float z, float apart) {
        SharedReceivers shared(medium);
        shared.add(1, {0, 0, z}, kUp);
        shared.add(1, {apart, 0, z}, kUp);
        return shared.receivers().size() == 1;
    };
    EXPECT_TRUE(shares(-0.5f, 0.02f));
    EXPECT_FALSE(shares(-0.5f, 0.05f));
    EXPECT_TRUE(shares(-12.0f, 0.4f));
    EXPECT_FALSE(shares(-12.0f, 0.7f));
}

}  // namespace
}  // namespace brisance
