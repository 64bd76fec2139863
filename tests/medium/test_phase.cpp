// Phase functions are normalised, and have their mean cosine.
#include <gtest/gtest.h>

#include <vector>

#include "medium/phase.h"

namespace brisance {
namespace {

// Cosines from -1 to 1, each a float, dense in proportion to the distance from the peak.
std::vector<float> cosines(float g) {
    std::vector<float> list;
    for (int i = 0; i <= 200000; ++i) {
        const double away = 2.0 * std::exp(-18.0 * i / 200000.0);
        const float cosine = static_cast<float>(i == 200000 ? 1.0 : 1.0 - away);
        if (list.empty() || cosine > list.back())
            list.push_back(cosine);
    }
    if (g < 0.0f)
        for (float& c : list)
            c = -c;
    return list;
}

TEST(Phase, IntegratesToOneWithTheMeanCosineItIsNamedAfter) {
    for (const float g : {0.0f, 0.3f, -0.3f, 0.75f, 0.9f, -0.9f, 0.99f, 0.999f, -0.999f}) {
        double total = 0.0, mean = 0.0;
        const std::vector<float> list = cosines(g);
        for (std::size_t i = 0; i + 1 < list.size(); ++i) {
            const double width = std::abs(double(list[i + 1]) - list[i]);
            const double a = henyey_greenstein(list[i], g), b = henyey_greenstein(list[i + 1], g);
            total += 0.5 * (a + b) * width;
            mean += 0.5 * (a * list[i] + b * list[i + 1]) * width;
        }
        const double pi = 3.14159265358979323846;
        EXPECT_NEAR(2.0 * pi * total, 1.0, 2e-3) << "g = " << g;
        EXPECT_NEAR(2.0 * pi * mean, g, 2e-3) << "g = " << g;
    }
}

TEST(Phase, ForwardOfOneSignIsBackwardOfTheOther) {
    for (const float cosine : {-1.0f, -0.4f, 0.0f, 0.7f, 1.0f})
        EXPECT_EQ(henyey_greenstein(cosine, 0.6f), henyey_greenstein(-cosine, -0.6f));
    EXPECT_GT(henyey_greenstein(1.0f, 0.6f), henyey_greenstein(-1.0f, 0.6f));
}

TEST(Phase, IsotropicIsTheSameEverywhere) {
    for (const float cosine : {-1.0f, 0.0f, 1.0f})
        EXPECT_NEAR(henyey_greenstein(cosine, 0.0f), 1.0f / (4.0f * kPi), 1e-8f);
}

}  // namespace
}  // namespace brisance
