// The medium at other moments of the shutter against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "lighting_grid/voxel_lights.h"
#include "motion/mean_fire.h"
#include "motion/moving_medium.h"
#include "moving_media.h"

namespace brisance {
namespace {

using namespace testing;

// Largest difference of extinction at nodes, over the largest extinction.
double largest_difference(const Medium& a, const Medium& b) {
    double most = 0.0;
    const auto look = [&](const Medium& m, const Medium& other) {
        for (std::size_t i = 0; i < m.extinction.size(); ++i) {
            const std::int64_t k = other.lattice.find_node(m.lattice.node(i));
            most = std::max(most, std::abs(double(m.extinction[i]) - (k < 0 ? 0.0 : other.extinction[std::size_t(k)])));
        }
    };
    look(a, b);
    look(b, a);
    return most / a.max_extinction;
}

// The Gaussian ends where it is exp(-8); rounding decides of which nodes on that rim.
constexpr double kRim = 4e-4;

TEST(MovingMedium, AWholeNumberOfNodesIsExact) {
    const vec3 v(0.4f, -0.2f, 0.0f);
    const Medium medium = with_velocity(gaussian(dvec3(0.0)), everywhere(v));
    const Medium later = MovingMedium(medium, 0.5).at(0.5);
    EXPECT_LT(largest_difference(later, gaussian(0.5 * dvec3(v))), kRim);
    EXPECT_EQ(later.reference_node, medium.reference_node);
}

// Trilinear resampling of a Gaussian of standard deviation s = 5 nodes flattens it by at most 3/8 / s^2 = 1.5 %.
TEST(MovingMedium, AnyTranslationIsRightToItsResampling) {
    const vec3 v(0.33f, 0.17f, -0.71f);
    const Medium medium = with_velocity(gaussian(dvec3(0.0)), everywhere(v));
    const MovingMedium moving(medium, 0.5);
    for (const double frames : {-0.5, 0.21, 0.5}) {
        const Medium then = moving.at(frames);
        EXPECT_LT(largest_difference(then, gaussian(frames * dvec3(v))), 0.016) << frames;
        EXPECT_NEAR(total(then.extinction) / total(medium.extinction), 1.0, 2e-3) << frames;
    }
}

// A quarter turn within the shutter: streamlines are circles, which straight steps would leave by 22 nodes.
TEST(MovingMedium, StreamlinesAreFollowed) {
    const dvec3 from(2.0, 0.0, 0.0), to(0.0, 2.0, 0.0);
    const float turn = 0.5f * 3.14159265f;
    const Medium medium = with_velocity(gaussian(from), [turn](const vec3& p) { return turn * vec3(-p.y, p.x, 0.0f); });
    // The velocity is continued from the smoke, where it is not that of a turning body: only a narrow field is exact.
    const Medium later = MovingMedium(medium, 0.1).at(0.1);
    const double angle = 0.1 * turn;
    const dvec3 there(2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.0);
    EXPECT_LT(largest_difference(later, gaussian(there)), 0.03);
    EXPECT_GT(largest_difference(later, gaussian(to)), 0.5);
}

// The smoke's own bricks end where it ends: it moves into bricks that it did not have.
TEST(MovingMedium, MovesIntoEmptyAir) {
    const vec3 v(2.4f, 0.0f, 0.0f);  // twelve nodes in half a frame
    const Medium medium = with_velocity(gaussian(dvec3(-1.2, 0.0, 0.0)), everywhere(v));
    const Medium later = MovingMedium(medium, 0.5).at(0.5);
    EXPECT_LT(largest_difference(later, gaussian(dvec3(0.0))), kRim);
    EXPECT_LT(later.lattice.brick_count(), medium.lattice.brick_count() * 2);
}

TEST(MovingMedium, LightMovesWithTheSmoke) {
    const vec3 v(0.4f, 0.0f, -0.6f);
    const Medium medium = with_velocity(gaussian(dvec3(0.0)), everywhere(v));
    NodeSources sources;
    for (std::size_t i = 0; i < medium.lattice.node_count(); ++i) {
        const vec3 p = medium.local_of_node(medium.lattice.node(i));
        sources.single.push_back(Rgb(1.0f + p.x, 2.0f - p.z, 1.0f));
    }
    const MovingMedium moving(medium, 0.5);
    const Medium later = moving.at(0.5);
    const NodeSources moved = moved_sources(sources, medium, moving.origins(later.lattice, 0.5));
    ASSERT_EQ(moved.single.size(), later.lattice.node_count());
    EXPECT_TRUE(moved.multiple.empty());
    for (std::size_t i = 0; i < moved.single.size(); ++i) {
        if (!(later.extinction[i] > 1e-3f))
            continue;
        const vec3 p = later.local_of_node(later.lattice.node(i)) - 0.5f * v;
        EXPECT_NEAR(moved.single[i].x, 1.0f + p.x, 1e-4f);
        EXPECT_NEAR(moved.single[i].y, 2.0f - p.z, 1e-4f);
    }
}

// exp(k t) larger along each axis, and as dense: the whole fire grows as exp(3 k t).
TEST(MeanFire, IsAsStrongAsInTheMeanOfTheMoments) {
    constexpr double k = 0.3, length = 1.0;
    constexpr int count = 9;
    const Medium medium = with_velocity(gaussian(dvec3(0.0), 1.0f, 0.6f), [](const vec3& p) { return float(k) * p; });
    const MovingMedium moving(medium, 0.5 * length);
    std::vector<Medium> media;
    for (int i = 0; i < count; ++i)
        media.push_back(moving.at(length * ((i + 0.5) / count - 0.5)));
    std::vector<const Medium*> moments;
    for (const Medium& m : media)
        moments.push_back(&m);
    const dvec3 before = total(voxel_lights(medium)), after = total(voxel_lights(with_mean_fire(medium, moments)));
    const double x = 1.5 * k * length;
    EXPECT_NEAR(after.y / before.y, std::sinh(x) / x, 0.01 * std::sinh(x) / x);
    EXPECT_GT(std::sinh(x) / x, 1.03);
    const Medium* const itself = &medium;
    EXPECT_NEAR(total(voxel_lights(with_mean_fire(medium, {&itself, 1}))).x, before.x, 1e-5 * before.x);
}

}  // namespace
}  // namespace brisance
