#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "core/error.h"
#include "expect.h"
#include "measure_runs.h"
#include "methods.h"
#include "virtual_lights/choices.h"

namespace brisance {
namespace {

using Strings = std::vector<std::string>;

std::string joined(const Strings& words) {
    std::string all;
    for (const std::string& word : words)
        all += word + " ";
    return all;
}

std::vector<Method> parse(const Strings& methods, const Strings& budgets = {}, const Strings& ladders = {}) {
    return parse_methods({methods, budgets, ladders});
}

// The message of the usage error; empty when there is none.
std::string refusal(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Usage);
        return error.what();
    }
    return {};
}

std::string refusal(const Strings& methods, const Strings& budgets = {}, const Strings& ladders = {}) {
    return refusal([&] { parse(methods, budgets, ladders); });
}

Shot fire_shot() {
    Shot shot;
    shot.volume.file = "fire.vdb";
    return shot;
}

Strings labels(const Method& method) {
    Strings result;
    for (const MethodStep& step : method.steps)
        result.push_back(step.label);
    return result;
}

TEST(Methods, AreTheLightingGridAndThePathTracerUnlessNamed) {
    const std::vector<Method> methods = parse({});
    ASSERT_EQ(methods.size(), 2u);
    EXPECT_EQ(methods[0].label, "lighting_grid");
    EXPECT_EQ(methods[0].steps.size(), 4u);
    EXPECT_FALSE(methods[0].unbiased);
    EXPECT_FALSE(methods[0].averages);
    EXPECT_EQ(methods[1].label, "path");
    EXPECT_TRUE(methods[1].unbiased);
    EXPECT_TRUE(methods[1].averages);
    EXPECT_EQ(labels(methods[1]), (Strings{"4 spp", "16 spp", "64 spp", "256 spp"}));
}

TEST(Methods, HaveALabelAndSettings) {
    const Method method = parse({"woodcock=path,tracing.free_flight=null_collision,tracing.transmittance=ratio"})[0];
    EXPECT_EQ(method.label, "woodcock");
    EXPECT_EQ(method.base, "path");
    EXPECT_EQ(method.settings,
              (Strings{"method=path", "tracing.free_flight=null_collision", "tracing.transmittance=ratio"}));
    EXPECT_EQ(parse({"path,tracing.light_sampling=false"})[0].label, "path,tracing.light_sampling=false");
}

TEST(Methods, MayHaveListsForValues) {
    const Method method = parse({"a=path,smoke.albedo=[0.5,0.6,0.7],name=\"b,c\""})[0];
    EXPECT_EQ(method.settings, (Strings{"method=path", "smoke.albedo=[0.5,0.6,0.7]", "name=\"b,c\""}));
}

TEST(Methods, OfThePathTracerShareABudgetUnlessTheyHaveTheirOwn) {
    const std::vector<Method> methods =
        parse({"lighting_grid", "path", "path_plain"}, {"2,8", "path_plain:32", "lighting_grid:4,1"});
    EXPECT_EQ(labels(methods[1]), (Strings{"2 spp", "8 spp"}));
    EXPECT_EQ(methods[1].steps[0].settings, (Strings{"tracing.samples=2"}));
    EXPECT_EQ(labels(methods[2]), (Strings{"32 spp"}));
    ASSERT_EQ(methods[0].steps.size(), 2u);
    EXPECT_HAS(joined(methods[0].steps[0].settings), "lighting.error=0.01");
    EXPECT_HAS(joined(methods[0].steps[1].settings), "lighting.error=0.05");
}

TEST(Methods, KeepTheirOwnSettingsAtEveryStepOfTheBuiltInLadder) {
    const Method method = parse({"near=lighting_grid,lighting.alpha=4"})[0];
    for (const MethodStep& step : method.steps)
        EXPECT_LACKS(joined(step.settings), "lighting.alpha=");
    // Steps that would then be the same are one.
    const Method fixed = parse({"a=lighting_grid,lighting.alpha=2,lighting.error=0.02,scattering.alpha=1"})[0];
    EXPECT_EQ(fixed.steps.size(), 1u);
}

