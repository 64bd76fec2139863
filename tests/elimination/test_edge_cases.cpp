// Degenerate and invalid input.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "core/error.h"
#include "point_fixture.h"

namespace brisance {
namespace {

using testing::adaptive;
using testing::uniform;

const EliminationSettings kBoth[] = {adaptive(), uniform(1.0), adaptive(3), uniform(1.0, 3)};

TEST(EdgeCases, NoPointsAndOnePoint) {
    for (const EliminationSettings& settings : kBoth) {
        EXPECT_TRUE(eliminate({}, 5, settings).index.empty());
        const std::vector<vec3> one{vec3(3.0f)};
        EXPECT_TRUE(eliminate(one, 0, settings).index.empty());
        EXPECT_EQ(eliminate(one, 1, settings).index, std::vector<std::uint32_t>{0});
        EXPECT_EQ(eliminate(one, 7, settings).index, std::vector<std::uint32_t>{0});
    }
    EXPECT_EQ(eliminate(std::vector<vec3>{vec3(3.0f)}, 1, adaptive()).distance[0], 0.0f);
}

TEST(EdgeCases, TwoPoints) {
    for (const EliminationSettings& settings : kBoth) {
        const std::vector<vec3> two{vec3(0.0f), vec3(1.0f)};
        EXPECT_EQ(eliminate(two, 1, settings).index.size(), 1u);
        EXPECT_EQ(eliminate(two, 2, settings).index.size(), 2u);
    }
}

TEST(EdgeCases, AllPointsCoincide) {
    const std::vector<vec3> points(100'000, vec3(1.0f, 2.0f, 3.0f));
    for (const EliminationSettings& settings : kBoth) {
        const Survivors survivors = eliminate(points, 1'000, settings);
        ASSERT_EQ(survivors.index.size(), 1'000u);
        EXPECT_EQ(survivors.index.back(), 999u);  // the first ones
        for (const float d : survivors.distance)
            EXPECT_EQ(d, survivors.distance[0]);
    }
}

// Each point a hundred times: while there are enough positions, no two survivors share one.
TEST(EdgeCases, ManyDuplicates) {
    const std::vector<vec3> positions = testing::sphere(2'000, 40);
    std::vector<vec3> points;
    for (int k = 0; k < 100; ++k)
        points.insert(points.end(), positions.begin(), positions.end());
    for (const EliminationSettings& settings : {adaptive(), uniform(testing::kSphereArea)}) {
        std::set<std::uint32_t> found;
        for (const std::uint32_t i : eliminate(points, 500, settings).index)
            found.insert(i % 2'000);
        EXPECT_EQ(found.size(), 500u);
        found.clear();
        const Survivors more = eliminate(points, 3'000, settings);
        for (const std::uint32_t i : more.index)
            found.insert(i % 2'000);
        EXPECT_EQ(more.index.size(), 3'000u);
        EXPECT_EQ(found.size(), 2'000u);
    }
}

TEST(EdgeCases, CollinearPoints) {
    std::vector<vec3> points = testing::square(20'000, 41);
    for (vec3& p : points)
        p = vec3(p.x, 2.0f * p.x, -p.x);
    for (const EliminationSettings& settings : kBoth)
        EXPECT_EQ(eliminate(points, 300, settings).index.size(), 300u);
}

// Two clusters of a tenth of a millimetre, and one point a thousand kilometres away: each cluster keeps its share,
// within four standard errors of random choice, and its points their distance.
TEST(EdgeCases, TightClustersAndAnOutlier) {
    std::vector<vec3> points = testing::square(10'000, 42);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = (i % 2 ? vec3(0.0f) : vec3(0.001f)) + 1e-4f * points[i];
    points.emplace_back(1e6f);
    for (const EliminationSettings& settings : {adaptive(), uniform(2e-8)}) {
        const Survivors survivors = eliminate(points, 1'000, settings);
        double odd = 0.0;
        for (const std::uint32_t i : survivors.index)
            odd += i % 2;
        EXPECT_NEAR(odd, 500.0, 4.0 * std::sqrt(1'000.0 / 4.0));
        std::vector<vec3> cluster;
        for (const std::uint32_t i : survivors.index)
            if (i % 2)
                cluster.push_back(points[i]);
        EXPECT_GT(testing::spread(cluster, 1e-8).mean, 0.78);
    }
}

// Multiplying by a power of two loses no digit: the same survivors, whatever the unit. Other scales round.
TEST(EdgeCases, ScaleDoesNotMatter) {
    const std::vector<vec3> points = testing::torus(20'000, 43);
    for (const double scale : {0x1p-60, 0x1p-20, 0x1p20, 0x1p60, 1e-6, 1e6}) {
        std::vector<vec3> scaled;
        scaled.reserve(points.size());
        for (const vec3& p : points)
            scaled.emplace_back(dvec3(p) * scale);
        const double area = testing::kTorusArea * scale * scale;
        for (const bool even : {false, true}) {
            const Survivors one = eliminate(points, 2'000, even ? uniform(testing::kTorusArea) : adaptive());
            const Survivors other = eliminate(scaled, 2'000, even ? uniform(area) : adaptive());
            if (std::exp2(std::round(std::log2(scale))) == scale) {
                EXPECT_EQ(other.index, one.index) << scale;
            }
            const testing::Spread s = testing::spread(testing::chosen(points, other), testing::kTorusArea);
            EXPECT_GT(s.mean, 0.78) << scale;
            EXPECT_NEAR(other.distance[0] / scale / 0.1, 1.0, 0.5) << scale;
        }
    }
}

// 10 km away a float is good for a millimetre.
TEST(EdgeCases, FarFromTheOrigin) {
    std::vector<vec3> points = testing::sphere(40'000, 44);
    for (vec3& p : points)
        p = 10.0f * p + vec3(10'000.0f, -20'000.0f, 5'000.0f);
    for (const EliminationSettings& settings : {adaptive(), uniform(100.0 * testing::kSphereArea)}) {
        const std::vector<vec3> survivors = testing::chosen(points, eliminate(points, 4'000, settings));
        const testing::Spread s = testing::spread(survivors, 100.0 * testing::kSphereArea);
        EXPECT_GT(s.least, 0.55);
        EXPECT_GT(s.mean, 0.78);
    }
}

std::string message_of(const std::vector<vec3>& points, const EliminationSettings& settings,
                       const std::vector<std::uint64_t>& ids = {}) {
    try {
        eliminate(points, 1, settings, ids);
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

TEST(EdgeCases, ErrorsSayWhatIsWrongInOneLine) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const std::vector<vec3> good(3, vec3(1.0f));
    for (const float value : {nan, infinity, -infinity}) {
        std::vector<vec3> points = good;
        points[2].y = value;
        EXPECT_EQ(message_of(points, adaptive()), "sample elimination: point 2 is not finite");
    }
    EliminationSettings settings = adaptive();
    settings.dimension = 1;
    EXPECT_EQ(message_of(good, settings), "sample elimination: dimension must be 2 or 3, got 1");
    settings = adaptive();
    settings.neighbours = 0;
    EXPECT_EQ(message_of(good, settings), "sample elimination: neighbours must be at least 1, got 0");
    settings.neighbours = 8;
    settings.stage_ratio = 1.0;
    EXPECT_NE(message_of(good, settings).find("stage_ratio must be above 1"), std::string::npos);
    for (const double measure : {0.0, -1.0, double(nan), double(infinity)})
        EXPECT_NE(message_of(good, uniform(measure)).find("measure must be positive and finite"), std::string::npos);
    EXPECT_EQ(message_of(good, adaptive(), {1, 2}), "sample elimination: 2 ids for 3 points");
    EXPECT_EQ(message_of(good, adaptive()), "");
}

}  // namespace
}  // namespace brisance
