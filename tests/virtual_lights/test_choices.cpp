// The table of techniques, and the keys and presets that are read from it.
#include "virtual_lights/choices.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/error.h"
#include "room.h"
#include "shot/keys/keys.h"

namespace brisance {
namespace {

using namespace testing;

const Key& key_of(const std::string& name) {
    for (const Key& key : shot_keys())
        if (key.path == "virtual_lights." + name)
            return key;
    throw std::runtime_error("no key " + name);
}

std::vector<std::string> names_of(const std::vector<TechniqueChoice>& choices) {
    std::vector<std::string> names;
    for (const TechniqueChoice& c : choices)
        names.push_back(c.name);
    return names;
}

bool accepted(const VirtualLightSettings& settings) {
    try {
        check(settings);
        return true;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Usage) << error.what();
        return false;
    }
}

TEST(Choices, AreTheSchemasNames) {
    const std::pair<const char*, const std::vector<TechniqueChoice>&> tables[] = {{"placement", light_placements()},
                                                                                  {"flux", light_fluxes()},
                                                                                  {"kind", light_kinds()},
                                                                                  {"sampling", light_gatherers()}};
    for (const auto& [name, choices] : tables) {
        EXPECT_EQ(key_of(name).schema.at("enum").get<std::vector<std::string>>(), names_of(choices)) << name;
        EXPECT_EQ(key_of(name).get(Shot()).value(), choices.front().name) << name << ": the first is the default";
        for (const TechniqueChoice& choice : choices)
            EXPECT_NE(key_of(name).help.find(choice.name + ": " + choice.help), std::string::npos) << choice.name;
    }
}

// Shots from before there were three said true or false.
TEST(Choices, OfCompensationAreReadAsBefore) {
    const Key& key = key_of("compensation");
    EXPECT_EQ(key.get(Shot()).value(), light_compensations().front().name);
    for (const CompensationChoice& choice : light_compensations()) {
        Shot shot;
        EXPECT_TRUE(key.set(shot, choice.name));
        EXPECT_EQ(shot.virtual_lights.compensation, choice.value);
        EXPECT_EQ(key.get(shot).value(), choice.name);
        EXPECT_NE(key.help.find(choice.name + ": " + choice.help), std::string::npos) << choice.name;
    }
    for (const auto& [old, name] : {std::pair(true, "exact"), std::pair(false, "none")}) {
        Shot shot;
        EXPECT_TRUE(key.set(shot, old));
        EXPECT_EQ(key.get(shot).value(), name);
    }
    Shot shot;
    EXPECT_FALSE(key.set(shot, "paths"));
}

TEST(Choices, ByDefaultGoTogether) {
    EXPECT_EQ(why_not_together({}), "");
}

// Every product is either built or refused with a reason. Of gathered flux, patches go with all gatherers, spheres and
// points with all but the four that need rays; flux of deposits is for spheres and points, where photons place them in
// three ways.
TEST(Choices, AreAllBuiltOrRefused) {
    const Room room(coloured_room());
    int built = 0, refused = 0;
    for (const TechniqueChoice& placement : light_placements())
        for (const TechniqueChoice& flux : light_fluxes())
            for (const TechniqueChoice& kind : light_kinds())
                for (const TechniqueChoice& gatherer : light_gatherers()) {
                    VirtualLightSettings s;
                    s.count = 20;
                    s.photons = 1000;
                    s.path_extension = false;
                    s.placement = placement.name;
                    s.flux = flux.name;
                    s.kind = kind.name;
                    s.sampling = gatherer.name;
                    const std::string what = placement.name + " " + flux.name + " " + kind.name + " " + gatherer.name;
                    if (!why_not_together(s).empty()) {
                        EXPECT_FALSE(accepted(s)) << what;
                        ++refused;
                        continue;
                    }
                    const VirtualLights lights = room.lights(s);
                    EXPECT_FALSE(lights.lights().empty()) << what;
                    Rng rng(Stream::Path, 0);
                    EXPECT_TRUE(std::isfinite(room.by_lights(lights, 0.4, 0.6, rng).x)) << what;
                    ++built;
                }
    const auto gatherers = static_cast<int>(light_gatherers().size());
    EXPECT_EQ(built, 8 * (gatherers + 3 * (gatherers - 4)) + 3 * 3 * (gatherers - 4));
    EXPECT_EQ(built + refused, 8 * 2 * 4 * gatherers);
}

TEST(Presets, AreSettingsOfAShotThatGoTogether) {
    for (const TechniquePreset& preset : light_presets()) {
        Shot shot;
        for (const auto& [name, value] : preset.settings) {
            const Json parsed = Json::parse(value, nullptr, false), json = parsed.is_discarded() ? Json(value) : parsed;
            EXPECT_TRUE(key_of(name).set(shot, json)) << preset.name << ": " << name << "=" << value;
        }
        EXPECT_EQ(why_not_together(shot.virtual_lights), "") << preset.name;
    }
}

// Ranges that the schema states, against the renderer's own check.
class Ranges : public ::testing::TestWithParam<const char*> {};

// With other settings as they must be for this one to have any value.
VirtualLightSettings with(const std::string& name, const Json& value) {
    Shot shot;
    shot.virtual_lights.n_min = 0.0;
    shot.virtual_lights.n_max = name == "n_min" ? std::numeric_limits<double>::max() : 80.0;
    if (name == "resampling_neighbours")
        shot.virtual_lights.sampling = "resampled";
    EXPECT_TRUE(key_of(name).set(shot, value)) << name << "=" << value;
    return shot.virtual_lights;
}

TEST_P(Ranges, OfTheSchemaAreTheRenderers) {
    const std::string name = GetParam();
    const Json& schema = key_of(name).schema;
    const bool whole = schema.at("type") == "integer";
    Shot unused;
    if (schema.contains("exclusiveMinimum")) {
        const double low = schema["exclusiveMinimum"];
        EXPECT_TRUE(accepted(with(name, low + 1e-9))) << name;
        EXPECT_FALSE(key_of(name).set(unused, low)) << name;
    } else {
        EXPECT_TRUE(accepted(with(name, schema.at("minimum")))) << name;
        EXPECT_FALSE(key_of(name).set(unused, schema["minimum"].get<double>() - 1.0)) << name;
    }
    if (schema.contains("maximum")) {
        EXPECT_TRUE(accepted(with(name, schema["maximum"]))) << name;
        EXPECT_FALSE(key_of(name).set(unused, schema["maximum"].get<double>() + 1.0)) << name;
    } else {
        EXPECT_FALSE(whole) << name;
        EXPECT_TRUE(accepted(with(name, 1e300))) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(OfVirtualLights, Ranges,
                         ::testing::Values("count", "passes", "window", "sphere_shrinking", "point_bound",
                                           "sphere_neighbours", "sphere_samples", "candidates_per_pixel", "neighbours",
                                           "radius_factor", "profile_resolution", "resampling_candidates", "n_min",
                                           "n_max", "importance_floor", "light_samples", "resampling_rays",
                                           "lightcuts_error", "lightcuts_most", "stochastic_cut_size", "sharing_radius",
                                           "resampling_neighbours", "resampling_radius", "resampling_rounds"));

// Every key with numbers is in the list above, but for the seed, of which the renderer takes any, and for
// photons and contribution_bound, which may be words.
TEST(AllRanges, AreTested) {
    int numbers = 0;
    for (const Key& key : shot_keys())
        if (key.path.starts_with("virtual_lights.") && key.path != "virtual_lights.seed" &&
            (key.schema.value("type", "") == "integer" || key.schema.value("type", "") == "number"))
            ++numbers;
    EXPECT_EQ(numbers, 24);
}

// What the check takes the renderer can build, where it does not take long.
TEST(Settings, AtTheEndsOfTheirRangesAreBuilt) {
    SceneSettings scene = coloured_room();
    scene.quads[2].material = rough_metal(Rgb(0.9f, 0.7f, 0.4f), 0.4f);
    const Room room(scene);
    const auto finite = [&](const std::function<void(VirtualLightSettings&)>& change) {
        VirtualLightSettings s;
        s.count = 40;
        s.photons = 2000;
        change(s);
        const VirtualLights lights(room.direct, {4, 4, room.camera().ray}, s);
        Rng rng(Stream::Path, 0);
        return std::isfinite(room.by_lights(lights, 0.4, 0.9, rng).x);
    };
    using S = VirtualLightSettings;
    using R = VirtualLightRanges;
    EXPECT_TRUE(finite([](S& s) { s.profile_resolution = R::profile_resolution.low; }));
    EXPECT_TRUE(finite([](S& s) { s.count = 4, s.profile_resolution = R::profile_resolution.high; }));
    EXPECT_TRUE(finite([](S& s) { s.radius_factor = R::radius_factor.high; }));
    EXPECT_TRUE(finite([](S& s) { s.radius_factor = 1e-9; }));
    EXPECT_TRUE(finite([](S& s) { s.candidates_per_pixel = R::candidates_per_pixel.low; }));
    EXPECT_TRUE(finite([](S& s) { s.candidates_per_pixel = R::candidates_per_pixel.high; }));
    EXPECT_TRUE(finite([](S& s) { s.neighbours = R::neighbours.low; }));
    EXPECT_TRUE(finite([](S& s) { s.neighbours = R::neighbours.high; }));
    EXPECT_TRUE(finite([](S& s) { s.n_min = s.n_max = 0.0; }));
}

TEST(Techniques, SayWhatDoesNotGoTogether) {
    const Room room(coloured_room());
    const auto refused = [&](VirtualLightSettings settings, auto change, const std::string& word) {
        change(settings);
        try {
            room.lights(settings);
            ADD_FAILURE() << word;
        } catch (const Error& error) {
            const std::string line = error.what();
            EXPECT_EQ(error.code(), ExitCode::Usage) << line;
            EXPECT_NE(line.find(word), std::string::npos) << line;
            EXPECT_EQ(line.find('\n'), std::string::npos) << line;
        }
    };
    using S = VirtualLightSettings;
    const S plain = of_photons("point"), rich = sampled_by("power", "sphere");
    refused(
        plain, [](S& s) { s.placement = "blue_noise"; },
        "placement light_paths, rejection, metropolis, not blue_noise");
    refused(
        plain, [](S& s) { s.kind = "patch"; }, "flux own goes with kind sphere, point, diffuse_point");
    refused(
        plain, [](S& s) { s.kind = "patch"; }, "kind patch needs flux that covers surface: flux gathered");
    refused(
        plain, [](S& s) { s.sampling = "combined"; },
        "sampling combined needs a kind of light that rays can hit: kind patch; kind point goes with sampling power, "
        "light_tree, plain_power, uniform, resampled, lightcuts, stochastic_lightcuts, all");
    refused(
        rich, [](S& s) { s.compensation = BoundCompensation::Exact; },
        "compensation exact needs a kind of light with a bound: kind point, diffuse_point; kind sphere goes with "
        "compensation none");
    refused(
        rich, [](S& s) { s.contribution_bound = 2.0; },
        "contribution_bound needs a kind of light with a bound: kind point, diffuse_point; kind sphere goes with "
        "contribution_bound=none");
    refused(
        rich,
        [](S& s) {
            s.kind = "point";
            s.contribution_bound = 2.0;
            s.compensation = BoundCompensation::Exact;
        },
        "compensation exact needs contribution_bound=none: it knows what the bound on geometry takes; "
        "contribution_bound goes with compensation none");
    refused(
        rich, [](S& s) { s.compensation = BoundCompensation::ScreenSpace; },
        "compensation screen_space needs a kind of light with a bound: kind point, diffuse_point; kind sphere goes "
        "with compensation none");
    refused(
        plain,
        [](S& s) {
            s.compensation = BoundCompensation::ScreenSpace;
            s.sampling = "resampled";
            s.resampling_neighbours = 2;
        },
        "compensation screen_space needs resampling_neighbours=0; resampling_neighbours above 0 goes with "
        "compensation none, exact");
    refused(
        plain, [](S& s) { s.placement = "bidirectional"; },
        "flux own needs deposits that carry flux: placement light_paths, rejection, metropolis, not bidirectional");
    refused(
        plain, [](S& s) { s.sampling = "resampled_combined"; }, "sampling resampled_combined needs");
    refused(
        rich, [](S& s) { s.path_extension = true; }, "kind sphere goes with path_extension=false");
    refused(
        rich, [](S& s) { s.kind = "ball"; }, "\"ball\" is not known; there are patch, sphere, point, diffuse_point");
    refused(
        rich, [](S& s) { s.sphere_neighbours = 0; }, "sphere_neighbours");
    refused(
        rich, [](S& s) { s.sphere_samples = 0; }, "sphere_samples");
    refused(
        rich, [](S& s) { s.resampling_candidates = 0; }, "resampling_candidates");
}

}  // namespace
}  // namespace brisance
