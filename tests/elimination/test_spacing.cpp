// The distances of survivors. Bounds are a little below the results of other seeds.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>

#include "point_fixture.h"

namespace brisance {
namespace {

using testing::adaptive;
using testing::chosen;
using testing::Spread;
using testing::uniform;

void print(const char* name, const Spread& s) {
    std::printf("%s: nearest neighbour at %.3f d_max at least, %.3f on average\n", name, s.least, s.mean);
}

TEST(Spacing, IsCloseToThatOfTheClosestPacking) {
    struct Domain {
        const char* name;
        std::vector<vec3> points;
        EliminationSettings settings;
        double measure, margin, least, mean;
    };
    const std::vector<vec3> square = testing::square(60'000, 20), cube = testing::cube(60'000, 21);
    const std::vector<vec3> sphere = testing::sphere(60'000, 22), torus = testing::torus(60'000, 23);
    const double sphere_area = testing::kSphereArea, torus_area = testing::kTorusArea;
    for (const Domain& d : {Domain{"square, uniform", square, uniform(1.0), 1.0, 0.05, 0.72, 0.81},
                            Domain{"square, adaptive", square, adaptive(), 1.0, 0.05, 0.58, 0.79},
                            Domain{"sphere, uniform", sphere, uniform(sphere_area), sphere_area, 0.0, 0.72, 0.80},
                            Domain{"sphere, adaptive", sphere, adaptive(), sphere_area, 0.0, 0.58, 0.79},
                            Domain{"torus, uniform", torus, uniform(torus_area), torus_area, 0.0, 0.72, 0.80},
                            Domain{"torus, adaptive", torus, adaptive(), torus_area, 0.0, 0.58, 0.79},
                            Domain{"cube, uniform", cube, uniform(1.0, 3), 1.0, 0.1, 0.70, 0.77},
                            Domain{"cube, adaptive", cube, adaptive(3), 1.0, 0.1, 0.60, 0.73}}) {
        const Survivors survivors = eliminate(d.points, 6'000, d.settings);
        const Spread s = testing::spread(chosen(d.points, survivors), d.measure, d.settings.dimension, d.margin);
        print(d.name, s);
        EXPECT_GT(s.least, d.least) << d.name;
        EXPECT_GT(s.mean, d.mean) << d.name;
    }
}

// What is lost by going down 100 to 1 in two stages.
TEST(Spacing, OfStagesIsNearlyThatOfOneStage) {
    const std::vector<vec3> points = testing::square(100'000, 24);
    EliminationSettings settings = uniform(1.0);
    const Spread stages = testing::spread(chosen(points, eliminate(points, 1'000, settings)), 1.0, 2, 0.1);
    settings.stage_ratio = testing::kOneStage;
    const Spread one = testing::spread(chosen(points, eliminate(points, 1'000, settings)), 1.0, 2, 0.1);
    print("stages", stages);
    print("one stage", one);
    EXPECT_GT(stages.mean, 0.97 * one.mean);
    EXPECT_GT(stages.least, 0.94 * one.least);
}

// Blue noise: next to no power well below the frequency of the hexagonal lattice, a peak about it, and 1 far above.
TEST(Spacing, HasTheSpectrumOfBlueNoise) {
    const std::vector<vec3> points = testing::square(20'000, 25);
    constexpr int n = 2'000, frequencies = 200;
    for (const EliminationSettings& settings : {uniform(1.0), adaptive()}) {
        const std::vector<double> power =
            testing::power_spectrum(chosen(points, eliminate(points, n, settings)), frequencies);
        const double lattice = std::sqrt(n * 2.0 / std::sqrt(3.0));
        const auto mean = [&](double from, double to) {
            double sum = 0.0;
            for (int f = int(from * lattice); f < int(to * lattice); ++f)
                sum += power[f] / (int(to * lattice) - int(from * lattice));
            return sum;
        };
        std::printf("power below half the lattice's frequency %.3f, about it %.2f, at 3 to 4 times %.2f\n",
                    mean(0.1, 0.5), mean(0.9, 1.1), mean(3.0, 4.0));
        EXPECT_LT(mean(0.1, 0.5), 0.15);
        // 1.7 with one radius; adaptive radii blur the peak to about 1.5, from one set of points to the next.
        EXPECT_GT(mean(0.9, 1.1), 1.35);
        EXPECT_NEAR(mean(3.0, 4.0), 1.0, 0.1);
    }
}

// The trees of candidates and the blocks that run in parallel meet at x or y = 1/2, 1/4, 3/4, ...: points there are
// spread as elsewhere. Differences within four standard errors (1 chance in 16 000 each).
TEST(Spacing, ShowsNoSeams) {
    constexpr std::size_t n = 20'000;
    const std::vector<vec3> points = testing::square(10 * n, 26);
    for (const EliminationSettings& settings : {uniform(1.0), adaptive()}) {
        const std::vector<vec3> survivors = chosen(points, eliminate(points, n, settings));
        const std::vector<double> nearest = testing::nearest_distances(survivors);
        double sum[2] = {}, squares[2] = {}, count[2] = {};
        const double width = 2.0 * std::sqrt(1.0 / (2.0 * std::sqrt(3.0) * n));
        for (std::size_t i = 0; i < survivors.size(); ++i) {
            const vec3& p = survivors[i];
            if (std::min(p.x, p.y) < 0.05f || std::max(p.x, p.y) > 0.95f)
                continue;
            const auto from_plane = [](float x) { return std::abs(4.0 * x - std::round(4.0 * x)) / 4.0; };
            const int seam = std::min(from_plane(p.x), from_plane(p.y)) < width ? 1 : 0;
            sum[seam] += nearest[i];
            squares[seam] += nearest[i] * nearest[i];
            count[seam] += 1.0;
        }
        double mean[2], variance[2];
        for (int k = 0; k < 2; ++k) {
            mean[k] = sum[k] / count[k];
            variance[k] = (squares[k] / count[k] - mean[k] * mean[k]) / count[k];
        }
        EXPECT_NEAR(mean[1], mean[0], 4.0 * std::sqrt(variance[0] + variance[1]));
        // Counts vary less than those of random points.
        const double share = 1.0 - std::pow(0.9 - 6.0 * width, 2) / 0.81;
        const double expected = share * (count[0] + count[1]);
        std::printf("at seams %.0f points for %.0f, nearest at %.4f of elsewhere\n", count[1], expected,
                    mean[1] / mean[0]);
        EXPECT_NEAR(count[1], expected, 4.0 * std::sqrt(expected * (1.0 - share)));
    }
}

}  // namespace
}  // namespace brisance
