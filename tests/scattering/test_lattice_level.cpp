// Bounces on the medium's own lattice follow a series on a coarser one as the error allows.
#include <gtest/gtest.h>

#include "scattering/lattice_level.h"

namespace brisance {
namespace {

TEST(LatticeLevel, FineBouncesFadeInWithTheError) {
    const ScatteringSettings automatic;
    double share = -1.0;
    for (const float error : {0.005f, 0.01f, 0.0125f, 0.015f, 0.0175f, 0.02f, 0.05f}) {
        const double part = share_of_fine_bounces({2, 0.0f}, automatic, error);
        EXPECT_GE(part, share) << error;
        if (share >= 0.0 && error <= 0.02f) {
            EXPECT_LT(part - share, 0.3) << error;
        }
        share = part;
    }
    EXPECT_EQ(share_of_fine_bounces({2, 0.0f}, automatic, 0.01f), 0.0f);
    EXPECT_EQ(share_of_fine_bounces({0, 0.25f}, automatic, 0.02f), 0.25f)
        << "as much as is solved on a coarser lattice";
    EXPECT_EQ(share, 1.0);
    ScatteringSettings none;
    none.fine_bounces = 0;
    EXPECT_EQ(share_of_fine_bounces({2, 0.0f}, none, 0.05f), 0.0f);
}

}  // namespace
}  // namespace brisance