TEST(Methods, OfLampsHaveALadderOfTheirNumbers) {
    const std::vector<Method> methods =
        parse({"fire_clusters", "few=fire_clusters,lighting.energy_balance=false"}, {"16", "few:2,8"});
    EXPECT_EQ(labels(methods[0]), (Strings{"4 lamps", "16 lamps", "64 lamps", "256 lamps"}))
        << "a budget of paths is not theirs";
    EXPECT_EQ(labels(methods[1]), (Strings{"2 lamps", "8 lamps"}));
    EXPECT_EQ(methods[1].steps[1].settings, (Strings{"lighting.clusters=8"}));
    EXPECT_FALSE(methods[0].unbiased);
    EXPECT_TRUE(owns(methods[0], "SV"));
    EXPECT_FALSE(owns(methods[0], "V"));
}

TEST(Methods, OfTheFiresLightsOwnWhatItLightsOnce) {
    for (const Method& method : parse({"fire_intensity", "fire_multidimensional_lightcuts"}, {})) {
        EXPECT_TRUE(owns(method, "MV"));
        EXPECT_TRUE(owns(method, "SV"));
        EXPECT_FALSE(owns(method, "MM"));
        EXPECT_FALSE(owns(method, "SM"));
    }
}

TEST(Methods, OfCascadesHaveALadderOfTheirDirections) {
    const std::vector<Method> methods = parse({"radiance_cascades", "few=radiance_cascades"}, {"few:2,3"});
    EXPECT_EQ(labels(methods[0]), (Strings{"4 x 4 directions", "8 x 8 directions", "16 x 16 directions"}));
    EXPECT_EQ(methods[1].steps[1].settings, (Strings{"scattering.cascade_side=3"}));
    EXPECT_HAS(joined(methods[0].settings), "scattering.solver=radiance_cascades");
    EXPECT_TRUE(owns(methods[0], "MM"));
    EXPECT_FALSE(owns(methods[0], "MV"));
}

TEST(Methods, OfDiffusionHaveALadderOfTheirLattices) {
    const std::vector<Method> methods =
        parse({"diffusion", "fine=diffusion,scattering.flux_limiter=false"}, {"fine:0"});
    EXPECT_EQ(labels(methods[0]), (Strings{"lattice level 2", "lattice level 1", "lattice level 0"}));
    EXPECT_EQ(methods[1].steps[0].settings, (Strings{"scattering.lattice_level=0"}));
    EXPECT_HAS(joined(methods[1].settings), "scattering.solver=diffusion");
    EXPECT_HAS(joined(methods[1].settings), "scattering.flux_limiter=false");
    EXPECT_TRUE(owns(methods[0], "MM"));
    EXPECT_FALSE(owns(methods[0], "MV"));
}

TEST(Methods, ThatFilterNoiseTakePathsButAreBiased) {
    const std::vector<Method> methods = parse({"path_filtered", "path", "p=path,tracing.denoising_radius=2", "q=path"},
                                              {"4,8"}, {"q:tracing.denoising_radius=0,3"});
    EXPECT_EQ(labels(methods[0]), labels(methods[1]));
    EXPECT_FALSE(methods[0].unbiased);
    EXPECT_FALSE(methods[0].averages);
    EXPECT_TRUE(methods[1].unbiased);
    EXPECT_FALSE(methods[2].unbiased);
    EXPECT_FALSE(methods[2].averages);
    EXPECT_FALSE(methods[3].unbiased);
}

TEST(Ladders, GoSideBySide) {
    const Method method =
        parse({"lighting_grid"}, {},
              {"lighting_grid:lighting.alpha=1,2,3", "lighting_grid:lighting.shadow_resolution=8,16,24"})[0];
    ASSERT_EQ(method.steps.size(), 3u);
    EXPECT_EQ(method.steps[1].settings, (Strings{"lighting.alpha=2", "lighting.shadow_resolution=16"}));
    EXPECT_EQ(method.steps[1].label, "alpha=2 shadow_resolution=16");
}

TEST(Ladders, OfTimesEndByTimeAlone) {
    const Method method = parse({"path"}, {}, {"path:tracing.seconds=1,10"})[0];
    EXPECT_EQ(method.steps[0].label, "1 s");
    EXPECT_EQ(method.steps[1].settings, (Strings{"tracing.seconds=10", "tracing.samples=none"}));
    EXPECT_TRUE(method.averages);
}

TEST(Ladders, OfOtherSettingsDoNotAverage) {
    const Method method = parse({"p=path,tracing.samples=16"}, {}, {"p:tracing.transmittance=exact,ratio"})[0];
    EXPECT_TRUE(method.unbiased);
    EXPECT_FALSE(method.averages);
}

