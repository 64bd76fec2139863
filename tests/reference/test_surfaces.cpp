// Paths between surfaces, lights and smoke: closed forms, and thermal equilibrium, in which everything has one radiance
// however often light is reflected, refracted, scattered and absorbed on its way.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/error.h"
#include "fixtures/sets.h"
#include "fixtures/tracing_fixture.h"

namespace brisance::testing {
namespace {

constexpr double kBackground = 0.7;

struct Set {
    Set(Scene scene, std::vector<LightSettings> lights, Medium m = {}, const TracingSettings& settings = {},
        int bounces = -1)
        : medium(std::make_unique<Medium>(std::move(m))),
          surroundings(std::make_unique<Surroundings>(std::move(scene), std::move(lights))),
          tracer(*medium, settings, bounces, surroundings.get()) {}

    PathSum look(const Ray& ray, double position, Rng& rng) const {
        PathSum sum{};
        PathStatistics statistics;
        tracer.trace(ray, position, rng, sum, statistics);
        return sum;
    }

    std::unique_ptr<Medium> medium;
    std::unique_ptr<Surroundings> surroundings;
    PathTracer tracer;
};

double everything(const PathSum& sum) {
    double all = 0.0;
    for (const Rgb& order : sum)
        all += order.x;
    return all;
}

LightSettings even_sky(float radiance) {
    LightSettings sky;
    sky.kind = LightKind::Environment;
    sky.power = Rgb(radiance);
    return sky;
}

// What a wall of that reflectance must emit to be in equilibrium with a radiance of 1.
SceneMaterial gray_wall(float reflectance) {
    SceneMaterial wall = lambert(reflectance);
    wall.emission = Rgb(1.0f - reflectance);
    return wall;
}

// Inside a closed box of walls that emit E and reflect rho, radiance is E / (1 - rho), cell by cell of the series.
TEST(Surfaces, ClosedBoxIsAGeometricSeries) {
    const float rho = 0.7f;
    Scene scene;
    add_box(scene, {-1, -2, -1.5}, {1, 1, 2}, gray_wall(rho), true);
    const Set set(scene, {});
    const Estimate e = estimate_to(kSharp, 4, [&](const dvec3& u, Rng& rng, double* out) {
        const PathSum sum = set.look({dvec3(0.1, 0.2, 0.3), uniform_direction(u.x, u.y)}, u.z, rng);
        out[0] = everything(sum);
        out[1] = sum.cells.at(Cell::A).x;
        out[2] = sum.cells.at(Cell::SA).x;
        out[3] = sum.cells.at(Cell::SS).x;
    });
    Rows rows("closed box");
    rows.expect("all", e.mean[0], e.error[0], 1.0, 1e-6);
    rows.expect("A", e.mean[1], e.error[1], 1.0 - rho, 1e-6);
    rows.expect("SA", e.mean[2], e.error[2], rho * (1.0 - rho), 1e-6);
    rows.expect("SS", e.mean[3], e.error[3], rho * rho, 1e-6);
}

TEST(Surfaces, BouncesEndWhereTheyAreAskedTo) {
    const double rho = 0.7;
    Scene scene;
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, gray_wall(float(rho)), true);
    for (const int bounces : {0, 1, 3}) {
        const Set set(scene, {}, {}, {}, bounces);
        const Estimate e = estimate_to(kSharp, 1, [&](const dvec3& u, Rng& rng, double* out) {
            out[0] = everything(set.look({dvec3(0.1, 0.2, 0.3), uniform_direction(u.x, u.y)}, u.z, rng));
        });
        EXPECT_NEAR(e.mean[0], 1.0 - std::pow(rho, bounces + 1), kSigmas * e.error[0] + 1e-6) << bounces;
    }
}

// Every kind of material that loses nothing, under an even sky: it cannot be seen. The tolerance is what the BSDFs'
// energy is known to, once for each of the few bounces.
TEST(Surfaces, WhiteThingsVanishUnderAnEvenSky) {
    struct Kind {
        std::string name;
        SceneMaterial material;
    };
    std::vector<Kind> kinds;
    const auto add = [&](const std::string& name, const auto& set) {
        SceneMaterial m = lambert(1.0f);
        m.surface.specular = 1.0f;
        set(m.surface);
        kinds.push_back({name, m});
    };
    add("plaster", [](SurfaceMaterial& m) { m.specular = 0.0f; });
    for (const float roughness : {0.0f, 0.3f, 1.0f}) {
        const std::string with = ", roughness " + std::to_string(roughness);
        add("coated" + with, [&](SurfaceMaterial& m) { m.roughness = roughness; });
        add("metal" + with, [&](SurfaceMaterial& m) { m.roughness = roughness, m.metallic = 1.0f; });
        add("glass" + with, [&](SurfaceMaterial& m) { m.roughness = roughness, m.transmission = 1.0f; });
        add("sheet" + with, [&](SurfaceMaterial& m) { m.roughness = roughness, m.transmission = 1.0f, m.thin = true; });
    }
    Rows rows("white under an even sky");
    for (const Kind& kind : kinds) {
        Scene scene;
        add_ball(scene, {0, 0, 0}, 1.0f, 12, kind.material);
        const Set set(scene, {even_sky(float(kBackground))});
        const Estimate e = estimate_to(kSharp, 1, [&](const dvec3& u, Rng& rng, double* out) {
            out[0] = everything(set.look(ray_through_disc(0.95, u.x, u.y, rng), u.z, rng));
        });
        rows.expect(kind.name, e.mean[0], e.error[0], kBackground, 4e-3 * kBackground);
    }
}

// Smoke that burns at one temperature, between walls of the same temperature: nothing distinguishes them, whatever
// either scatters.
TEST(Surfaces, SmokeAndWallsInEquilibriumHaveOneRadiance) {
    Rows rows("equilibrium");
    for (const float rho : {0.0f, 0.8f})
        for (const float albedo : {0.0f, 0.9f}) {
            Medium medium = make_medium(scattering_ball(24, 2.0, Rgb(albedo)));
            Scene scene;
            scene.origin = medium.world_of_local(vec3(0.0f));
            // One wall goes through the smoke.
            add_box(scene, {-1.5, -1.5, -1.5}, {1.5, 0.3f, 1.5}, gray_wall(rho), true);
            const Set set(scene, {}, std::move(medium));
            const Estimate e = estimate_to(kSharp, 1, [&](const dvec3& u, Rng& rng, double* out) {
                const dvec3 eye(1.2, -1.2, 1.1);
                out[0] = everything(set.look({eye, uniform_direction(u.x, u.y)}, u.z, rng));
            });
            rows.expect("walls " + std::to_string(rho) + ", smoke " + std::to_string(albedo), e.mean[0], e.error[0],
                        1.0, 1e-3);
        }
}

// Smoke that absorbs nothing, beside glass and plaster under an even sky, shows nothing either. All of the ledger's
// cells but those of the fire take part.
TEST(Surfaces, NothingIsLostBetweenSmokeAndSurfaces) {
    Recipe recipe = scattering_ball(24, 3.0, Rgb(1.0f));
    recipe.settings.smoke.mean_cosine = 0.5f;
    Medium medium = make_medium(recipe);
    medium.source.clear();
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    add_quad(scene, {-2, -2, -0.6f}, {4, 0, 0}, {0, 4, 0}, lambert(1.0f));
    SceneMaterial glass = lambert(1.0f);
    glass.surface.specular = glass.surface.transmission = 1.0f;
    glass.surface.roughness = 0.0f;
    add_ball(scene, {0.2f, 0.1f, 0.5f}, 0.4f, 8, glass);
    const Set set(scene, {even_sky(1.0f)}, std::move(medium));
    const Estimate e = estimate(1 + kCells, 96, [&](const dvec3& u, Rng& rng, double* out) {
        const PathSum sum = set.look(ray_through_disc(1.2, u.x, u.y, rng), u.z, rng);
        out[0] = everything(sum);
        for (int cell = 0; cell < kCells; ++cell)
            out[1 + cell] = sum.cells[cell].x;
    });
    EXPECT_NEAR(e.mean[0], 1.0, kSigmas * e.error[0] + 4e-3);
    EXPECT_NEAR(std::accumulate(e.mean.begin() + 1, e.mean.end(), 0.0), e.mean[0], 1e-6) << "cells are the whole";
    for (const Cell cell : {Cell::A, Cell::MM, Cell::MS, Cell::MA, Cell::SM, Cell::SS, Cell::SA})
        EXPECT_GT(e.mean[1 + static_cast<int>(cell)], 0.0) << name_of(cell);
    for (const Cell cell : {Cell::V, Cell::MV, Cell::SV})
        EXPECT_EQ(e.mean[1 + static_cast<int>(cell)], 0.0) << name_of(cell);
}

// Fire lights a surface as the same fire does that is made of emitting triangles: a black ball of radiance 1 has the
// irradiance of its solid angle.
TEST(Surfaces, FireLightsAWall) {
    Medium medium = make_medium(glowing_ball(32, 40.0f));
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    const float rho = 0.5f;
    add_quad(scene, {-9, -9, -3}, {18, 0, 0}, {0, 18, 0}, lambert(rho));
    for (const bool light_sampling : {true, false}) {
        TracingSettings settings;
        settings.light_sampling = light_sampling;
        const Set set(scene, {}, medium, settings, 1);
        const Estimate e = estimate_to(0.005, 2, [&](const dvec3& u, Rng& rng, double* out) {
            const PathSum sum = set.look({dvec3(0, 0, -2), dvec3(0, 0, -1)}, u.z, rng);
            out[0] = sum.cells.at(Cell::SV).x;
            out[1] = everything(sum);
        });
        // A sphere of radius R at distance D right above: irradiance pi (R / D)^2, reflected rho (R / D)^2. The opaque
        // lattice ball has its surface where its skin's depth is about 1: known to a part of a voxel.
        EXPECT_NEAR(e.mean[0], rho / 9.0, kSigmas * e.error[0] + 0.06 * rho / 9.0) << light_sampling;
        EXPECT_NEAR(e.mean[0], e.mean[1], 1e-9);
    }
}

// Both ways to find the fire agree where they can be compared sharply.
TEST(Surfaces, LightLinesChangeNoMean) {
    Medium medium = make_medium(scattering_ball(16, 2.0, Rgb(0.7f)));
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    SceneMaterial metal = lambert(0.9f);
    metal.surface.metallic = 0.5f;
    metal.surface.specular = 1.0f;
    metal.surface.roughness = 0.4f;
    add_quad(scene, {-3, -3, -1.2f}, {6, 0, 0}, {0, 6, 0}, metal);
    Estimate by[2];
    for (const bool light_sampling : {true, false}) {
        TracingSettings settings;
        settings.light_sampling = light_sampling;
        const Set set(scene, {}, medium, settings);
        by[light_sampling] = estimate_to(0.004, 1, [&](const dvec3& u, Rng& rng, double* out) {
            const dvec3 eye(2.5, -2.5, 0.5), target(u.x - 0.5, u.y - 0.5, -1.2);
            out[0] = everything(set.look({eye, glm::normalize(target - eye)}, u.z, rng));
        });
    }
    EXPECT_NEAR(by[0].mean[0], by[1].mean[0], kSigmas * std::hypot(by[0].error[0], by[1].error[0]));
}

// A point light over a floor, seen from above: rho / pi I h / d^3; and through smoke, times its transmittance.
TEST(Surfaces, LampsLightFloors) {
    LightSettings lamp;
    lamp.position = {0.0, 0.0, 2.0};
    lamp.power = Rgb(5.0f);
    Scene scene;
    add_quad(scene, {-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, lambert(0.5f));
    const Set set(scene, {lamp});
    Rng rng(Stream::Points, 1);
    const PathSum sum = set.look({dvec3(1, 0, 1), dvec3(0, 0, -1)}, 0.5, rng);
    EXPECT_NEAR(sum.cells.at(Cell::SA).x, 0.5 / kPi64 * 5.0 * 2.0 / std::pow(5.0, 1.5), 1e-6);
}

TEST(Surfaces, ThePlainTrackerRefusesThem) {
    TracingSettings plain;
    plain.emission = EmissionEstimator::Collision;
    Scene scene;
    add_quad(scene, {-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, lambert(0.5f));
    EXPECT_THROW(Set(scene, {}, {}, plain), Error);
}

}  // namespace
}  // namespace brisance::testing
