// Light that a source function in the medium sends to its nodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>

#include "core/parallel.h"
#include "fixtures/estimate.h"
#include "fixtures/media.h"
#include "fixtures/plane_occluder.h"
#include "radiance_cascades/radiance_cascades.h"
#include "scattering/balance.h"

namespace brisance {
namespace {

using namespace testing;

std::vector<std::uint8_t> smoke_nodes(const Medium& medium) {
    std::vector<std::uint8_t> mask;
    for (const float e : medium.extinction)
        mask.push_back(e > 0.0f);
    return mask;
}

std::vector<float> source_of(const Medium& medium, const std::function<Rgb(const ivec3&)>& at) {
    std::vector<float> source;
    for (std::size_t i = 0; i < medium.extinction.size(); ++i) {
        const Rgb s = at(medium.lattice.node(i));
        source.insert(source.end(), {s.x, s.y, s.z});
    }
    return source;
}

struct Errors {
    double mean = 0.0, root_mean_square = 0.0;
};

// Of the fluence over what rays say, at the nodes in smoke.
Errors errors_against_rays(const Lit& lit, const Gathered& light) {
    std::vector<ivec3> nodes;
    std::vector<std::size_t> index;
    for (std::size_t i = 0; i < lit.medium.extinction.size(); ++i)
        if (lit.medium.extinction[i] > 0.0f) {
            nodes.push_back(lit.medium.lattice.node(i));
            index.push_back(i);
        }
    const std::vector<float> expected = collision_probabilities(lit.pyramid, nodes, 0, 1024);
    Errors e;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const double error = light.fluence[index[k]] / (4.0 * kPi64 * expected[k]) - 1.0;
        e.mean += error / double(nodes.size());
        e.root_mean_square += error * error / double(nodes.size());
    }
    e.root_mean_square = std::sqrt(e.root_mean_square);
    return e;
}

Gathered by_cascades(const Lit& lit, const std::vector<float>& source, const CascadeSettings& settings = {},
                     int channels = 3) {
    return RadianceCascades(lit.pyramid, smoke_nodes(lit.medium), settings).gather(source, channels);
}

// One cascade whose intervals reach through all of the medium: rays marched from every node.
Gathered by_rays(const Lit& lit, const std::vector<float>& source, int side) {
    CascadeSettings settings;
    settings.near = 1e4f;
    settings.side = side;
    return by_cascades(lit, source, settings);
}

// Root mean square over the smoke, of the light's.
double difference(const Lit& lit, const Gathered& light, const Gathered& truth) {
    double squares = 0.0, all = 0.0;
    for (std::size_t i = 0; i < lit.medium.extinction.size(); ++i) {
        const double e = light.fluence[i] - truth.fluence[i];
        squares += lit.medium.extinction[i] * e * e;
        all += lit.medium.extinction[i] * truth.fluence[i] * truth.fluence[i];
    }
    return std::sqrt(squares / all);
}

bool same_bits(const Gathered& a, const Gathered& b) {
    const auto same = [](const std::vector<float>& x, const std::vector<float>& y) {
        return x.size() == y.size() && std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0;
    };
    return same(a.fluence, b.fluence) && same(a.moments, b.moments);
}

// A glowing lump away from the middle, and clumps of smoke around it.
struct Lump {
    Lit lit;
    std::vector<float> source;
    explicit Lump(int nodes = 8, float depth = 4.0f)
        : lit(make_medium([&] {
              Recipe r = glowing_ball(nodes, depth);
              const auto even = r.density;
              r.density = [=](const ivec3& n) { return even(n) * (noise(n >> 2, 3) > 0.5f ? 1.7f : 0.3f); };
              return r;
          }())),
          source(source_of(lit.medium, [=](const ivec3& n) {
              return Rgb(1.0f, 0.5f, 0.0f) * ball(n, dvec3(0.5 * nodes, 2.0, 1.0), 3.0);
          })) {}
};

// A source function of 1 gives 4 pi (1 - escape), by Kirchhoff's law and reciprocity; rays say what escapes.
TEST(RadianceCascades, IsothermalSmokeIsAsBrightAsItCollides) {
    for (const float radius : {0.5f, 2.0f, 8.0f}) {
        const Lit lit(make_medium(glowing_ball(10, radius)));
        const Errors e =
            errors_against_rays(lit, by_cascades(lit, source_of(lit.medium, [](const ivec3&) { return Rgb(1.0f); })));
        std::printf("optical radius %g: mean error %+.4f, root mean square %.4f\n", radius, e.mean, e.root_mean_square);
        EXPECT_NEAR(e.mean, 0.0, 0.012) << radius;
        EXPECT_LT(e.root_mean_square, 0.02) << radius;
    }
}

TEST(RadianceCascades, OnAShearedLatticeToo) {
    Recipe r = glowing_ball(8, 2.0f);
    r.world_from_index = transform(some_linear_map() / 8.0, dvec3(3.0, -2.0, 1e5));
    const Lit lit(make_medium(r));
    const Errors e =
        errors_against_rays(lit, by_cascades(lit, source_of(lit.medium, [](const ivec3&) { return Rgb(1.0f); })));
    EXPECT_NEAR(e.mean, 0.0, 0.02);
    EXPECT_LT(e.root_mean_square, 0.04);
}

TEST(RadianceCascades, MoreDirectionsConvergeToRays) {
    const Lump lump;
    const Gathered truth = by_rays(lump.lit, lump.source, 32);
    double before = 1.0;
    for (const int side : {2, 4, 8, 16}) {
        CascadeSettings settings;
        settings.side = side;
        const double error = difference(lump.lit, by_cascades(lump.lit, lump.source, settings), truth);
        std::printf("%d directions: error %.4f\n", side * side, error);
        EXPECT_LT(error, 0.6 * before);
        before = error;
    }
    EXPECT_LT(before, 0.01);
}

// What cascades add to the error of directions alone is the parallax of far intervals.
TEST(RadianceCascades, LongerFirstIntervalsHaveLessParallax) {
    const Lump lump;
    const Gathered truth = by_rays(lump.lit, lump.source, 32);
    double before = 1.0;
    for (const float near : {1.0f, 2.0f, 4.0f}) {
        CascadeSettings settings;
        settings.side = 16;
        settings.near = near;
        const double error = difference(lump.lit, by_cascades(lump.lit, lump.source, settings), truth);
        std::printf("first intervals of %g spacings: error %.4f\n", near, error);
        EXPECT_LT(error, 0.7 * before);
        before = error;
    }
}

TEST(RadianceCascades, ThreadsChangeNoBit) {
    const Lump lump;
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return by_cascades(lump.lit, lump.source);
    };
    const Gathered one = with(1);
    EXPECT_GT(*std::max_element(one.fluence.begin(), one.fluence.end()), 0.0f);
    EXPECT_TRUE(same_bits(one, with(2)));
    EXPECT_TRUE(same_bits(one, with(7)));
}

