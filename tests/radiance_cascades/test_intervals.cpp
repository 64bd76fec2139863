// Intervals of rays from many probes at once.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "radiance_cascades/interval_kernels.h"

namespace brisance {
namespace {

constexpr int kWide = 12;

// A block with a source function and an extinction that are linear in the node.
struct Block {
    std::vector<float> values;
    std::vector<std::int32_t> probes;

    explicit Block(float extinction) {
        for (int x = 0; x < kWide; ++x)
            for (int y = 0; y < kWide; ++y)
                for (int z = 0; z < kWide; ++z)
                    values.insert(values.end(), {1.0f, 2.0f + float(x), 3.0f + 0.5f * float(z), extinction});
        for (int p = 0; p < 16; ++p)
            probes.push_back((2 * kWide + 3 + p % 4) * kWide + 2 + p / 4);
    }
    IntervalMarch march(int samples, float length, const std::uint8_t* unhidden = nullptr) const {
        const float step = 4.0f / float(samples);
        return {values.data(),
                kWide * kWide,
                kWide,
                probes.data(),
                16,
                {0.25f + 0.5f * step, 0.25f, 0.5f},
                {step, 0.0f, 0.0f},
                samples,
                length / float(samples),
                unhidden};
    }
};

TEST(Intervals, ConstantSmokeIsExactAndKeepsItsDigits) {
    for (const float depth : {1e-12f, 1e-6f, 0.1f, 1.0f, 10.0f}) {
        Intervals out;
        march_intervals(Block(depth / 4.0f).march(5, 4.0f), out);
        for (int p = 0; p < 16; ++p) {
            EXPECT_NEAR(out.red[p] / -std::expm1(-double(depth)), 1.0, 1e-5) << depth;
            EXPECT_NEAR(out.transmittance[p], std::exp(-double(depth)), 1e-6) << depth;
        }
    }
}

TEST(Intervals, TheSourceIsInterpolatedWhereTheRayIs) {
    Intervals out;
    const Block block(1e-4f);
    march_intervals(block.march(8, 4.0f), out);
    for (int p = 0; p < 16; ++p) {
        const double z = 2 + p / 4 + 0.5, x = 2 + 0.25 + 2.0;  // in the middle of the ray
        EXPECT_NEAR(out.green[p] / out.red[p], 2.0 + x, 1e-3);
        EXPECT_NEAR(out.blue[p] / out.red[p], 3.0 + 0.5 * z, 1e-3);
    }
}

TEST(Intervals, NothingComesFromBehindASurface) {
    std::vector<std::uint8_t> unhidden(16, 255);
    unhidden[3] = 0;
    unhidden[5] = 2;
    Intervals all, cut;
    const Block block(0.2f);
    march_intervals(block.march(4, 4.0f), all);
    march_intervals(block.march(4, 4.0f, unhidden.data()), cut);
    for (int p = 0; p < 16; ++p) {
        const double part = p == 3 ? 0.0 : p == 5 ? -std::expm1(-0.4) : -std::expm1(-0.8);
        EXPECT_NEAR(cut.red[p], part, 1e-5) << p;
        EXPECT_EQ(cut.transmittance[p], p == 3 || p == 5 ? 0.0f : all.transmittance[p]);
    }
}

}  // namespace
}  // namespace brisance
