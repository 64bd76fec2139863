// Other kinds of virtual lights: the energy that they lose or conserve, and the agreement of all gatherers.
#include <gtest/gtest.h>

#include "core/parallel.h"
#include "room.h"
#include "virtual_lights/choices.h"

namespace brisance {
namespace {

using namespace testing;

// Gatherers that do without rays: those for points.
std::vector<std::string> by_lights_alone() {
    std::vector<std::string> names;
    for (const TechniqueChoice& gatherer : light_gatherers()) {
        VirtualLightSettings settings;
        settings.kind = "point";
        settings.path_extension = false;
        settings.sampling = gatherer.name;
        if (why_not_together(settings).empty())
            names.push_back(gatherer.name);
    }
    return names;
}

// Floor and ceiling 2 m apart, without walls, and a lamp under the ceiling that shines down. Whatever surfaces send
// each other travels 2 m and more: no light is near a point that it lights, the cosine over the squared distance is 1/4
// per m^2 at most.
SceneSettings two_plates() {
    SceneSettings scene = coloured_room();
    const QuickQuad floor = scene.quads[2], ceiling = scene.quads[3], lamp = scene.quads.back();
    scene.quads = {floor, ceiling, lamp};
    return scene;
}

struct Mean {
    double value = 0.0, error = 0.0;
};

Mean by_lights(const Room& room, const VirtualLightSettings& settings, std::uint64_t per_batch) {
    const VirtualLights lights = room.lights(settings);
    const Estimate e = estimate(1, per_batch, [&](const dvec3& u, Rng& rng, double* out) {
        out[0] = luminance(room.by_lights(lights, u.x, u.y, rng));
    });
    return {e.mean[0], e.error[0]};
}

Mean by_paths(const Room& room) {
    const Estimate e = estimate(
        1, 512, [&](const dvec3& u, Rng& rng, double* out) { out[0] = luminance(room.by_paths(u.x, u.y, rng)); });
    return {e.mean[0], e.error[0]};
}

// Over independent sets of lights: their own noise is in the error.
Mean over_sets_of_lights(const Room& room, VirtualLightSettings settings) {
    constexpr int kSets = 48, kSamples = 4096;
    double sum = 0.0, squares = 0.0;
    for (int set = 0; set < kSets; ++set) {
        settings.seed = static_cast<std::uint32_t>(set);
        const VirtualLights lights = room.lights(settings);
        double mean = 0.0;
        for (std::uint64_t i = 0; i < kSamples; ++i) {
            Rng rng(Stream::Path, static_cast<std::uint64_t>(set), i);
            const double x = rng.next_double(), y = rng.next_double();
            mean += luminance(room.by_lights(lights, x, y, rng)) / kSamples;
        }
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / kSets;
    return {mean, std::sqrt(std::max(0.0, squares / kSets - mean * mean) / (kSets - 1.0))};
}

void expect_same(const Mean& ours, const Mean& theirs, double allowed, const std::string& what) {
    EXPECT_NEAR(ours.value, theirs.value, allowed * theirs.value + kSigmas * std::hypot(ours.error, theirs.error))
        << what;
    EXPECT_LT(ours.error, 0.03 * theirs.value) << what << ": not sampled enough";
}

// What a bound that is nowhere reached takes is nothing: instant radiosity is unbiased, wherever the lights come from.
TEST(PlainPoints, WithoutBoundAreUnbiased) {
    const Room room(two_plates());
    const Mean truth = by_paths(room);
    for (const TechniqueChoice& placement : light_placements()) {
        VirtualLightSettings settings = of_photons("point");
        settings.point_bound = 1e9;
        settings.placement = placement.name;
        if (why_not_together(settings).empty())
            expect_same(over_sets_of_lights(room, settings), truth, 0.0, placement.name);
    }
}

// Half of what the nearest lights send may pass: at 2 m a quarter over m^2 is what there is.
TEST(PlainPoints, LoseWhatTheirBoundTakes) {
    const Room room(two_plates());
    VirtualLightSettings settings = of_photons("point");
    settings.point_bound = 0.05;
    const Mean bounded = over_sets_of_lights(room, settings), truth = by_paths(room);
    EXPECT_LT(bounded.value + kSigmas * bounded.error, 0.8 * truth.value);
    EXPECT_GT(bounded.value, 0.2 * truth.value);
}

// In a room with corners the loss is what falls in the last decimetres: less for a larger bound.
TEST(PlainPoints, LoseLessWithALargerBound) {
    const Room room(coloured_room());
    const Mean truth = by_paths(room);
    double before = 0.0;
    for (const double bound : {0.3, 3.0, 30.0}) {
        VirtualLightSettings settings = of_photons("point");
        settings.point_bound = bound;
        const Mean bounded = over_sets_of_lights(room, settings);
        EXPECT_LT(bounded.value, truth.value + kSigmas * bounded.error) << bound;
        EXPECT_GT(bounded.value, before) << bound;
        before = bounded.value;
    }
    EXPECT_GT(before, 0.9 * truth.value);
}

// The whole geometry term is smaller than its part: the same bound takes less.
TEST(PlainPoints, LoseLessByABoundOnBothCosines) {
    const Room room(coloured_room());
    VirtualLightSettings settings = of_photons("point");
    settings.point_bound = 0.3;
    const Mean one = over_sets_of_lights(room, settings);
    settings.point_bound_of = BoundedTerm::BothCosines;
    const Mean both = over_sets_of_lights(room, settings), truth = by_paths(room);
    EXPECT_GT(both.value, one.value + kSigmas * std::hypot(both.error, one.error));
    EXPECT_LT(both.value, truth.value - kSigmas * std::hypot(both.error, truth.error));
}

// A bound on what a light adds takes more the smaller it is, and nothing where no light adds as much. Narrow lobes of a
// glossy floor, whose geometry is harmless, lose to it as well.
TEST(PlainPoints, LoseWhatABoundOnContributionsTakes) {
    const Room room(glossy_room());
    VirtualLightSettings settings = of_photons("point");
    settings.count = 60;
    settings.sampling = "all";
    settings.point_bound = 1e9;
    // Of the same rays and lights at every bound.
    const auto mean = [&] {
        const VirtualLights lights = room.lights(settings);
        constexpr int kSamples = 4096;
        double sum = 0.0;
        for (int i = 0; i < kSamples; ++i) {
            Rng rng(Stream::Path, 1, std::uint64_t(i));
            const double x = rng.next_double(), y = rng.next_double();
            sum += luminance(room.by_lights(lights, x, y, rng)) / kSamples;
        }
        return sum;
    };
    const double unbounded = mean();
    settings.contribution_bound = 1e9;
    EXPECT_EQ(mean(), unbounded);
    double before = unbounded;
    for (const double share : {1.0, 0.1, 0.01}) {  // of what all lights add together
        settings.contribution_bound = share * unbounded;
        const double bounded = mean();
        EXPECT_LT(bounded, before) << share;
        EXPECT_LT(bounded, 60.0 * settings.contribution_bound) << share;
        EXPECT_GT(bounded, 0.0) << share;
        before = bounded;
    }
    EXPECT_LT(before, 0.6 * unbounded);
}

// T = T_b + T_r: what the bound takes away paths find again, whatever the bound is on.
TEST(PlainPoints, AreUnbiasedWithCompensation) {
    for (const SceneSettings& scene : {coloured_room(), glossy_room()}) {
        const Room room(scene);
        const Mean truth = by_paths(room);
        for (const BoundedTerm of : {BoundedTerm::LightCosine, BoundedTerm::BothCosines}) {
            VirtualLightSettings settings = of_photons("point");
            settings.compensation = BoundCompensation::Exact;
            settings.point_bound = 0.3;
            settings.point_bound_of = of;
            expect_same(over_sets_of_lights(room, settings), truth, 0.0, std::to_string(static_cast<int>(of)));
        }
    }
}

// Of Lambert surfaces there is nothing else; of a rough metal floor nothing is left.
TEST(PlainPoints, OfDiffuseLightLoseWhatIsNotLambert) {
    VirtualLightSettings diffuse = of_photons("diffuse_point"), full = of_photons("point");
    const Room plain(coloured_room()), glossy(glossy_room());
    expect_same(by_lights(plain, diffuse, 128), by_lights(plain, full, 128), 0.0, "Lambert surfaces");
    const Mean some = by_lights(glossy, diffuse, 256), all = by_lights(glossy, full, 256);
    EXPECT_LT(some.value + kSigmas * some.error, all.value - kSigmas * all.error);
}

// A ball of 0.15 m spreads what it sends over directions two metres off: about r^2 / d^2, less than 2 %; over the edge
// of the plate no surface is missing, as it is the sender that is widened.
TEST(PlainSpheres, KeepTheirEnergy) {
    const Room room(two_plates());
    expect_same(over_sets_of_lights(room, of_photons("sphere")), by_paths(room), 0.02, "spheres");
}

// From pass to pass spheres shrink, by the ratio that passes of any blur have, and lights lie elsewhere.
TEST(PlainSpheres, ShrinkOverPasses) {
    const Room room(coloured_room());
    VirtualLightSettings settings = of_photons("sphere");
    settings.passes = 3;
    const auto lights_of = [&](int pass) { return room.lights(settings_of_pass(settings, pass)); };
    const auto mean_radius = [](const VirtualLights& lights) {
        double sum = 0.0;
        for (const VirtualLight& light : lights.lights())
            sum += light.radius / double(lights.lights().size());
        return sum;
    };
    const VirtualLights first = lights_of(0), second = lights_of(1), third = lights_of(2);
    EXPECT_NE(first.lights().front().position, second.lights().front().position);
    EXPECT_NE(second.lights().front().position, third.lights().front().position);
    // Other lights have other distances: by some percent.
    EXPECT_NEAR(mean_radius(second) / mean_radius(first), std::sqrt(1.7 / 2.0), 0.05);
    EXPECT_NEAR(mean_radius(third) / mean_radius(second), std::sqrt(2.7 / 3.0), 0.05);
    settings.sphere_shrinking = 1.0;
    EXPECT_NEAR(mean_radius(lights_of(2)) / mean_radius(first), 1.0, 0.05);
}

TEST(PlainLights, AreAboutAsManyAsAsked) {
    const Room room(coloured_room());
    const VirtualLights lights = room.lights(of_photons("point"));
    EXPECT_NEAR(double(lights.lights().size()), 500.0, 75.0);
    double flux = 0.0;
    for (const VirtualLight& light : lights.lights())
        flux += luminance(light.flux);
    // Reflected is what arrived, times colours between 0.1 and 0.7.
    EXPECT_GT(flux, 0.1 * lights.report().photons.shared);
    EXPECT_LT(flux, 0.7 * lights.report().photons.shared);
}

// All kinds and all placements: the path tracer's mean, with 2 % for blur and 10^5 photons' noise.
TEST(EveryKind, AgreesWithPathsBetweenPlates) {
    const Room room(two_plates());
    const Mean truth = by_paths(room);
    for (const TechniqueChoice& kind : light_kinds())
        for (const TechniqueChoice& placement : light_placements()) {
            VirtualLightSettings settings = sampled_by("power", kind.name);
            settings.placement = placement.name;
            expect_same(by_lights(room, settings, 128), truth, 0.02,
                        "kind " + kind.name + ", placement " + placement.name);
        }
}

// Of one set of lights in a room with corners, so that what agrees are the gatherers.
void expect_one_mean(VirtualLightSettings settings, const SceneSettings& scene = glossy_room()) {
    const Room room(scene);
    settings.count = 60;
    settings.sampling = "all";
    settings.point_bound = 3.0;
    const Mean truth = by_lights(room, settings, 24);
    for (const std::string& sampling : by_lights_alone()) {
        settings.sampling = sampling;
        // Of one set of lights lightcuts have the mean only if they may not err.
        settings.lightcuts_error = 0.0;
        const bool all = sampling == "all" || sampling == "lightcuts";
        expect_same(by_lights(room, settings, all ? 24 : 256), truth, 0.0,
                    "sampling " + sampling + " of kind " + settings.kind);
    }
}

TEST(EverySampling, HasOneMeanOfPatches) {
    expect_one_mean(sampled_by("all", "patch"), coloured_room());
}

TEST(EverySampling, HasOneMeanOfRichSpheres) {
    VirtualLightSettings settings = sampled_by("all", "sphere");
    settings.placement = "relaxed_light_paths";
    expect_one_mean(settings);
}

TEST(EverySampling, HasOneMeanOfRichPoints) {
    expect_one_mean(sampled_by("all", "point"));
}

TEST(EverySampling, HasOneMeanOfPlainSpheres) {
    expect_one_mean(of_photons("sphere"));
}

TEST(EverySampling, HasOneMeanOfPlainPoints) {
    expect_one_mean(of_photons("point"));
}

// Of one candidate resampling is sampling by power; of any number the mean is the same.
TEST(Resampling, HasOneMeanForAnyNumberOfCandidates) {
    const Room room(glossy_room());
    const Mean truth = by_lights(room, sampled_by("power", "patch"), 512);
    for (const int candidates : {1, 2, 8, 64}) {
        VirtualLightSettings settings = sampled_by("resampled", "patch");
        settings.resampling_candidates = candidates;
        expect_same(by_lights(room, settings, candidates > 8 ? 64 : 256), truth, 0.0, std::to_string(candidates));
    }
}

TEST(Resampling, OfManyCandidatesHasLessNoise) {
    const Room room(two_plates());
    VirtualLightSettings settings = sampled_by("resampled", "sphere");
    const auto error_of = [&](int candidates) {
        settings.resampling_candidates = candidates;
        return by_lights(room, settings, 64).error;
    };
    EXPECT_LT(error_of(32), 0.7 * error_of(1));
}

// One direction is of the cone alone; of sixteen some are of the floor's BSDF and some of a glossy light's. Each of the
// three alone has the same mean.
TEST(EverySampling, HasOneMeanForAnyNumberAndTechniqueOfSphereSamples) {
    const Room room(glossy_room());
    for (VirtualLightSettings settings : {of_photons("sphere"), sampled_by("power", "sphere")}) {
        settings.sphere_samples = 1;
        const Mean one = by_lights(room, settings, 512);
        settings.sphere_samples = 16;
        for (const SphereSampling sampling :
             {SphereSampling::Combined, SphereSampling::Cone, SphereSampling::Vertex, SphereSampling::Light}) {
            settings.sphere_sampling = sampling;
            expect_same(by_lights(room, settings, 256), one, 0.0,
                        settings.flux + std::to_string(static_cast<int>(sampling)));
        }
    }
}

// The lights and what some rays see of them, to the bit.
std::vector<float> fingerprint(const VirtualLightSettings& settings, int threads) {
    const ThreadLimit limit(threads);
    const Room room(glossy_room());
    const VirtualLights lights = room.lights(settings);
    std::vector<float> out;
    for (const VirtualLight& light : lights.lights())
        for (const double x : {light.position.x, light.radius, light.area, light.power, light.intensity})
            out.push_back(static_cast<float>(x));
    for (std::uint64_t i = 0; i < 200; ++i) {
        Rng rng(Stream::Path, i);
        const double x = rng.next_double(), y = rng.next_double();
        const Rgb seen = room.by_lights(lights, x, y, rng);
        out.insert(out.end(), {seen.x, seen.y, seen.z});
    }
    return out;
}

TEST(EverySampling, HasTheSameBitsOnAnyThreads) {
    VirtualLightSettings rich = sampled_by("resampled", "sphere");
    rich.placement = "relaxed_light_paths";
    VirtualLightSettings rejected = of_photons("point", "lightcuts"), mutated = of_photons("point", "plain_power");
    rejected.placement = "rejection";
    mutated.placement = "metropolis";
    VirtualLightSettings repelled = rich;
    repelled.placement = "repelled_light_paths";
    VirtualLightSettings both_ways = sampled_by("stochastic_lightcuts", "sphere");
    both_ways.placement = "bidirectional";
    for (const VirtualLightSettings& settings :
         {rich, of_photons("sphere", "light_tree"), of_photons("point"), rejected, mutated, both_ways, repelled}) {
        const std::vector<float> one = fingerprint(settings, 1);
        EXPECT_GT(one.size(), 2000u);
        EXPECT_EQ(one, fingerprint(settings, 2));
        EXPECT_EQ(one, fingerprint(settings, 8));
    }
}

// Nobody may take light from nowhere: no particle arrives, no light, no radiance.
TEST(Baselines, InTheDarkOrWithoutSurfacesAreBlack) {
    SceneSettings scene;
    scene.lights.emplace_back();
    const Room room(scene);
    EXPECT_TRUE(room.lights(of_photons("point")).lights().empty());
    SceneSettings black;
    add_walls(black, dvec3(-1.0), dvec3(1.0), lambert(Rgb(0.0f)));
    add_lamp(black, {-0.3, 0.0, -0.3}, {0.3, 0.0, 0.3}, 0.95, Rgb(10.0f));
    const Room absorbing(black);
    for (const std::string kind : {"point", "sphere"}) {
        const VirtualLights lights = absorbing.lights(of_photons(kind, "resampled"));
        EXPECT_TRUE(lights.lights().empty());
        Rng rng(Stream::Path, 0);
        EXPECT_EQ(absorbing.by_lights(lights, 0.5, 0.5, rng), Rgb(0.0f));
    }
}

TEST(Baselines, OfOneLightAreFinite) {
    const Room room(coloured_room());
    for (const std::string& sampling : by_lights_alone()) {
        VirtualLightSettings settings = sampled_by(sampling, "sphere");
        settings.count = 1;
        const VirtualLights lights = room.lights(settings);
        for (const VirtualLight& light : lights.lights())
            EXPECT_GT(light.radius, 0.0);
        Rng rng(Stream::Path, 0);
        EXPECT_TRUE(std::isfinite(room.by_lights(lights, 0.5, 0.9, rng).x));
    }
}

}  // namespace
}  // namespace brisance
