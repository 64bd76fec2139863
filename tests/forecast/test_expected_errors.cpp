// What is known of a frame once it has been solved.
#include <gtest/gtest.h>

#include "forecast/expected_errors.h"

namespace brisance {
namespace {

TEST(AsSolved, IsTheLatticeThatTheFrameTook) {
    Shot shot;
    ASSERT_LT(shot.scattering.lattice_level, 0);
    Statistics statistics;
    EXPECT_EQ(as_solved(shot, statistics).scattering.lattice_level, shot.scattering.lattice_level);
    statistics.stages.push_back(
        {"orders of scattering on the coarse lattice", 1.0, 0, {{"nodes", 100}, {"lattice_level", 2}}});
    EXPECT_EQ(as_solved(shot, statistics).scattering.lattice_level, 2);
}

}  // namespace
}  // namespace brisance
