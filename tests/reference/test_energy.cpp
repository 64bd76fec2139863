// Energy is conserved: what is emitted leaves, or is absorbed.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/tracing_fixture.h"

namespace brisance {
namespace {

using namespace testing;

// Smoke of all kinds in a cube of a metre.
constexpr double kSpacing = 1.0 / 24.0;

Recipe smoke(const NodeScalar& density, const NodeScalar& flame, const Rgb& albedo, float g) {
    Recipe r;
    r.box = cube(-12, 12);
    r.world_from_index = cubic(kSpacing);
    r.density = density;
    r.flame = flame;
    r.settings.smoke.albedo = albedo;
    r.settings.smoke.mean_cosine = g;
    r.settings.fire.convention = EmissionConvention::Direct;
    return r;
}

float homogeneous(const ivec3&) {
    return 3.0f;
}

// Contrasts of a million, voxels from transparent to an optical depth of six.
float uneven(const ivec3& n) {
    return 150.0f * std::pow(testing::noise(n, 1), 16.0f);
}

float some_flames(const ivec3& n) {
    return std::max(0.0f, testing::noise(n / 3, 2) - 0.8f);
}

// One of all rays into a cube around the origin: anywhere on its faces, by the cosine to them.
Ray ray_into_cube(double half, double u, double v, Rng& rng) {
    const double sine = std::sqrt(rng.next_double()), angle = 2.0 * kPi64 * rng.next_double();
    const int axis = static_cast<int>(3.0 * rng.next_double());
    const double side = rng.next_double() < 0.5 ? -1.0 : 1.0;
    Ray ray;
    ray.origin[axis] = side * half;
    ray.origin[(axis + 1) % 3] = half * (2.0 * u - 1.0);
    ray.origin[(axis + 2) % 3] = half * (2.0 * v - 1.0);
    ray.direction[axis] = -side * std::sqrt(1.0 - sine * sine);
    ray.direction[(axis + 1) % 3] = sine * std::cos(angle);
    ray.direction[(axis + 2) % 3] = sine * std::sin(angle);
    return ray;
}

// The power that leaves, from rays that arrive backwards: area times pi times their mean radiance.
Estimate leaving_power(const Traced& traced, double sharp) {
    constexpr double half = 13.0 * kSpacing, area = 24.0 * half * half;
    Estimate e = estimate_to(sharp, 3, [&](const dvec3& u, Rng& rng, double* out) {
        traced.look(ray_into_cube(half, u.y, u.z, rng), u.x, rng, out);
    });
    for (int c = 0; c < 3; ++c) {
        e.mean[c] *= kPi64 * area;
        e.error[c] *= kPi64 * area;
    }
    return e;
}

struct Smoke {
    bool even, one_flame;
    float g;
};

TEST(Energy, SmokeThatAbsorbsNothingLetsAllLightOut) {
    Rows rows("albedo 1");
    const NodeScalar one = [](const ivec3& n) { return testing::ball(n, dvec3(3, 1, -4), 5.0); };
    for (const Smoke& s :
         {Smoke{true, true, 0.0f}, Smoke{true, false, 0.6f}, Smoke{false, true, 0.6f}, Smoke{false, false, 0.0f}}) {
        const Traced traced(
            smoke(s.even ? homogeneous : uneven, s.one_flame ? one : NodeScalar(some_flames), Rgb(1.0f), s.g));
        const double sharp = s.one_flame ? 0.004 : 0.003;
        const Estimate e = leaving_power(traced, sharp);
        const double truth = emitted_power(*traced.medium).x;
        rows.expect(std::string(s.even ? "even" : "uneven") + (s.one_flame ? ", one flame" : ", many flames"),
                    e.mean[0], e.error[0], truth, 1e-6 * truth, sharp);
    }
}

// The brick that holds a point, and the position in that brick.
struct BrickPosition {
    int brick;
    vec3 position;
};

BrickPosition position_in_brick(const Traced& traced, const dvec3& local) {
    const dvec3 node = local / kSpacing + dvec3(traced.medium->reference_node);
    const ivec3 brick = ivec3(glm::floor(node)) >> 3;
    return {traced.tracer.field().bricks().find(brick), vec3(node - dvec3(brick * 8))};
}

// Absorbed power: the integral of absorption times fluence, at random points of the box.
Estimate absorbed_power(const Traced& traced, double sharp) {
    constexpr double side = 26.0 * kSpacing;
    Estimate e = estimate_to(sharp, 3, [&](const dvec3& u, Rng& rng, double* out) {
        const double x = rng.next_double(), y = rng.next_double(), polar = rng.next_double();
        const dvec3 point = side * (dvec3(x, y, u.y) - 0.5);
        traced.look({point, uniform_direction(polar, u.z)}, u.x, rng, out);
        const BrickPosition at = position_in_brick(traced, point);
        for (int c = 0; c < 3; ++c)
            out[c] = at.brick < 0 ? 0.0
                                  : out[c] * traced.tracer.field().extinction(at.brick, at.position) *
                                        (1.0 - traced.medium->albedo[c]);
    });
    for (int c = 0; c < 3; ++c) {
        e.mean[c] *= 4.0 * kPi64 * std::pow(side, 3);
        e.error[c] *= 4.0 * kPi64 * std::pow(side, 3);
    }
    return e;
}

TEST(Energy, WhatLeavesAndWhatIsAbsorbedIsWhatWasEmitted) {
    Rows rows("left and absorbed");
    const NodeScalar soft = [](const ivec3& n) { return 20.0f * std::pow(testing::noise(n, 1), 2.0f); };
    const Traced traced(smoke(soft, some_flames, Rgb(0.3f, 0.7f, 0.95f), 0.3f));
    const Estimate left = leaving_power(traced, 0.003), absorbed = absorbed_power(traced, 0.006);
    const double truth = emitted_power(*traced.medium).x;
    for (int c = 0; c < 3; ++c)
        rows.expect("channel " + std::to_string(c), left.mean[c] + absorbed.mean[c],
                    std::hypot(left.error[c], absorbed.error[c]), truth, 1e-6 * truth, 0.006);
}

// From inside an endless isothermal medium every pixel is that of a black body, whatever is scattered and how.
TEST(Energy, InsideAThickIsothermalMediumEverythingLooksAlike) {
    Rows rows("isothermal");
    for (const float g : {0.0f, 0.7f, -0.5f})
        for (const bool even : {true, false}) {
            Recipe r;
            r.box = cube(-16, 16);
            r.world_from_index = cubic(1.0);
            r.density = [=](const ivec3& n) {
                return even ? 2.0f : 8.0f * testing::noise(n, 3) * testing::noise(n, 4);
            };
            r.flame = [](const ivec3&) { return 1.0f; };
            r.settings.smoke.albedo = Rgb(0.2f, 0.5f, 0.8f);
            r.settings.smoke.mean_cosine = g;
            const Traced traced(r);
            const Estimate e = estimate_to(kSharp, 3, [&](const dvec3& u, Rng& rng, double* out) {
                traced.look({dvec3(0.3, 0.1, -0.2), uniform_direction(u.y, u.z)}, u.x, rng, out);
            });
            for (int c = 0; c < 3; ++c)
                rows.expect((even ? "even, g = " : "uneven, g = ") + std::to_string(g), e.mean[c], e.error[c], 1.0,
                            1e-5);
        }
}

// The same where the medium is so thick that pixels from outside see one temperature only: black smoke.
TEST(Energy, OpaqueBlackSmokeIsABlackBody) {
    Rows rows("opaque black smoke");
    for (const double voxel : {10.0, 1e4, 1e7}) {
        Recipe r;
        r.box = cube(-9, 9);
        r.world_from_index = cubic(1.0);
        r.density = [=](const ivec3& n) { return float(voxel * (1.0 + 1000.0 * testing::noise(n, 5))); };
        r.flame = [](const ivec3&) { return 1.0f; };
        r.settings = black_smoke();
        const Traced traced(r);
        const Estimate e = estimate_to(kSharp, 3, [&](const dvec3& u, Rng& rng, double* out) {
            traced.look(ray_through_disc(4.0, u.y, u.z, rng), u.x, rng, out);
        });
        rows.expect("voxel " + std::to_string(voxel), e.mean[0], e.error[0], 1.0, 1e-5);
    }
}

}  // namespace
}  // namespace brisance
