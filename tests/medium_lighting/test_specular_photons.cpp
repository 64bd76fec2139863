// Light that mirrors reflect onto smoke.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>

#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "medium_lighting/stages/specular_photons.h"
#include "medium_lighting/stages/virtual_lights_as_points.h"
#include "medium_lighting/surface_occluders.h"
#include "scattering/multiple_scattering.h"

namespace brisance {
namespace {

using namespace testing;

SceneMaterial mirror() {
    SceneMaterial m = lambert(1.0f);
    m.surface.metallic = 1.0f;
    m.surface.roughness = 0.0f;
    return m;
}

// A cube of thin smoke, 21 nodes along each side from -1 to 1.
Medium thin_cube() {
    Recipe r;
    r.box = cube(-10, 10);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = 1e-4f;
    r.settings.smoke.albedo = Rgb(0.5f);
    return make_medium(r);
}

// A lamp before a mirror is two lamps: fluence falls with the squared distance from the one behind it.
TEST(SpecularPhotons, AMirrorCastsTheLightOfAnotherLamp) {
    const Medium medium = thin_cube();
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    const dvec3 lamp(0.4, -0.3, -1.2), image(0.4, -0.3, -2.8);
    add_quad(scene, {-20, -20, -2}, {40, 0, 0}, {0, 40, 0}, mirror());
    LightSettings light;
    light.position = medium.world_of_local(vec3(lamp));
    light.power = Rgb(1.0f, 2.0f, 3.0f);  // [W/sr]
    const Surroundings surroundings(std::move(scene), {light});
    const DirectLight direct(medium, {}, &surroundings);
    VirtualLightSettings settings;
    settings.photons = 400000;
    const SpecularPhotons cast(direct, nullptr, settings);
    ASSERT_FALSE(cast.empty());
    const std::size_t nodes = medium.lattice.node_count();
    const std::vector<std::uint8_t> needed(nodes, 1);
    const Gathered g = cast.on(medium, {&needed, std::nullopt, true, 0.0f}).light;
    double sum = 0.0, expected = 0.0;
    dvec3 heading(0.0), expected_heading(0.0);
    for (std::size_t i = 0; i < nodes; ++i) {
        if (!(medium.extinction[i] > 0.0f))
            continue;
        const ivec3 node = medium.lattice.first_node(i / BrickLattice::kNodes) +
                           BrickLattice::node_in_brick(int(i % BrickLattice::kNodes));
        const dvec3 offset = dvec3(medium.local_of_node(node)) - image;
        const double fluence = 1.0 / glm::dot(offset, offset);
        sum += g.fluence[i];
        expected += fluence;
        EXPECT_NEAR(g.fluence[nodes + i], 2.0 * g.fluence[i], 1e-4 * g.fluence[i]);
        // Degree 1 of the harmonics is (y, z, x).
        heading += dvec3(g.moments[6 * nodes + i], g.moments[i], g.moments[3 * nodes + i]);
        expected_heading += double(0.48860251f) * fluence * glm::normalize(offset);
    }
    EXPECT_NEAR(sum / expected, 1.0, 0.01);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(heading[axis], expected_heading[axis], 0.01 * glm::length(expected_heading)) << axis;
}

// What a lamp sends to the nodes of a medium by way of a rough metal floor, by random points of the floor.
double fluence_by_points(const Medium& medium, const dvec3& lamp, double floor, double half_side,
                         const SurfaceMaterial& metal, const std::function<bool(const dvec3&)>& counts) {
    const ShadingFrame frame = frame_around(dvec3(0.0, 0.0, 1.0));
    const Bsdf bsdf(metal, frame);
    Rng rng(Stream::Photon, 1, 0);
    double sum = 0.0;
    constexpr int kPoints = 64;
    for (std::size_t i = 0; i < medium.lattice.node_count(); ++i) {
        const dvec3 node(medium.local_of_node(medium.lattice.node(i)));
        if (!(medium.extinction[i] > 0.0f) || !counts(node))
            continue;
        for (int k = 0; k < kPoints; ++k) {
            const double x = rng.next_double(), y = rng.next_double();
            const dvec3 point(half_side * (2.0 * x - 1.0), half_side * (2.0 * y - 1.0), floor);
            const dvec3 there = lamp - point, here = node - point;
            const dvec3 wi = glm::normalize(there), wo = glm::normalize(here);
            const double radiance = luminance(bsdf.evaluate(wo, wi)) / glm::dot(there, there);
            sum += radiance * wo.z / glm::dot(here, here) * 4.0 * half_side * half_side / kPoints;
        }
    }
    return sum;
}

// A rough floor sends light to the smoke above it, and to smoke that stands on it, as its BSDF says.
TEST(SpecularPhotons, ARoughFloorSendsWhatItsBsdfSays) {
    const Medium medium = thin_cube();
    SceneMaterial metal = mirror();
    metal.surface.roughness = 0.4f;
    constexpr double kHalfSide = 2.0;
    for (const double floor : {-2.0, -0.55}) {
        Scene scene;
        scene.origin = medium.world_of_local(vec3(0.0f));
        add_quad(scene, {-kHalfSide, -kHalfSide, floor}, {2 * kHalfSide, 0, 0}, {0, 2 * kHalfSide, 0}, metal);
        const dvec3 lamp(0.6, -0.3, floor + 0.8);
        LightSettings light;
        light.position = medium.world_of_local(vec3(lamp));
        light.power = Rgb(1.0f);  // [W/sr]
        const Surroundings surroundings(std::move(scene), {light});
        const DirectLight direct(medium, {}, &surroundings);
        VirtualLightSettings settings;
        settings.photons = 400000;
        const std::size_t nodes = medium.lattice.node_count();
        const std::vector<std::uint8_t> needed(nodes, 1);
        const Gathered g =
            SpecularPhotons(direct, nullptr, settings).on(medium, {&needed, std::nullopt, false, 0.0f}).light;
        for (const double side : {-1.0, 1.0}) {
            const auto counts = [&](const dvec3& node) { return side * node.x > 0.05 && node.z > floor + 0.2; };
            double sum = 0.0;
            for (std::size_t i = 0; i < nodes; ++i)
                if (medium.extinction[i] > 0.0f && counts(dvec3(medium.local_of_node(medium.lattice.node(i)))))
                    sum += g.fluence[i];
            const double expected = fluence_by_points(medium, lamp, floor, kHalfSide, metal.surface, counts);
            ASSERT_GT(expected, 0.0);
            // Four standard errors; with 16 times as many photons and points all four differ by less than 0.7 %.
            EXPECT_NEAR(sum / expected, 1.0, 0.02) << floor << " " << side;
        }
    }
}

// Of 4 m, around a lamp.
Surroundings matt_room(const Medium& medium, const vec3& lamp_at) {
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    add_box(scene, vec3(-2), vec3(2), lambert(0.5f), true);
    LightSettings lamp;
    lamp.position = medium.world_of_local(lamp_at);
    lamp.power = Rgb(1.0f);
    return Surroundings(std::move(scene), {lamp});
}

VirtualLightSettings some_lights(int count, int photons) {
    VirtualLightSettings settings;
    settings.count = count;
    settings.photons = photons;
    return settings;
}

// From under its ceiling.
PixelCamera looking_down() {
    return {16, 16, [](double x, double y) {
                return Ray{dvec3(0.1, 0.2, 1.8), glm::normalize(dvec3(x - 8.0, y - 8.0, -6.0))};
            }};
}

// Of walls that virtual lights hold, particles carry the share that the points of the lights leave, and of other places
// all.
TEST(SpecularPhotons, CarryTheShareThatVirtualLightsLeave) {
    const Medium medium = thin_cube();
    const Surroundings surroundings = matt_room(medium, {0.4f, -0.3f, 1.5f});
    const DirectLight direct(medium, {}, &surroundings);
    const VirtualLightSettings settings = some_lights(200, 100000);
    const VirtualLights lights(direct, looking_down(), settings);
    const std::vector<std::uint8_t> needed(medium.lattice.node_count(), 1);
    const auto fluence = [&](const SpecularPhotons& cast) {
        const Gathered g = cast.on(medium, {&needed, std::nullopt, false, 0.0f}).light;
        return std::accumulate(g.fluence.begin(), g.fluence.end(), 0.0);
    };
    const double all = fluence(SpecularPhotons(direct, nullptr, settings));
    ASSERT_GT(all, 0.0);
    const double not_held = fluence(SpecularPhotons(direct, &lights, settings, 1e-9f)) / all;
    ASSERT_LT(not_held, 0.5);
    // 100,000 particles: a fortieth is more than four standard errors.
    for (const float share : {0.25f, 0.75f}) {
        const double carried = fluence(SpecularPhotons(direct, &lights, settings, share)) / all;
        EXPECT_NEAR(carried, not_held + share * (1.0 - not_held), 0.025) << share;
    }
    const auto power = [&](float share) {
        double sum = 0.0;
        for (const PointLights& side : points_of_virtual_lights(lights, share, 0.1f))
            for (const Rgb& intensity : side.intensity)
                sum += luminance(intensity);
        return sum;
    };
    ASSERT_GT(power(1.0f), 0.0);
    EXPECT_NEAR(power(0.25f), 0.25 * power(1.0f), 1e-4 * power(1.0f));
}

// Rounds of particles: the difference that the last one made tells the error of all of them, and the first that is
// enough is the last.
TEST(SpecularPhotons, RoundsTellTheirError) {
    const Medium medium = thin_cube();
    const Surroundings surroundings = matt_room(medium, {0.4f, -0.3f, 1.5f});
    const DirectLight direct(medium, {}, &surroundings);
    const std::vector<std::uint8_t> needed(medium.lattice.node_count(), 1);
    const SpecularPhotons cast(direct, nullptr, VirtualLightSettings());
    const auto total = [](const std::vector<float>& fluence) {
        return std::accumulate(fluence.begin(), fluence.end(), 0.0);
    };
    struct Totals {
        std::size_t particles;
        std::vector<double> by_all, differences;
    };
    // Of one set of particles, in at most so many rounds after the first.
    const auto cast_rounds = [&](int set, std::size_t most) {
        Totals out{};
        const SpecularPhotons::Cast found = cast.on(
            medium, {&needed, std::nullopt, false, 0.0f}, 1.0f / 32.0f, set, [&](const SpecularPhotons::Found& so_far) {
                out.by_all.push_back(total(so_far.by_all));
                out.differences.push_back(out.by_all.back() - total(so_far.by_half));
                return out.by_all.size() == most;
            });
        out.particles = found.particles;
        double luminances = 0.0;
        for (const Rgb& fluence : fluence_at_nodes(found.light, needed))
            luminances += luminance(fluence);
        if (out.by_all.size() == most) {
            EXPECT_NEAR(luminances / out.by_all.back(), 1.0, 1e-4) << "what is judged is what is returned";
        }
        return out;
    };
    const Totals all = cast_rounds(0, 99);
    ASSERT_EQ(all.by_all.size(), 3u);
    for (std::size_t k = 0; k < all.by_all.size(); ++k)
        EXPECT_NEAR(double(cast_rounds(0, k + 1).particles), std::ldexp(double(all.particles), int(k) - 3), 8.0) << k;
    // With 32 sets, the root mean squares of both have standard errors of an eighth.
    constexpr int kSets = 32;
    std::vector<double> sums;
    double told = 0.0;
    for (int set = 1; set <= kSets; ++set) {
        const Totals first = cast_rounds(set, 1);
        sums.push_back(first.by_all[0]);
        told += first.differences[0] * first.differences[0] / kSets;
    }
    const double mean = std::accumulate(sums.begin(), sums.end(), 0.0) / kSets;
    double variance = 0.0;
    for (const double sum : sums)
        variance += (sum - mean) * (sum - mean) / (kSets - 1);
    EXPECT_NEAR(std::sqrt(told / variance), 1.0, 0.6);
    // A round counts by its particles: more rounds have the same mean.
    EXPECT_NEAR(all.by_all.back(), mean, 4.0 * std::sqrt(variance * (1.0 / kSets + 1.0 / 4.0)));
}

// However many there are, and so however close to their walls: of a wall that faces down as of one that faces up. Those
// within a thousandth of a voxel of another wall may be behind that one.
TEST(VirtualLightsAsPoints, AreBeforeTheirWalls) {
    const Medium medium = thin_cube();
    const Surroundings surroundings = matt_room(medium, {0.1f, 0.2f, -0.3f});
    const DirectLight direct(medium, {}, &surroundings);
    const VirtualLightSettings settings = some_lights(4000, 20000);
    const VirtualLights lights(direct, looking_down(), settings);
    for (const float spacing : {0.02f, 0.1f, 0.5f}) {
        const SurfaceOccluders walls(surroundings.intersector(), spacing);
        std::size_t all = 0, hidden = 0;
        for (const PointLights& side : points_of_virtual_lights(lights, 1.0f, spacing))
            for (const vec3& p : side.position) {
                const float far = glm::length(p);
                hidden += walls.first_hit(p, -p / far, far) < far;
                ++all;
            }
        ASSERT_GT(all, 1000u);
        EXPECT_LT(double(hidden), 0.01 * double(all)) << spacing;
    }
}

TEST(SpecularPhotons, IsNotWantedWithoutSurfacesOrLight) {
    const Medium medium = thin_cube();
    const auto empty = [&](bool surfaces, bool light) {
        Scene scene;
        scene.origin = medium.world_of_local(vec3(0.0f));
        if (surfaces)
            add_quad(scene, {-2, -2, -2}, {4, 0, 0}, {0, 4, 0}, mirror());
        const Surroundings surroundings(std::move(scene),
                                        light ? std::vector{LightSettings{}} : std::vector<LightSettings>{});
        const DirectLight direct(medium, {}, &surroundings);
        return SpecularPhotons(direct, nullptr, {}).empty();
    };
    EXPECT_FALSE(empty(true, true));
    EXPECT_TRUE(empty(false, true));
    EXPECT_TRUE(empty(true, false));
}

}  // namespace
}  // namespace brisance
