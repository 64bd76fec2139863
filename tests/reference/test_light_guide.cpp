// Directions toward the smoke's glow at surfaces: their density, what it learns from, and that guided paths tend to the
// same light as paths that know nothing of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "fixtures/sets.h"
#include "fixtures/tracing_fixture.h"

namespace brisance::testing {
namespace {

constexpr float kFloor = -1.1f;
constexpr double kEven = 0.004;  // relative standard error of integrals over directions

SceneMaterial glossy(float metallic, float roughness) {
    SceneMaterial m = lambert(0.7f);
    m.surface.specular = 1.0f;
    m.surface.metallic = metallic;
    m.surface.roughness = roughness;
    return m;
}

// A fire that fills a ball of 0.4 m inside bright smoke that hides it, a ball of 1 m with that optical radius.
Medium hidden_fire(double optical_radius) {
    constexpr int kNodes = 16;
    Recipe r = scattering_ball(kNodes, optical_radius, Rgb(0.9f));
    r.flame = [](const ivec3& n) { return 20.0f * ball(n, dvec3(0.0), 0.4 * kNodes); };
    return make_medium(r);
}

// A fire over a floor and before a wall, in the light of a lamp.
struct Yard {
    Yard(Medium m, const SceneMaterial& floor, const TracingSettings& settings = {}, int bounces = -1)
        : medium(std::make_unique<Medium>(std::move(m))) {
        Scene scene;
        scene.origin = medium->world_of_local(vec3(0.0f));
        add_quad(scene, {-4, -4, kFloor}, {8, 0, 0}, {0, 8, 0}, floor);
        add_quad(scene, {-4, 2, kFloor}, {8, 0, 0}, {0, 0, 6}, lambert(0.5f));
        LightSettings lamp;
        lamp.position = dvec3(2.0, -2.0, 3.0) + dvec3(scene.origin);
        lamp.power = Rgb(0.5f);
        surroundings = std::make_unique<Surroundings>(std::move(scene), std::vector<LightSettings>{lamp});
        tracer = std::make_unique<PathTracer>(*medium, settings, bounces, surroundings.get());
    }

    // Where a ray from above meets the floor.
    PathVertex on_floor(double x, double y, const dvec3& arriving) const {
        const dvec3 d = glm::normalize(arriving);
        const RaySegment segment = tracer->direct().segment_along({dvec3(x, y, kFloor) - d * 0.1, d});
        EXPECT_TRUE(segment.point);
        return {*segment.point, d};
    }