// Probes lie at multiples of 2^i of the world's nodes.
TEST(RadianceCascades, AMoveByWholeProbesChangesNoBit) {
    const auto moved = [](const ivec3& by) {
        Recipe r = glowing_ball(8, 2.0f);
        const auto density = r.density;
        r.box = {r.box.low + by, r.box.high + by};
        r.density = [=](const ivec3& n) { return density(n - by); };
        const Lit lit(make_medium(r));
        return by_cascades(lit, source_of(lit.medium, [=](const ivec3& n) { return Rgb(float(n.x - by.x) + 20.0f); }));
    };
    const Gathered here = moved(ivec3(0));
    EXPECT_TRUE(same_bits(here, moved(ivec3(64, -128, 64))));
    EXPECT_FALSE(same_bits(here, moved(ivec3(1, 0, 0))));
}

// A grain of almost nothing far away makes the bounding box larger and adds cascades.
TEST(RadianceCascades, WhatIsFarAndThinChangesNothing) {
    const auto light = [](float grain) {
        Recipe r = glowing_ball(8, 2.0f);
        const auto density = r.density;
        r.box.high.x = 150;
        r.density = [=](const ivec3& n) { return n.x > 146 && n.y == 0 && n.z == 0 ? grain : density(n); };
        const Lit lit(make_medium(r));
        const Gathered g =
            by_cascades(lit, source_of(lit.medium, [](const ivec3& n) { return Rgb(n.x < 20 ? 1.0f : 0.0f); }));
        std::vector<float> at;
        for (int x = -8; x <= 8; ++x)
            at.push_back(g.fluence[lit.medium.lattice.find_node({x, 1, -2})]);
        return at;
    };
    const std::vector<float> without = light(0.0f), with = light(1e-12f);
    for (std::size_t i = 0; i < with.size(); ++i)
        EXPECT_NEAR(with[i] / without[i], 1.0f, 2e-3f) << i;
}

