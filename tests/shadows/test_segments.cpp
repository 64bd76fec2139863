// The vector kernel sees the same smoke as the plain definition.
#include <gtest/gtest.h>

#include <cmath>

#include "core/rng.h"
#include "fixtures/media.h"
#include "shadows/shadow_kernels.h"

namespace brisance {
namespace {

using testing::black_smoke;
using testing::cube;
using testing::make_medium;
using testing::noise;
using testing::Recipe;
using testing::transform;

Recipe blobs() {
    Recipe r;
    r.box = cube(-21, 33);
    r.world_from_index = transform(testing::some_linear_map(), dvec3(0.0));
    r.density = [](const ivec3& n) { return noise(n >> 2, 1) > 0.5f ? noise(n, 2) : 0.0f; };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = 3.0f;
    return r;
}

struct PointPairs {
    std::vector<vec3> from, to;  // local [m]

    std::vector<float> depths(const ExtinctionPyramid& pyramid, const std::vector<float>& metres, int level,
                              float step_nodes) const {
        return march(pyramid, metres, level, [&](const Segments& segments, float* result) {
            segment_optical_depths(pyramid.view(level), segments, step_nodes, result);
        });
    }

    // As segment_collisions() on the medium's own lattice.
    std::vector<float> collisions(const ExtinctionPyramid& pyramid, const std::vector<float>& weight,
                                  float step_nodes) const {
        const Medium& medium = pyramid.medium();
        const PackedField weights(medium.lattice, weight, medium.reference_node);
        std::vector<float> metres;
        for (std::size_t i = 0; i < from.size(); ++i)
            metres.push_back(glm::distance(from[i], to[i]));
        return march(pyramid, metres, 0, [&](const Segments& segments, float* result) {
            segment_collisions(pyramid.view(0), weights.view(), segments, step_nodes, result);
        });
    }

