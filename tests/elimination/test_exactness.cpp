// The survivors are the same in parallel and one by one, in any order, and for any number of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/parallel.h"
#include "core/rng.h"
#include "point_fixture.h"

namespace brisance {
namespace {

using testing::adaptive;
using testing::uniform;

struct Case {
    const char* name;
    std::vector<vec3> points;
    std::size_t target;
    EliminationSettings settings;
};

// On a lattice most weights are equal, and ranks decide.
std::vector<vec3> lattice(int side) {
    std::vector<vec3> points;
    for (int x = 0; x < side; ++x)
        for (int y = 0; y < side; ++y)
            points.emplace_back(x / float(side), y / float(side), 0.0f);
    return points;
}

// Density falls by a factor of 400 from left to right.
std::vector<vec3> uneven(std::size_t n) {
    std::vector<vec3> points = testing::square(n, 5);
    for (vec3& p : points)
        p.x = std::exp2(8.6f * (p.x - 1.0f));
    return points;
}

std::vector<Case> cases() {
    return {{"square, uniform", testing::square(40'000, 6), 4'000, uniform(1.0)},
            {"square, uniform, 40 to 1", testing::square(16'000, 7), 400, uniform(1.0)},
            {"square, adaptive", testing::square(30'000, 8), 6'000, adaptive()},
            {"sphere, adaptive", testing::sphere(30'000, 9), 4'000, adaptive()},
            {"uneven, adaptive", uneven(30'000), 4'000, adaptive()},
            {"uneven, uniform", uneven(10'000), 1'000, uniform(1.0)},
            {"cube, uniform", testing::cube(15'000, 10), 3'000, uniform(1.0, 3)},
            {"cube, adaptive", testing::cube(15'000, 11), 3'000, adaptive(3)},
            {"lattice, uniform", lattice(120), 2'000, uniform(1.0)},
            {"nobody near, uniform", testing::square(10'000, 12), 5'000, uniform(1e-6)}};
}

TEST(Exactness, ParallelEliminationKeepsWhoIsKeptOneByOne) {
    for (Case& c : cases()) {
        c.settings.stage_ratio = testing::kOneStage;
        const Survivors parallel = eliminate(c.points, c.target, c.settings);
        c.settings.one_by_one = true;
        EXPECT_EQ(parallel.index, eliminate(c.points, c.target, c.settings).index) << c.name;
    }
}

TEST(Exactness, SoDoesEveryStage) {
    for (Case& c : cases()) {
        c.settings.stage_ratio = 3.0;
        const Survivors parallel = eliminate(c.points, c.target, c.settings);
        c.settings.one_by_one = true;
        EXPECT_EQ(parallel.index, eliminate(c.points, c.target, c.settings).index) << c.name;
    }
}

TEST(Exactness, ThreadsDoNotMatter) {
    for (const Case& c : cases()) {
        std::vector<Survivors> results;
        for (const int threads : {1, 2, 8}) {
            const ThreadLimit limit(threads);
            results.push_back(eliminate(c.points, c.target, c.settings));
        }
        for (const Survivors& r : results) {
            EXPECT_EQ(r.index, results[0].index) << c.name;
            EXPECT_EQ(r.distance, results[0].distance) << c.name;
        }
    }
}

TEST(Exactness, WithIdsTheOrderOfThePointsDoesNotMatter) {
    for (const Case& c : cases()) {
        std::vector<std::uint64_t> ids(c.points.size());
        std::iota(ids.begin(), ids.end(), 1000u);
        const Survivors first = eliminate(c.points, c.target, c.settings, ids);
        Rng rng(Stream::Points, 13);
        for (std::size_t i = ids.size() - 1; i > 0; --i)
            std::swap(ids[i], ids[std::size_t(rng.next_double() * double(i + 1))]);
        std::vector<vec3> shuffled;
        shuffled.reserve(ids.size());
        for (const std::uint64_t id : ids)
            shuffled.push_back(c.points[id - 1000]);
        std::vector<std::uint32_t> found;
        for (const std::uint32_t i : eliminate(shuffled, c.target, c.settings, ids).index)
            found.push_back(static_cast<std::uint32_t>(ids[i] - 1000));
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, first.index) << c.name;
    }
}

}  // namespace
}  // namespace brisance