// Light from a lump at the right travels to the left; what is symmetric has no direction.
TEST(RadianceCascades, MomentsPointAwayFromTheLight) {
    Recipe r = glowing_ball(10, 0.2f);
    r.settings.smoke.mean_cosine = 0.5f;
    const Lit lit(make_medium(r));
    std::vector<float> source(lit.medium.extinction.size() * 27, 0.0f);
    for (std::size_t i = 0; i < lit.medium.extinction.size(); ++i)
        source[i * 27] = ball(lit.medium.lattice.node(i), dvec3(7, 0, 0), 1.5);
    const Gathered g = by_cascades(lit, source, {}, 27);
    const std::size_t n = lit.medium.extinction.size(), at = lit.medium.lattice.find_node({-5, 0, 0});
    const auto toward = sh_basis({-1.0f, 0.0f, 0.0f});
    for (int m = 0; m < kShMoments; ++m)
        EXPECT_NEAR(g.moments[3 * m * n + at] / g.fluence[at], toward[m], 0.06f) << "moment " << m;
    EXPECT_EQ(g.fluence[n + at], 0.0f);
}

// 1 + cos toward x from a lump: the far side that it faces gets twice the mean, the other side nothing.
TEST(RadianceCascades, DirectionalSourcesShineWhereTheyAreTurned) {
    Recipe r = glowing_ball(10, 0.05f);
    r.settings.smoke.mean_cosine = 0.5f;
    const Lit lit(make_medium(r));
    const auto light = [&](float cosine) {
        std::vector<float> source(lit.medium.extinction.size() * 27, 0.0f);
        for (std::size_t i = 0; i < lit.medium.extinction.size(); ++i) {
            const float here = ball(lit.medium.lattice.node(i), dvec3(0.0), 2.0);
            source[i * 27] = here;
            source[i * 27 + 3 + 3 * 2] = cosine * here / kSh1;  // the degree along x
        }
        return by_cascades(lit, source, {}, 27);
    };
    const Gathered even = light(0.0f), turned = light(1.0f);
    const std::size_t front = lit.medium.lattice.find_node({8, 0, 0}), back = lit.medium.lattice.find_node({-8, 0, 0});
    EXPECT_NEAR(turned.fluence[front] / even.fluence[front], 2.0f, 0.1f);
    EXPECT_NEAR(turned.fluence[back] / even.fluence[back], 0.0f, 0.1f);
}

TEST(RadianceCascades, WallsStopLight) {
    Lit lit(make_medium(glowing_ball(10, 1.0f)));
    const auto source = source_of(lit.medium, [](const ivec3& n) { return Rgb(ball(n, dvec3(6, 0, 0), 2.0)); });
    const Gathered open = by_cascades(lit, source);
    const PlaneOccluder wall = plane_across(0, 0.05f);
    lit.pyramid.set_occluders(&wall);
    RadianceCascades cascades(lit.pyramid, smoke_nodes(lit.medium), {});
    const Gathered closed = cascades.gather(source, 3);
    EXPECT_TRUE(same_bits(closed, cascades.gather(source, 3))) << "the second time walls are remembered";
    double leak = 0.0, behind = 0.0, change = 0.0;
    for (std::size_t i = 0; i < lit.medium.extinction.size(); ++i) {
        const ivec3 n = lit.medium.lattice.node(i);
        if (n.x < 0)
            leak += closed.fluence[i], behind += open.fluence[i];
        if (n.x > 3 && lit.medium.extinction[i] > 0.0f)
            change = std::max(change, std::abs(double(closed.fluence[i]) / open.fluence[i] - 1.0));
    }
    EXPECT_LT(change, 0.005) << "before the wall";
    std::printf("behind the wall: %.4f of the light without it\n", leak / behind);
    // Coarser averages of the medium know no wall; without any, all of it would be there.
    EXPECT_LT(leak / behind, 0.06);
}

}  // namespace
}  // namespace brisance
