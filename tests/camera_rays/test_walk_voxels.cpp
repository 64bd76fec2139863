// The pieces of a ray in the cells have neither gaps nor overlaps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "camera_rays/ray_sum.h"
#include "core/rng.h"
#include "fixtures/media.h"

namespace brisance {
namespace {

using testing::cube;
using testing::make_medium;
using testing::noise;
using testing::Recipe;

Medium solid(const dmat4& world_from_index) {
    Recipe r;
    r.box = cube(-19, 21);
    r.world_from_index = world_from_index;
    r.density = [](const ivec3& n) { return 0.5f + noise(n, 1); };
    r.settings = testing::black_smoke();
    return make_medium(r);
}

Medium scattered() {
    Recipe r;
    r.box = cube(-40, 40);
    r.density = [](const ivec3& n) { return noise(n >> 3, 2) > 0.85f ? noise(n, 1) : 0.0f; };
    r.settings = testing::black_smoke();
    return make_medium(r);
}

std::vector<VoxelSegment> segments(const SourceField& field, const Ray& ray) {
    std::vector<VoxelSegment> list;
    walk_voxels(field, ray, [&](const VoxelSegment& s) {
        list.push_back(s);
        return true;
    });
    return list;
}

dvec3 random_vector(Rng& rng, double size) {
    const double x = rng.next(), y = rng.next(), z = rng.next();
    return size * (2.0 * dvec3(x, y, z) - 1.0);
}

void expect_one_cell(const VoxelSegment& s, const Ray& ray) {
    const dvec3 begin = s.origin + s.direction * s.begin, end = s.origin + s.direction * s.end;
    const dvec3 middle = 0.5 * (begin + end);
    for (int a = 0; a < 3; ++a) {
        const double cell = std::floor(middle[a]);
        // On a face a parallel ray belongs to either side.
        ASSERT_GE(middle[a], -1e-9);
        ASSERT_LE(middle[a], 8.0 + 1e-9);
        ASSERT_GE(std::min(begin[a], end[a]), cell - 1e-9) << "direction " << ray.direction[a];
        ASSERT_LE(std::max(begin[a], end[a]), cell + 1.0 + 1e-9) << "direction " << ray.direction[a];
    }
}

// Bricks of a solid block fill a box: between entering and leaving it every piece of the ray is visited once.
void expect_tiling(const SourceField& field, const Ray& ray) {
    const Medium& medium = field.medium();
    const dmat3 index_from_local = glm::inverse(dmat3(medium.world_from_index));
    const dvec3 origin = index_from_local * ray.origin + dvec3(medium.reference_node);
    const dvec3 direction = index_from_local * ray.direction;
    const dvec3 low(field.bricks().min_brick() * 8), high(low + dvec3(field.bricks().brick_extent() * 8));
    double enter = 0.0, leave = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a) {
        if (direction[a] == 0.0) {
            if (origin[a] < low[a] || origin[a] > high[a])
                leave = -1.0;
            continue;
        }
        const double t0 = (low[a] - origin[a]) / direction[a], t1 = (high[a] - origin[a]) / direction[a];
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
    }
    const std::vector<VoxelSegment> list = segments(field, ray);
    if (leave <= enter) {
        ASSERT_TRUE(list.empty());
        return;
    }
    const double tolerance = 1e-9 * (leave + 1.0);
    double at = enter;
    for (const VoxelSegment& s : list) {
        ASSERT_NEAR(s.begin, at, tolerance);
        ASSERT_GT(s.end, s.begin);
        expect_one_cell(s, ray);
        at = s.end;
    }
    ASSERT_NEAR(at, leave, tolerance);
}

TEST(WalkCells, RandomRaysAreTiledBySegments) {
    for (const dmat4& transform :
         {testing::cubic(1.0), testing::cubic(0.03), testing::transform(testing::some_linear_map(), dvec3(0.0))}) {
        const Medium medium = solid(transform);
        const SourceField field(medium);
        const double size = 40.0 * medium.spacing;
        Rng rng(Stream::EscapeRay, 1);
        int hits = 0;
        for (int i = 0; i < 2000; ++i) {
            const Ray ray{random_vector(rng, size), glm::normalize(random_vector(rng, 1.0))};
            expect_tiling(field, ray);
            hits += !segments(field, ray).empty();
            if (HasFatalFailure())
                return;
        }
        EXPECT_GT(hits, 500);
    }
}

TEST(WalkCells, RaysAlongAxesAndOnFacesAreTiledToo) {
    const Medium medium = solid(testing::cubic(1.0));
    const SourceField field(medium);
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0})
            for (const double y : {-24.0, -8.0, -3.0, 0.0, 0.5, 5.0, 8.0, 23.999})
                for (const double z : {-16.0, 0.0, 0.25, 7.0, 16.0})
                    for (const double start : {-100.0, -8.0, 0.0, 3.5, 8.0}) {
                        Ray ray;
                        ray.origin[axis] = start;
                        ray.origin[(axis + 1) % 3] = y;
                        ray.origin[(axis + 2) % 3] = z;
                        ray.direction[axis] = sign;
                        expect_tiling(field, ray);
                        if (HasFatalFailure())
                            return;
                    }
}