    std::unique_ptr<Medium> medium;
    std::unique_ptr<Surroundings> surroundings;
    std::unique_ptr<PathTracer> tracer;
};

TracingSettings unguided() {
    TracingSettings settings;
    settings.light_sampling = false;
    return settings;
}

const dvec3 kPlaces[] = {dvec3(0.1, -0.2, kFloor), dvec3(3.5, -3.0, kFloor), dvec3(0.3, 2.0, 1.0),
                         dvec3(0.2, 0.1, 0.3)};

TEST(LightGuide, TheGlowsDensityIntegratesToOne) {
    const Yard yard(hidden_fire(4.0), lambert(0.6f));
    const LightGuide* guide = yard.tracer->guide();
    ASSERT_TRUE(guide);
    Rows rows("integral of the glow's density");
    for (const dvec3& place : kPlaces) {
        const Estimate e = estimate_to(kSharp, 1, [&](const dvec3& u, Rng&, double* out) {
            out[0] = guide->glow().pdf({place, uniform_direction(u.x, u.y)}) * 4.0 * kPi64;
        });
        rows.expect("from " + std::to_string(place.x), e.mean[0], e.error[0], 1.0, 1e-6);
        EXPECT_GE(guide->share(place), 0.1f);
        EXPECT_LE(guide->share(place), 0.8f);
    }
}

// The integral of BSDF, cosine and a function of directions that neither the guide nor the BSDF knows, by the mixture,
// by the BSDF alone and, where no lobe is sharp, by uniform directions.
TEST(LightGuide, TheMixtureMeasuresWhatOtherDirectionsMeasure) {
    const auto some = [](const dvec3& d) { return std::exp(d.x - 0.5 * d.y) + d.z * d.z; };
    for (const SceneMaterial& floor : {lambert(0.6f), glossy(0.0f, 0.3f), glossy(1.0f, 0.25f), glossy(1.0f, 0.7f)}) {
        const Yard yard(hidden_fire(4.0), floor);
        const LightGuide* guide = yard.tracer->guide();
        ASSERT_TRUE(guide);
        for (const dvec3& arriving : {dvec3(0.2, 0.1, -1.0), dvec3(1.0, 0.3, -0.3)}) {
            const PathVertex vertex = yard.on_floor(0.4, 0.3, arriving);
            const Estimate e = estimate_to(kEven, 2, [&](const dvec3&, Rng& rng, double* out) {
                const auto guided = guide->sample(vertex, rng), own = vertex.sample(rng);
                out[0] = guided ? guided->weight.x * some(guided->wi) : 0.0;
                out[1] = own ? own->weight.x * some(own->wi) : 0.0;
            });
            const double error = std::hypot(e.error[0], e.error[1]);
            EXPECT_NEAR(e.mean[0], e.mean[1], kSigmas * error)
                << floor.surface.metallic << ", roughness " << floor.surface.roughness << ", " << arriving.z;
            if (floor.surface.roughness < 0.5f)
                continue;
            const Estimate even = estimate_to(kEven, 1, [&](const dvec3& u, Rng&, double* out) {
                const dvec3 d = uniform_direction(u.x, u.y);
                out[0] = vertex.at(d).value.x * some(d) * 4.0 * kPi64;
            });
            EXPECT_NEAR(e.mean[0], even.mean[0], kSigmas * std::hypot(e.error[0], even.error[0]) + 1e-4);
        }
    }
}

// Guided paths against paths that draw all directions from BSDFs and phase functions, and know no lines toward the fire
// either: cell by cell, within four standard errors. Eyes look at the floor and through the smoke at the wall.
TEST(GuidedPaths, TendToTheLightOfUnguidedOnesInEveryCell) {
    struct Case {
        const char* name;
        double optical_radius;
        SceneMaterial floor;
    };
    for (const Case& c :
         {Case{"thin smoke, plaster", 0.5, lambert(0.8f)}, Case{"hidden fire, plaster", 5.0, lambert(0.8f)},
          Case{"polish", 2.0, glossy(0.0f, 0.3f)}, Case{"metal", 2.0, glossy(1.0f, 0.35f)}}) {
        Estimate by[2];
        for (const bool guided : {false, true}) {
            const Yard yard(hidden_fire(c.optical_radius), c.floor, guided ? TracingSettings{} : unguided());
            ASSERT_EQ(yard.tracer->guide() != nullptr, guided);
            by[guided] = estimate(1 + kCells, guided ? 32 : 64, [&](const dvec3& u, Rng& rng, double* out) {
                const dvec3 eye(1.0, -3.5, 1.0), target(1.6 * u.x - 0.8, 2.0 * u.y - 1.2, kFloor + 0.6 * u.x * u.y);
                PathSum sum{};
                PathStatistics statistics;
                yard.tracer->trace({eye, glm::normalize(target - eye)}, u.z, rng, sum, statistics);
                double all = 0.0;
                for (const Rgb& order : sum)
                    all += order.x;
                out[0] = all;
                for (int cell = 0; cell < kCells; ++cell)
                    out[1 + cell] = sum.cells[cell].x;
            });
        }
        double all = 0.0;
        for (int k = 0; k <= kCells; ++k) {
            const double error = std::hypot(by[0].error[k], by[1].error[k]);
            const std::string cell = k ? name_of(static_cast<Cell>(k - 1)) : "all";
            EXPECT_NEAR(by[0].mean[k], by[1].mean[k], kSigmas * error + 1e-6) << c.name << ", " << cell;
            if (k)
                all += by[1].mean[k];
            if (by[0].mean[k] > 0.0)
                std::printf("%s, %s: %.5f, guided %+.2f %% +- %.2f %%\n", c.name, cell.c_str(), by[0].mean[k],
                            100.0 * (by[1].mean[k] / by[0].mean[k] - 1.0), 100.0 * error / by[0].mean[k]);
        }
        EXPECT_NEAR(all, by[1].mean[0], 1e-5 * by[1].mean[0]) << c.name;
        for (const Cell cell :
             {Cell::V, Cell::MV, Cell::MM, Cell::MS, Cell::MA, Cell::SV, Cell::SM, Cell::SS, Cell::SA})
            EXPECT_GT(by[1].mean[1 + static_cast<int>(cell)], 0.0) << c.name << ", " << name_of(cell);
    }
}

// Smoke without fire around a fire sends out nearly all the light: paths aim there, also past the fire itself.
TEST(LightGuide, SmokeThatHidesTheFireGlowsInItsPlace) {
    const Yard yard(hidden_fire(10.0), lambert(0.6f));
    const LightGuide* guide = yard.tracer->guide();
    ASSERT_TRUE(guide);
    Rng rng(Stream::Path, 1);
    int around = 0;
    constexpr int kDraws = 20000;
    for (int i = 0; i < kDraws; ++i)
        around += glm::length(guide->glow().draw(rng).position) > 0.5;
    // The fire ends at 0.4 m, six mean free paths below the smoke's skin.
    EXPECT_GT(around, kDraws * 3 / 4);
    // There is a direction to all of the skin.
    const dvec3 above(0.0, 0.1, 3.0);
    for (const double x : {-0.8, 0.0, 0.8}) {
        const Ray ray{above, glm::normalize(dvec3(x, 0.0, 0.0) - above)};
        EXPECT_GT(guide->glow().pdf(ray), 0.0) << x;
    }
    const Ray past{above, glm::normalize(dvec3(0.8, 0.0, 0.0) - above)};
    EXPECT_EQ(yard.tracer->direct().fire().pdf(past), 0.0);
}

// Fire in black smoke, so that light between surfaces can be compared sharply: one reflection (SV) and more (SS), from
// a point of the floor.
TEST(GuidedPaths, AgreeSharplyBetweenSurfaces) {
    for (const SceneMaterial& floor : {lambert(0.8f), glossy(1.0f, 0.5f)}) {
        Estimate by[2];
        for (const bool guided : {false, true}) {
            const Yard yard(make_medium(glowing_ball(8, 4.0f)), floor, guided ? TracingSettings{} : unguided(), 3);
            ASSERT_EQ(yard.tracer->guide() != nullptr, guided);
            const dvec3 arriving = glm::normalize(dvec3(0.1, 0.6, -0.8));
            const RaySegment segment =
                yard.tracer->direct().segment_along({dvec3(1.2, 0.4, kFloor) - arriving * 0.1, arriving});
            ASSERT_TRUE(segment.point);
            by[guided] = estimate_to(0.005, 2, [&](const dvec3&, Rng& rng, double* out) {
                PathSum sum{};
                yard.tracer->trace_from_surface(*segment.point, arriving, rng, sum);
                out[0] = sum.cells.at(Cell::SV).x;
                out[1] = sum.cells.at(Cell::SS).x;
            });
        }
        for (int k = 0; k < 2; ++k) {
            const double error = std::hypot(by[0].error[k], by[1].error[k]);
            EXPECT_NEAR(by[0].mean[k], by[1].mean[k], kSigmas * error) << floor.surface.metallic << ", " << k;
            std::printf("%s %g: %.5f, guided %+.2f %% +- %.2f %%\n", k ? "SS" : "SV", floor.surface.metallic,
                        by[0].mean[k], 100.0 * (by[1].mean[k] / by[0].mean[k] - 1.0), 100.0 * error / by[0].mean[k]);
        }
    }
}

TEST(LightGuide, IsMadeOnlyForSurfacesFireAndLightSampling) {
    EXPECT_TRUE(Yard(hidden_fire(2.0), lambert(0.6f)).tracer->guide());
    EXPECT_FALSE(Yard(hidden_fire(2.0), lambert(0.6f), unguided()).tracer->guide());
    EXPECT_FALSE(Yard(hidden_fire(2.0), lambert(0.6f), {}, 0).tracer->guide());
    Medium dark = hidden_fire(2.0);
    dark.source.clear();
    EXPECT_FALSE(Yard(std::move(dark), lambert(0.6f)).tracer->guide());
    const Medium medium = hidden_fire(2.0);
    EXPECT_FALSE(PathTracer(medium, {}, -1).guide());
    const Surroundings lamp_only(Scene{}, {LightSettings{}});
    EXPECT_FALSE(PathTracer(medium, {}, -1, &lamp_only).guide());
}

TEST(LightGuide, DoesNotDependOnTheNumberOfThreads) {
    const auto learned = [](int threads) {
        const ThreadLimit limit(threads);
        const Yard yard(hidden_fire(4.0), glossy(0.5f, 0.4f));
        std::vector<double> numbers;
        Rng rng(Stream::Path, 2);
        for (int i = 0; i < 2000; ++i) {
            const dvec3 place(8.0 * rng.next_double() - 4.0, 6.0 * rng.next_double() - 4.0, kFloor);
            numbers.push_back(yard.tracer->guide()->share(place));
            numbers.push_back(yard.tracer->guide()->glow().pdf({place, glm::normalize(-place)}));
        }
        return numbers;
    };
    EXPECT_EQ(learned(1), learned(4));
}

}  // namespace
}  // namespace brisance::testing
