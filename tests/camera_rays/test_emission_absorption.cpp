// Rays through glowing smoke against closed forms, from transparent to opaque.
#include <gtest/gtest.h>

#include <cmath>

#include "camera_rays/integrate.h"
#include "core/rng.h"
#include "fixtures/media.h"

namespace brisance {
namespace {

using testing::cube;
using testing::cubic;
using testing::make_medium;
using testing::Recipe;

constexpr double kThickness[] = {1e-6, 1e-4, 1e-2, 0.1, 1.0, 10.0, 1e2, 1e4, 1e6};  // optical, of a voxel

// 32 voxels of 0.1 m along z, half a voxel of them in each of the ramps at the ends; source function 1 all over.
Recipe slab(double voxel_depth) {
    Recipe r;
    r.box = {ivec3(-16, -16, -8), ivec3(15, 15, 39)};
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3& n) { return n.z >= 0 && n.z < 32 ? 1.0f : 0.0f; };
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = testing::black_smoke();
    r.settings.smoke.extinction_per_metre = static_cast<float>(voxel_depth / 0.1);
    return r;
}

RaySum look(const Medium& medium, const dvec3& world_origin, const dvec3& direction, int parts = 2) {
    const SourceField field(medium);
    return integrate(field, {dvec3(medium.local_of_world(world_origin)), glm::normalize(direction)}, parts);
}

void expect_one_minus_transmittance(const RaySum& sum, double depth, double tolerance) {
    EXPECT_NEAR(sum.cells.at(Cell::V).x / -std::expm1(-depth), 1.0, tolerance) << "optical depth " << depth;
    // Rays end at opacity 1 - 1e-5.
    EXPECT_NEAR(sum.alpha / -std::expm1(-depth), 1.0, 1e-5 + tolerance);
}

TEST(EmissionAbsorption, SlabsRadiateOneMinusTransmittance) {
    for (const double voxel : kThickness)
        expect_one_minus_transmittance(look(make_medium(slab(voxel)), {0.013, 0.027, -5.0}, {0, 0, 1}), 32.0 * voxel,
                                       2e-4);
}

TEST(EmissionAbsorption, SlantedRaysSeeALongerSlab) {
    for (const double voxel : {1e-6, 1e-2, 0.1, 1.0}) {
        const dvec3 direction(0.2, -0.15, 1.0);
        const dvec3 origin = dvec3(0.013, 0.027, 1.6) - 2.5 * direction;
        expect_one_minus_transmittance(look(make_medium(slab(voxel)), origin, direction),
                                       32.0 * voxel * glm::length(direction), 2e-4);
    }
}

TEST(EmissionAbsorption, RaysOnTheFacesOfVoxelsSeeTheSame) {
    for (const double voxel : kThickness) {
        const Medium medium = make_medium(slab(voxel));
        for (const double x : {-0.8, 0.0, 0.1, 0.8})
            for (const double sign : {-1.0, 1.0})
                expect_one_minus_transmittance(look(medium, {x, 0.0, 1.6 - sign * 6.0}, {0, 0, sign}), 32.0 * voxel,
                                               2e-4);
    }
}

TEST(EmissionAbsorption, FromInsideARaySeesWhatIsAheadOfIt) {
    for (const double voxel : kThickness) {
        const Medium medium = make_medium(slab(voxel));
        for (const double z : {0.0, 0.8, 1.0, 2.47}) {
            const double ahead = z == 0.0 ? 31.5 : 31.5 - z / 0.1;
            expect_one_minus_transmittance(look(medium, {0.013, 0.027, z}, {0, 0, 1}), ahead * voxel, 5e-4);
        }
    }
}

TEST(EmissionAbsorption, ASlabBehindASlabIsSeenThroughIt) {
    for (const double voxel : {1e-4, 0.02, 0.1}) {
        Recipe r = slab(voxel);
        r.box.high.z = 79;
        r.density = [](const ivec3& n) { return (n.z >= 0 && n.z < 16) || (n.z >= 40 && n.z < 72) ? 1.0f : 0.0f; };
        r.flame = [](const ivec3& n) { return n.z < 28 ? 3.0f : 0.5f; };
        const double first = 16.0 * voxel, second = 32.0 * voxel;
        const double expected = -3.0 * std::expm1(-first) - 0.5 * std::exp(-first) * std::expm1(-second);
        EXPECT_NEAR(look(make_medium(r), {0.0, 0.0, -3.0}, {0, 0, 1}).cells.at(Cell::V).x / expected, 1.0, 2e-4);
    }
}

TEST(EmissionAbsorption, BallsRadiateAsTheirChordsSay) {
    for (const double radius_depth : {1e-5, 0.01, 0.5, 2.0, 10.0, 1e4, 1e7}) {
        const Medium medium = make_medium(testing::glowing_ball(16, static_cast<float>(radius_depth)));
        for (const double b : {0.0, 0.3, 0.6, 0.9}) {
            const double chord = 2.0 * radius_depth * std::sqrt(1.0 - b * b);
            const RaySum sum = look(medium, {b, 0.011, -3.0}, {0, 0, 1});
            EXPECT_NEAR(sum.cells.at(Cell::V).x / -std::expm1(-chord), 1.0, b > 0.8 ? 0.03 : 0.01)
                << radius_depth << ", b = " << b;
        }
    }
}

TEST(EmissionAbsorption, ATransparentFlameShinesByItsDepth) {
    Recipe r = slab(1.0);
    r.flame = r.density;
    r.density = nullptr;
    r.settings.fire.convention = EmissionConvention::Direct;
    const RaySum sum = look(make_medium(r), {0.013, 0.027, -5.0}, {0, 0, 1});
    EXPECT_NEAR(sum.cells.at(Cell::V).x, 3.2, 1e-4);
    EXPECT_EQ(sum.alpha, 0.0f);
}

// Emission that does not care for density, within smoke: j / sigma (1 - exp(-tau)).
TEST(EmissionAbsorption, AFlameInSmokeIsDimmedByIt) {
    for (const double voxel : {1e-6, 1e-3, 0.3, 100.0}) {
        Recipe r = slab(voxel);
        r.flame = r.density;
        r.settings.fire.convention = EmissionConvention::Direct;
        const RaySum sum = look(make_medium(r), {0.013, 0.027, -5.0}, {0, 0, 1});
        const double sigma = voxel / 0.1;
        EXPECT_NEAR(sum.cells.at(Cell::V).x / (-std::expm1(-32.0 * voxel) / sigma), 1.0, 2e-4) << voxel;
    }
}

TEST(EmissionAbsorption, ScatteredSourcesAreSeenAsEmittedOnesAre) {
    const Medium medium = make_medium(slab(0.05));
    const auto even = [&](float radiance) { return std::vector<Rgb>(medium.lattice.node_count(), Rgb(radiance)); };
    const NodeSources sources{even(2.0f), even(5.0f), even(3.0f), even(7.0f)};
    const SourceField field(medium, sources);
    const RaySum sum = integrate(field, {dvec3(medium.local_of_world({0.0, 0.0, -5.0})), {0, 0, 1}}, 2);
    const double opacity = -std::expm1(-32.0 * 0.05);
    EXPECT_NEAR(sum.cells.at(Cell::V).x / opacity, 1.0, 1e-4);
    EXPECT_NEAR(sum.cells.at(Cell::MV).x / opacity, 2.0, 2e-4);
    EXPECT_NEAR(sum.cells.at(Cell::MM).x / opacity, 5.0, 5e-4);
    EXPECT_NEAR(sum.cells.at(Cell::MS).x / opacity, 3.0, 3e-4);
    EXPECT_NEAR(sum.cells.at(Cell::MA).x / opacity, 7.0, 7e-4);
}

std::vector<Rgb> colours_of_noise(const Medium& medium, int seed) {
    std::vector<Rgb> out;
    for (std::size_t i = 0; i < medium.lattice.node_count(); ++i) {
        const ivec3 n = medium.lattice.node(i);
        out.emplace_back(testing::noise(n, seed), testing::noise(n, seed + 1), testing::noise(n, seed + 2));
    }
    return out;
}

struct Summed {
    dvec3 single{0.0}, from_emitters{0.0};
    double through = 1.0;
};

// In every voxel by two Gauss points of the field as it is sampled.
Summed sum_of_two_points(const SourceField& field, const Ray& ray) {
    Summed sum;
    walk_voxels(field, ray, [&](const VoxelSegment& s) {
        for (const double part : {0.21132487, 0.78867513}) {
            const vec3 p = position_in_brick(s, s.begin + part * (s.end - s.begin));
            const SourceRecord own = field.sample(s.brick, p);
            const SurroundingsRecord around =
                field.has_outside() ? field.sample_outside(s.brick, p) : SurroundingsRecord{};
            const double tau = 0.5 * (s.end - s.begin) * double(own.value[SourceRecord::Extinction]),
                         opacity = sum.through * -std::expm1(-tau);
            sum.through -= opacity;
            for (int c = 0; c < 3; ++c) {
                sum.single[c] += opacity * own.value[SourceRecord::MV + c];
                sum.from_emitters[c] += opacity * around.value[SurroundingsRecord::MA + c];
            }
        }
        return true;
    });
    return sum;
}

// Colours and cells stay apart, whatever the direction, with light of the surroundings or without.
TEST(EmissionAbsorption, VoxelsAreSummedByTwoPointsOfTheField) {
    Recipe r = slab(0.1);
    r.density = [](const ivec3& n) { return testing::noise(n, 1); };
    const Medium medium = make_medium(r);
    for (const bool outside : {false, true}) {
        const std::vector<Rgb> none;
        const NodeSources sources{colours_of_noise(medium, 3), colours_of_noise(medium, 6),
                                  outside ? colours_of_noise(medium, 9) : none,
                                  outside ? colours_of_noise(medium, 12) : none};
        const SourceField field(medium, sources);
        Rng rng(stream_of("voxels summed by two points"), outside);
        for (int k = 0; k < 50; ++k) {
            const auto any = [&] { return dvec3(rng.next_double(), rng.next_double(), rng.next_double()) - 0.5; };
            const dvec3 at = dvec3(0.0, 0.0, 1.6) + 0.6 * any();
            const Ray ray{dvec3(medium.local_of_world(at)), glm::normalize(any())};
            const RaySum sum = integrate(field, ray, 2);
            const Summed expected = sum_of_two_points(field, ray);
            ASSERT_LT(expected.through, 0.7);
            EXPECT_NEAR(sum.through, expected.through, 1e-5);
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(sum.cells.at(Cell::MV)[c], expected.single[c], 1e-5);
                EXPECT_NEAR(sum.cells.at(Cell::MA)[c], expected.from_emitters[c], 1e-5);
            }
        }
    }
}

TEST(EmissionAbsorption, FinerStepsThroughNoiseConverge) {
    Recipe r = slab(0.5);
    r.density = [](const ivec3& n) { return testing::noise(n, 1); };
    r.flame = [](const ivec3& n) { return testing::noise(n, 2); };
    const Medium medium = make_medium(r);
    const dvec3 origin(-0.3, 0.2, -5.0), direction(0.1, 0.05, 1.0);
    const double fine = look(medium, origin, direction, 64).cells.at(Cell::V).x;
    EXPECT_NEAR(look(medium, origin, direction, 2).cells.at(Cell::V).x / fine, 1.0, 0.01);
    EXPECT_NEAR(look(medium, origin, direction, 16).cells.at(Cell::V).x / fine, 1.0, 1e-3);
}

TEST(EmissionAbsorption, PhiOneIsRightForEveryDepth) {
    EXPECT_EQ(phi1(0.0f), 1.0f);
    for (double tau = 1e-12; tau < 1e12; tau *= 3.0) {
        const double f = static_cast<float>(tau);
        EXPECT_NEAR(phi1(float(f)) / (-std::expm1(-f) / f), 1.0, 3e-7) << tau;
    }
}

}  // namespace
}  // namespace brisance