    template <class Kernel>
    std::vector<float> march(const ExtinctionPyramid& pyramid, const std::vector<float>& metres, int level,
                             const Kernel& kernel) const {
        const std::size_t padded = (from.size() + 15) / 16 * 16;
        std::vector<float> begin[3], end[3], length(padded, 0.0f), result(padded);
        const float shrink = 1.0f / float(1 << level);
        for (int a = 0; a < 3; ++a) {
            begin[a].assign(padded, 0.0f);
            end[a].assign(padded, 0.0f);
        }
        for (std::size_t i = 0; i < from.size(); ++i) {
            const vec3 f = pyramid.medium().index_from_local * from[i] * shrink;
            const vec3 t = pyramid.medium().index_from_local * to[i] * shrink;
            for (int a = 0; a < 3; ++a)
                begin[a][i] = f[a], end[a][i] = t[a];
            length[i] = metres[i];
        }
        const Segments segments{{begin[0].data(), begin[1].data(), begin[2].data()},
                                {end[0].data(), end[1].data(), end[2].data()},
                                length.data(),
                                padded};
        kernel(segments, result.data());
        result.resize(from.size());
        return result;
    }
};

// Single points: segments of no extent that count as one metre.
std::vector<float> samples(const ExtinctionPyramid& pyramid, const std::vector<vec3>& points, int level) {
    return PointPairs{points, points}.depths(pyramid, std::vector<float>(points.size(), 1.0f), level, 1.0f);
}

vec3 random_local(const Medium& medium, Rng& rng, float low, float high) {
    const float x = rng.next(), y = rng.next(), z = rng.next();
    return medium.local_from_index * (vec3(low) + (high - low) * vec3(x, y, z) - vec3(medium.reference_node));
}

TEST(Segments, SamplesEqualTheFieldToHalfPrecision) {
    const Medium medium = make_medium(blobs());
    const ExtinctionPyramid pyramid(medium, 4);
    Rng rng(Stream::EscapeRay, 1);
    std::vector<vec3> points;
    points.reserve(20000);
    for (int i = 0; i < 20000; ++i)
        points.push_back(random_local(medium, rng, -30.0f, 40.0f));
    const std::vector<float> values = samples(pyramid, points, 0);
    int lit = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const float expected = pyramid.extinction_at(points[i]);
        ASSERT_NEAR(values[i], expected, 6e-4f * expected + 1e-4f * medium.max_extinction);
        lit += expected > 0.0f;
    }
    EXPECT_GT(lit, 1000);
}

TEST(Segments, SamplesAtTheNodesOfEveryLevelAreThoseNodes) {
    const Medium medium = make_medium(blobs());
    const ExtinctionPyramid pyramid(medium, 4);
    for (int l = 0; l < pyramid.level_count(); ++l) {
        const BrickLattice& lattice = pyramid.lattice(l);
        std::vector<vec3> points;
        for (std::size_t i = 0; i < lattice.node_count(); i += 7)
            points.push_back(medium.local_of_node(
                (lattice.first_node(i / 512) + BrickLattice::node_in_brick(int(i % 512))) * (1 << l)));
        const std::vector<float> values = samples(pyramid, points, l);
        for (std::size_t k = 0; k < points.size(); ++k)
            ASSERT_NEAR(values[k], pyramid.nodes(l)[k * 7], 6e-4f * pyramid.nodes(l)[k * 7] + 2e-4f) << "level " << l;
    }
}

TEST(Segments, OutsideTheSmokeIsExactlyNothing) {
    const Medium medium = make_medium(blobs());
    const ExtinctionPyramid pyramid(medium, 4);
    std::vector<vec3> points;
    for (const float far : {23.0f, 40.0f, 1000.0f, 1e6f})
        for (int a = 0; a < 3; ++a)
            for (const float side : {-1.0f, 1.0f}) {
                vec3 node(6.0f);
                node[a] += side * (28.0f + far);
                points.push_back(medium.local_from_index * (node - vec3(medium.reference_node)));
            }
    for (int l = 0; l < pyramid.level_count(); ++l)
        for (const float value : samples(pyramid, points, l))
            EXPECT_EQ(value, 0.0f) << "level " << l;
}

TEST(Segments, ThinSmokeBesideDenseIsKept) {
    Recipe r = blobs();
    r.density = [](const ivec3& n) { return n.x < 0 ? 1e-5f : 1e2f; };
    const Medium medium = make_medium(r);
    const ExtinctionPyramid pyramid(medium, 1);
    const float value = samples(pyramid, {medium.local_of_node({-10, 3, 3})}, 0)[0];
    EXPECT_NEAR(value / 3e-5f, 1.0f, 0.02f);  // seven decades below the densest
}

TEST(Segments, OpticalDepthsAgreeWithThePlainMarch) {
    const Medium medium = make_medium(blobs());
    const ExtinctionPyramid pyramid(medium, 1);
    Rng rng(Stream::EscapeRay, 2);
    PointPairs s;
    std::vector<float> metres;
    for (int i = 0; i < 500; ++i) {
        s.from.push_back(random_local(medium, rng, -25.0f, 38.0f));
        s.to.push_back(random_local(medium, rng, -25.0f, 38.0f));
        metres.push_back(glm::length(s.to.back() - s.from.back()));
    }
    const std::vector<float> depths = s.depths(pyramid, metres, 0, 0.25f);
    for (std::size_t i = 0; i < s.from.size(); ++i) {
        // Two midpoint rules of different steps through noise.
        const float expected = pyramid.optical_depth(s.from[i], s.to[i]);
        ASSERT_NEAR(depths[i], expected, 0.02f * expected + 0.02f);
    }
}

TEST(Segments, InUniformSmokeDepthIsExtinctionTimesLength) {
    Recipe r = blobs();
    r.density = [](const ivec3&) { return 1.0f; };
    const Medium medium = make_medium(r);
    const ExtinctionPyramid pyramid(medium, 1);
    Rng rng(Stream::EscapeRay, 3);
    PointPairs s;
    std::vector<float> metres;
    for (int i = 0; i < 64; ++i) {
        s.from.push_back(random_local(medium, rng, -20.0f, 32.0f));
        s.to.push_back(random_local(medium, rng, -20.0f, 32.0f));
        metres.push_back(glm::length(s.to.back() - s.from.back()));
    }
    const std::vector<float> depths = s.depths(pyramid, metres, 0, 1.0f);
    for (std::size_t i = 0; i < metres.size(); ++i)
        ASSERT_NEAR(depths[i], 3.0f * metres[i], 5e-4f * 3.0f * metres[i]);
}

// With a weight of 1 everywhere, what collides is what does not pass, whatever the steps.
TEST(Segments, AllCollisionsAreWhatDoesNotPass) {
    const Medium medium = make_medium(blobs());
    const ExtinctionPyramid pyramid(medium, 1);
    Rng rng(Stream::EscapeRay, 3);
    PointPairs s;
    std::vector<float> metres;
    for (int i = 0; i < 500; ++i) {
        s.from.push_back(random_local(medium, rng, -25.0f, 38.0f));
        s.to.push_back(random_local(medium, rng, -25.0f, 38.0f));
        metres.push_back(glm::distance(s.from.back(), s.to.back()));
    }
    const std::vector<float> depths = s.depths(pyramid, metres, 0, 0.5f);
    const std::vector<float> sums = s.collisions(pyramid, std::vector<float>(medium.extinction.size(), 1.0f), 0.5f);
    for (std::size_t i = 0; i < s.from.size(); ++i)
        ASSERT_NEAR(sums[i], -std::expm1(-depths[i]), 1e-3f) << "depth " << depths[i];
}

// In homogeneous smoke, a weight that rises linearly from 0 to 1 over optical depth d sums to 1/d - e^-d (1 + 1/d).
TEST(Segments, CollisionsCountWithTheWeightWhereTheyHappen) {
    Recipe r = blobs();
    r.density = [](const ivec3&) { return 1.0f; };
    const Medium medium = make_medium(r);
    const ExtinctionPyramid pyramid(medium, 1);
    constexpr int kFrom = -15, kTo = 25;  // nodes along x
    std::vector<float> weight(medium.extinction.size());
    for (std::size_t i = 0; i < weight.size(); ++i)
        weight[i] = std::clamp(float(medium.lattice.node(i).x - kFrom) / float(kTo - kFrom), 0.0f, 1.0f);
    const PointPairs along{{medium.local_of_node({kFrom, 3, 3})}, {medium.local_of_node({kTo, 3, 3})}};
    const float depth = medium.max_extinction * glm::distance(along.from[0], along.to[0]);
    const float expected = (1.0f - std::exp(-depth) * (1.0f + depth)) / depth;
    EXPECT_NEAR(along.collisions(pyramid, weight, 0.25f)[0] / expected, 1.0f, 0.01f);
}

}  // namespace
}  // namespace brisance
