// The tree finds what a search through all boxes finds, whatever the boxes are.
#include "photon_density/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/parallel.h"
#include "fixtures/estimate.h"

namespace brisance {
namespace {

using namespace testing;

std::vector<Box> random_boxes(std::size_t count, std::uint64_t key) {
    Rng rng(Stream::Points, key);
    std::vector<Box> boxes(count);
    for (Box& box : boxes) {
        const vec3 p(rng.next(), rng.next(), rng.next());
        box.include(p);
        box.include(p + 0.05f * vec3(rng.next(), rng.next(), rng.next()));
    }
    return boxes;
}

// By point: the least distance of a box to it.
bool near_point(const Box& box, const dvec3& point, double radius) {
    return glm::length(point - glm::clamp(point, dvec3(box.low), dvec3(box.high))) < radius;
}

TEST(BoxTree, FindsWhatASearchThroughAllFinds) {
    for (const std::size_t count : {0, 1, 8, 9, 100, 5000}) {
        const std::vector<Box> boxes = random_boxes(count, count);
        const BoxTree tree(boxes);
        ASSERT_EQ(tree.order().size(), count);
        Rng rng(Stream::Points, 77);
        for (int query = 0; query < 50; ++query) {
            const dvec3 point(rng.next_double(), rng.next_double(), rng.next_double());
            const SegmentNearBox near({point, uniform_direction(rng.next_double(), rng.next_double()), 0.4}, 0.03);
            std::vector<std::uint32_t> found, expected, around, expected_around;
            tree.find(near, [&](std::size_t k) {
                if (near(boxes[tree.order()[k]]))
                    found.push_back(tree.order()[k]);
            });
            tree.find([&](const Box& box) { return near_point(box, point, 0.1); },
                      [&](std::size_t k) {
                          if (near_point(boxes[tree.order()[k]], point, 0.1))
                              around.push_back(tree.order()[k]);
                      });
            for (std::uint32_t i = 0; i < count; ++i) {
                if (near(boxes[i]))
                    expected.push_back(i);
                if (near_point(boxes[i], point, 0.1))
                    expected_around.push_back(i);
            }
            std::sort(found.begin(), found.end());
            std::sort(around.begin(), around.end());
            EXPECT_EQ(found, expected) << count;
            EXPECT_EQ(around, expected_around) << count;
        }
    }
}

// Points of a segment that lie within the distance of a box along every axis are near it, also where the segment is
// parallel to an axis.
TEST(BoxTree, SegmentsAreNearTheBoxesThatTheyPass) {
    Rng rng(Stream::Points, 78);
    const std::vector<Box> boxes = random_boxes(40, 3);
    for (int query = 0; query < 400; ++query) {
        const dvec3 start = 2.0 * dvec3(rng.next_double(), rng.next_double(), rng.next_double()) - 0.5;
        dvec3 direction = uniform_direction(rng.next_double(), rng.next_double());
        if (query % 4 == 0) {
            direction = dvec3(0.0);
            direction[query / 4 % 3] = query % 8 == 0 ? 1.0 : -1.0;
        }
        const SegmentNearBox near({start, direction, 1.5}, 0.1);
        for (const Box& box : boxes) {
            bool passes = false;
            for (int i = 0; i <= 3000 && !passes; ++i) {
                const dvec3 p = start + 1.5 * i / 3000.0 * direction;
                passes = glm::all(glm::greaterThan(p, dvec3(box.low) - 0.1)) &&
                         glm::all(glm::lessThan(p, dvec3(box.high) + 0.1));
            }
            if (passes)
                EXPECT_TRUE(near(box));
            else
                EXPECT_FALSE(SegmentNearBox({start, direction, 1.5}, 0.099)(box));
        }
    }
}

TEST(BoxTree, IsTheSameForAnyNumberOfThreads) {
    const std::vector<Box> boxes = random_boxes(20000, 5);
    const auto order = [&](int threads) {
        const ThreadLimit limit(threads);
        return BoxTree(boxes).order();
    };
    EXPECT_EQ(order(1), order(2));
}

// All at one place.
TEST(BoxTree, EqualBoxesAreAllFound) {
    const std::vector<Box> boxes(1000, random_boxes(1, 9)[0]);
    const BoxTree tree(boxes);
    std::size_t found = 0;
    tree.find([](const Box&) { return true; }, [&](std::size_t) { ++found; });
    EXPECT_EQ(found, 1000u);
}

}  // namespace
}  // namespace brisance