TEST(WalkCells, RaysThroughEdgesAndCornersAreTiledToo) {
    const Medium medium = solid(testing::cubic(1.0));
    const SourceField field(medium);
    for (int k = 0; k < 27; ++k) {
        const dvec3 direction(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1);
        if (direction == dvec3(0.0))
            continue;
        for (const double start : {-8.0, 0.0, 0.5, 4.0, 64.0}) {
            expect_tiling(field, {dvec3(start), glm::normalize(direction)});
            expect_tiling(field, {dvec3(start, 0.0, 3.0), glm::normalize(direction)});
            if (HasFatalFailure())
                return;
        }
    }
}

// Optical depth is the same whether empty bricks are stepped over or not.
TEST(WalkCells, EmptySpaceIsSkippedWithoutLoss) {
    const Medium medium = scattered();
    const SourceField field(medium);
    const ExtinctionPyramid pyramid(medium, 1);
    ASSERT_LT(field.bricks().brick_count(), 1200u) << "most of the box is empty";
    Rng rng(Stream::EscapeRay, 2);
    for (int i = 0; i < 100; ++i) {
        const Ray ray{dvec3(random_vector(rng, 60.0)), glm::normalize(random_vector(rng, 1.0))};
        double depth = 0.0;
        for (const VoxelSegment& s : segments(field, ray))
            for (const double t : {0.21132486540518713, 0.78867513459481287}) {
                const dvec3 p = s.origin + s.direction * glm::mix(s.begin, s.end, t);
                depth +=
                    0.5 * (s.end - s.begin) *
                    field.sample(s.brick, glm::clamp(vec3(p), vec3(0.0f), vec3(8.0f))).value[SourceRecord::Extinction];
            }
        const vec3 from(ray.origin), to(ray.origin + 250.0 * ray.direction);
        ASSERT_NEAR(depth, pyramid.optical_depth(from, to), 0.01 * depth + 0.05);
    }
}

TEST(WalkCells, StopsWhenAskedTo) {
    const Medium medium = solid(testing::cubic(1.0));
    const SourceField field(medium);
    int visited = 0;
    walk_voxels(field, {dvec3(-50.0, 0.1, 0.2), dvec3(1.0, 0.0, 0.0)},
                [&](const VoxelSegment&) { return ++visited < 5; });
    EXPECT_EQ(visited, 5);
}

TEST(WalkCells, TheFieldIsTheMediumsOwn) {
    const Medium medium = scattered();
    const SourceField field(medium);
    const ExtinctionPyramid pyramid(medium, 1);
    Rng rng(Stream::EscapeRay, 3);
    for (int i = 0; i < 2000; ++i) {
        const std::size_t brick = static_cast<std::size_t>(rng.next() * field.bricks().brick_count());
        const vec3 p = 4.0f + vec3(random_vector(rng, 4.0));
        const float value = field.sample(brick, p).value[SourceRecord::Extinction];
        const vec3 local =
            medium.local_from_index * (p + vec3(field.bricks().first_node(brick) - medium.reference_node));
        ASSERT_NEAR(value, pyramid.extinction_at(local), 1e-4f);
        ASSERT_LE(value, field.majorant(brick) * 1.00001f);
        ASSERT_GE(value, field.minimum(brick) * 0.99999f);
    }
}

}  // namespace
}  // namespace brisance