TEST(Methods, ThatSayWhenTheyStopHaveOneStep) {
    const Method samples = parse({"p=path,tracing.samples=16", "path"}, {"4,8"})[0];
    EXPECT_EQ(labels(samples), (Strings{"16 spp"}));
    const Method seconds = parse({"p=path,tracing.seconds=5"})[0];
    EXPECT_EQ(seconds.steps[0].settings, (Strings{"tracing.samples=none"}));
}

TEST(Methods, ThatCannotBeAreRefusedByName) {
    EXPECT_HAS(refusal({"photons"}), "no method is called \"photons\"; there are lighting_grid, path");
    EXPECT_HAS(refusal({"path", "path"}), "two are called path");
    EXPECT_HAS(refusal({"=path"}), "label");
    EXPECT_HAS(refusal({"a:b=path"}), "colon");
    EXPECT_HAS(refusal({"path,fast"}), "\"fast\" is no setting");
    EXPECT_HAS(refusal({"path,method=lighting_grid"}), "stands first");
    EXPECT_HAS(refusal({""}), "no method");
}

TEST(Ladders, ThatCannotBeAreRefusedByName) {
    EXPECT_HAS(refusal({"path"}, {"grid:1,2"}), "--budgets grid: no method has this label; there are path");
    EXPECT_HAS(refusal({"path"}, {"4,16", "8"}), "given twice for all path methods");
    EXPECT_HAS(refusal({"lighting_grid"}, {"lighting_grid:0"}), "1 to 4, not \"0\"");
    EXPECT_HAS(refusal({"lighting_grid"}, {"lighting_grid:2x"}), "1 to 4, not \"2x\"");
    EXPECT_HAS(refusal({"path"}, {}, {"path:tracing.samples"}), "METHOD:KEY=");
    EXPECT_HAS(refusal({"path"}, {}, {"tracing.samples=4"}), "METHOD:KEY=");
    EXPECT_HAS(refusal({"path"}, {}, {"plain:tracing.samples=4"}), "no method has this label");
    EXPECT_HAS(refusal({"path"}, {"path:4"}, {"path:tracing.samples=4"}), "leave one of the two out");
    EXPECT_HAS(refusal({"p=path,tracing.samples=4"}, {"p:4"}), "leave one of the two out");
    EXPECT_HAS(refusal({"lighting_grid"}, {}, {"lighting_grid:lighting.alpha=1,2", "lighting_grid:lighting.levels=3"}),
               "lighting.alpha has 2 values and lighting.levels has 1");
}

TEST(Runs, OfEveryBuiltInMethodAreShots) {
    Shot base = fire_shot();
    base.tracing.seconds = 3.0;
    const std::vector<PlannedMethod> planned = plan_runs(base, parse({"lighting_grid", "path", "path_plain"}));
    ASSERT_EQ(planned.size(), 3u);
    const Shot& grid = planned[0].runs[2].shot;
    EXPECT_EQ(grid.lighting.alpha, Shot().lighting.alpha) << "step 3 is the default";
    EXPECT_EQ(grid.lighting.error, Shot().lighting.error);
    EXPECT_EQ(grid.scattering.alpha, Shot().scattering.alpha);
    const Shot& plain = planned[2].runs[1].shot;
    EXPECT_EQ(plain.method, RenderMethod::Path);
    EXPECT_EQ(plain.tracing.samples, 16);
    EXPECT_EQ(plain.tracing.seconds, 0.0) << "the step alone says when to stop";
    EXPECT_EQ(plain.tracing.emission, EmissionEstimator::Collision);
    EXPECT_EQ(plain.tracing.free_flight, FreeFlight::NullCollision);
    EXPECT_FALSE(plain.tracing.light_sampling);
    EXPECT_HAS(joined(planned[2].runs[1].settings), "tracing.seconds=none");
}

// Of a shot that has lamps and filters itself, other methods are run without.
TEST(Runs, OfBaselinesAreTheirsAlone) {
    Shot base = fire_shot();
    base.lighting.clusters = 7;
    base.tracing.denoising_radius = 9;
    base.scattering.solver = ScatteringSolver::RadianceCascades;
    const std::vector<PlannedMethod> planned =
        plan_runs(base, parse({"lighting_grid", "path", "fire_clusters", "path_filtered", "radiance_cascades"}));
    EXPECT_EQ(planned[0].runs[0].shot.scattering.solver, ScatteringSolver::Hierarchy);
    EXPECT_EQ(planned[4].runs[0].shot.scattering.solver, ScatteringSolver::RadianceCascades);
    EXPECT_EQ(planned[0].runs[0].shot.lighting.clusters, 0);
    EXPECT_EQ(planned[1].runs[0].shot.tracing.denoising_radius, 0);
    EXPECT_EQ(planned[2].runs[1].shot.lighting.clusters, 16);
    EXPECT_EQ(planned[3].runs[0].shot.tracing.denoising_radius, 5);
    EXPECT_EQ(planned[3].runs[0].shot.method, RenderMethod::Path);
}

