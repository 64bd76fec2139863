// Multi-jittered numbers: every stratum gets its sample, and no sample a stratum of its own.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/multi_jitter.h"

namespace brisance {
namespace {

constexpr Stream kOrder = stream_of("test, order"), kJitter = stream_of("test, jitter");

int stratum(double x, std::uint32_t strata) {
    return int(x * strata);
}

TEST(MultiJitter, FillsCellsColumnsAndRows) {
    for (const std::uint32_t m : {1u, 2u, 3u, 4u, 5u, 7u, 8u})
        for (int pixel = 0; pixel < 50; ++pixel) {
            const MultiJitter among(m, Rng(kOrder, pixel));
            std::set<int> columns, rows, third, cells;
            for (std::uint32_t i = 0; i < m * m; ++i) {
                Rng jitter(kJitter, pixel, i);
                const dvec3 x = among.at(i, jitter);
                for (int a = 0; a < 3; ++a) {
                    ASSERT_GE(x[a], 0.0);
                    ASSERT_LT(x[a], 1.0);
                }
                columns.insert(stratum(x.x, m * m));
                rows.insert(stratum(x.y, m * m));
                third.insert(stratum(x.z, m * m));
                cells.insert(stratum(x.x, m) * int(m) + stratum(x.y, m));
            }
            for (const std::set<int>& filled : {columns, rows, third, cells})
                EXPECT_EQ(filled.size(), m * m) << "side " << m;
        }
}

TEST(MultiJitter, FewSamplesInDifferentRowsAndColumnsOfThePixelLieInDifferentStrata) {
    constexpr std::uint32_t kFew[] = {0 * 4 + 2, 1 * 4 + 0, 2 * 4 + 3, 3 * 4 + 1};
    for (int pixel = 0; pixel < 100; ++pixel) {
        const MultiJitter among(4, Rng(kOrder, pixel));
        std::set<int> x, y;
        for (const std::uint32_t i : kFew) {
            Rng jitter(kJitter, pixel, i);
            const dvec3 at = among.at(i, jitter);
            x.insert(stratum(at.x, 4));
            y.insert(stratum(at.y, 4));
        }
        EXPECT_EQ(x.size(), 4u);
        EXPECT_EQ(y.size(), 4u);
    }
}

// Over the pixels every sample is uniform, or a picture would be wrong in its mean.
TEST(MultiJitter, EachSampleIsUniformOverThePixels) {
    constexpr int kPixels = 64000;
    constexpr std::uint32_t kStrata = 16;
    for (const std::uint32_t sample : {0u, 6u, 15u}) {
        int count[3][kStrata] = {}, together[kStrata] = {};
        for (int pixel = 0; pixel < kPixels; ++pixel) {
            Rng jitter(kJitter, pixel, sample);
            const dvec3 x = MultiJitter(4, Rng(kOrder, pixel)).at(sample, jitter);
            for (int a = 0; a < 3; ++a)
                ++count[a][stratum(x[a], kStrata)];
            ++together[stratum(x.x, 4) * 4 + stratum(x.y, 4)];
        }
        // Five standard deviations of a binomial count: of some 200 counts one in 10^4 tests lies beyond.
        const double mean = double(kPixels) / kStrata, bound = 5.0 * std::sqrt(mean * (1.0 - 1.0 / kStrata));
        for (std::uint32_t s = 0; s < kStrata; ++s) {
            for (int a = 0; a < 3; ++a)
                EXPECT_NEAR(count[a][s], mean, bound) << "sample " << sample << ", number " << a;
            EXPECT_NEAR(together[s], mean, bound) << "sample " << sample;
        }
    }
}

}  // namespace
}  // namespace brisance