TEST(Runs, OfVirtualLightsChangeTheirChoicesAndTheSamples) {
    Shot base = fire_shot();
    base.camera.eye = dvec3(0.0, -6.0, 0.0);
    base.camera_given = true;
    std::vector<std::string> names = {"vbnl",
                                      "vbnl_resampled",
                                      "vbnl_power",
                                      "vbnl_light_tree",
                                      "vbnl_bsdf",
                                      "rich_vsl",
                                      "vsl",
                                      "vpl",
                                      "ray_lights",
                                      "volumetric_photons",
                                      "volumetric_vpls",
                                      "volumetric_vpls_bounded",
                                      "volumetric_vpls_compensated",
                                      "volumetric_vpls_local",
                                      "photon_points",
                                      "photon_points_3d",
                                      "photon_beams"};
    for (const TechniquePreset& preset : light_presets())
        if (std::find(names.begin(), names.end(), preset.name) == names.end())
            names.push_back(preset.name);
    const std::vector<PlannedMethod> planned = plan_runs(base, parse(names, {"rich_vsl:2,4", "4"}));
    ASSERT_EQ(planned.size(), names.size());
    std::set<std::string> looks;
    for (const PlannedMethod& method : planned) {
        looks.insert(joined(method.runs[0].settings));
        EXPECT_EQ(method.runs[0].shot.method, RenderMethod::LightingGrid) << method.method.label;
    }
    EXPECT_EQ(looks.size(), names.size()) << "no two of them are the same";
    EXPECT_EQ(planned[0].runs.size(), 4u) << "a budget of paths is not theirs";
    ASSERT_EQ(planned[5].runs.size(), 2u);
    EXPECT_EQ(planned[5].runs[0].shot.camera.samples_per_axis, 2) << "also where the camera is given";
    EXPECT_EQ(planned[5].runs[1].shot.camera.samples_per_axis, 4);
    EXPECT_EQ(planned[5].runs[1].shot.virtual_lights.kind, "sphere");
    EXPECT_EQ(planned[7].runs[0].shot.virtual_lights.flux, "own");
}

TEST(Runs, OfAShotOfSurfacesAloneAreShots) {
    Shot base = fire_shot();
    base.volume.file.clear();
    base.scene.quads.emplace_back();
    EXPECT_EQ(plan_runs(base, parse({"path", "vbnl"})).size(), 2u);
}

TEST(Runs, ShareNoSeedWithTheReference) {
    const auto settings = [](const std::set<int>& taken, const std::string& method) {
        return plan_runs(fire_shot(), parse({method}, {}), taken)[0].runs[0];
    };
    EXPECT_EQ(settings({}, "path").shot.tracing.seed, 0);
    EXPECT_EQ(settings({0, 1}, "path").shot.tracing.seed, 2);
    EXPECT_HAS(joined(settings({0, 1}, "path").settings), "tracing.seed=2");
    EXPECT_EQ(settings({0, 1}, "p=path,tracing.seed=1").shot.tracing.seed, 2);
    EXPECT_EQ(settings({0, 1}, "p=path,tracing.seed=7").shot.tracing.seed, 7);
    EXPECT_LACKS(joined(settings({0, 1}, "lighting_grid").settings), "tracing.seed");
}

TEST(Runs, ThatWouldShowSomethingElseAreRefused) {
    const std::string thin = refusal([] { plan_runs(fire_shot(), parse({"thin=path,smoke.albedo=0.1"})); });
    EXPECT_HAS(thin, "thin, 4 spp");
    EXPECT_HAS(thin, "smoke.albedo");
    EXPECT_HAS(refusal([] { plan_runs(fire_shot(), parse({"p=path,scattering.bounces=1"})); }), "scattering.bounces");
    EXPECT_HAS(refusal([] { plan_runs(fire_shot(), parse({"path"}, {"1"})); }), "tracing.samples");
    EXPECT_HAS(refusal([] { plan_runs(fire_shot(), parse({"path,tracing.fast=true"})); }), "tracing.fast");
}

}  // namespace
}  // namespace brisance
