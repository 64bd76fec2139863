// Samples of the camera that reuse the lights chosen around them: the mean stays, noise falls, nothing else changes.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "fixtures/luminances.h"
#include "fixtures/reuse_pictures.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"
#include "surface_lighting/light_reuse.h"
#include "virtual_lights/choices.h"

namespace brisance {
namespace {

using namespace testing;

// A cube of 2 m with a lamp under its ceiling and a block on its floor, which is of rough metal if `glossy`.
Scene room(bool glossy) {
    Scene scene;
    add_box(scene, vec3(-1.0f), vec3(1.0f), lambert(0.6f), true);
    add_box(scene, {-0.6f, -0.2f, -0.99f}, {0.0f, 0.4f, -0.3f}, lambert(0.5f));
    SceneMaterial floor = lambert(0.7f);
    if (glossy) {
        floor.surface.metallic = 1.0f;
        floor.surface.roughness = 0.35f;
        floor.surface.base_colour = Rgb(0.9f, 0.7f, 0.4f);
    }
    add_quad(scene, {-1, -1, -0.99f}, {2, 0, 0}, {0, 2, 0}, floor);
    add_quad(scene, {-0.3f, -0.3f, 0.95f}, {0, 0.6f, 0}, {0.6f, 0, 0}, emitting(Rgb(20.0f)));
    return scene;
}

Shot shot_of(const VirtualLightSettings& settings, const Picture& picture) {
    Shot shot;
    shot.camera_given = true;
    shot.camera.eye = {0.1, -0.95, 0.0};
    shot.camera.target = {0.0, 1.0, -0.2};
    shot.camera.vertical_fov_degrees = 60.0;
    shot.camera.width = picture.width;
    shot.camera.height = picture.height;
    shot.camera.samples_per_axis = picture.samples;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    shot.virtual_lights = settings;
    return shot;
}

Pixels pixels_of(const Shot& shot, const Surroundings& surroundings) {
    Progress silent;
    const Medium nothing;
    return luminances(render_medium(shot, nothing, silent, &surroundings).image.layer("SS"));
}

// Paths end at once, so that all that is compared is how lights are sampled.
VirtualLightSettings sampled_by(const std::string& sampling, int neighbours = 0) {
    VirtualLightSettings s;
    s.count = 60;
    s.photons = 50000;
    s.path_extension = false;
    s.sharing_radius = 0.0;
    s.sampling = sampling;
    s.resampling_candidates = 4;
    s.resampling_neighbours = neighbours;
    s.resampling_radius = 3.0;
    return s;
}

// By every light, without reuse and with it; neighbours near, and so far that they see other lights.
TEST(LightReuse, HasTheMeanOfAllLights) {
    const Picture picture;
    for (const bool glossy : {false, true}) {
        const Surroundings surroundings(room(glossy), {});
        const Pixels truth = pixels_of(shot_of(sampled_by("all"), picture), surroundings);
        for (const std::string sampling : {"resampled", "resampled_combined"})
            for (const int neighbours : {0, 5})
                for (const double radius : {3.0, 40.0})
                    for (const bool visibility : {false, true}) {
                        if (neighbours == 0 && (radius > 3.0 || visibility))
                            continue;
                        VirtualLightSettings s = sampled_by(sampling, neighbours);
                        s.resampling_candidates = 16;
                        s.resampling_radius = radius;
                        s.resampling_visibility = visibility;
                        expect_no_bias(difference(pixels_of(shot_of(s, picture), surroundings), truth, picture),
                                       (glossy ? "glossy, " : "diffuse, ") + sampling + ", " +
                                           std::to_string(neighbours) + " in " + std::to_string(int(radius)) +
                                           (visibility ? ", visible" : ""));
                    }
    }
}

TEST(LightReuse, HasTheMeanOfAllLightsOfEveryKind) {
    const Picture picture;
    const Surroundings surroundings(room(true), {});
    for (const std::string kind : {"sphere", "point"}) {
        VirtualLightSettings s = sampled_by("all");
        s.kind = kind;
        s.point_bound = 3.0;
        const Pixels truth = pixels_of(shot_of(s, picture), surroundings);
        s.sampling = "resampled";
        s.resampling_neighbours = 4;
        for (const bool visibility : {false, true}) {
            s.resampling_visibility = visibility;
            expect_no_bias(difference(pixels_of(shot_of(s, picture), surroundings), truth, picture), kind);
        }
    }
}

// Behind the block and beside the light's patches much of what is chosen is hidden: more so if that is given away.
TEST(LightReuse, LowersTheNoise) {
    const Picture picture;
    const Surroundings surroundings(room(false), {});
    const Pixels truth = pixels_of(shot_of(sampled_by("all"), picture), surroundings);
    for (const bool visibility : {false, true}) {
        const auto variance = [&](int neighbours) {
            VirtualLightSettings s = sampled_by("resampled", neighbours);
            s.resampling_visibility = visibility;
            return difference(pixels_of(shot_of(s, picture), surroundings), truth, picture).variance;
        };
        const double none = variance(0), two = variance(2), six = variance(6);
        std::printf("variance of 0, 2, 6 neighbours: 1, %.3f, %.3f\n", two / none, six / none);
        EXPECT_LT(two, (visibility ? 0.6 : 0.95) * none);
        EXPECT_LT(six, (visibility ? 0.8 : 1.0) * two);
    }
}

// What is shared among pixels is shared after it was reused. Their means blur alike: 1 % for what borders see of it.
TEST(LightReuse, GoesWithSharingAmongPixels) {
    const Picture picture;
    for (const bool glossy : {false, true}) {
        const Surroundings surroundings(room(glossy), {});
        const auto pixels = [&](int neighbours) {
            VirtualLightSettings s = sampled_by("resampled", neighbours);
            s.sharing_radius = 0.2;
            return pixels_of(shot_of(s, picture), surroundings);
        };
        const Difference d = difference(pixels(4), pixels(0), picture);
        EXPECT_LT(std::abs(d.mean), 0.01 * d.truth + kSigmas * d.error);
        EXPECT_LT(d.error, 0.02 * d.truth) << "not sampled enough";
    }
}

// A sample without neighbours draws the same numbers as without reuse.
TEST(LightReuse, OfALonePixelIsPlainResampling) {
    const Picture lone{1, 1, 1};
    const Surroundings surroundings(room(true), {});
    VirtualLightSettings alone = sampled_by("resampled", 4);
    alone.resampling_candidates = 64;
    const Pixels reused = pixels_of(shot_of(alone, lone), surroundings);
    alone.resampling_neighbours = 0;
    const Pixels plain = pixels_of(shot_of(alone, lone), surroundings);
    ASSERT_EQ(reused.size(), 1u);
    EXPECT_GT(plain[0], 0.0);
    EXPECT_NEAR(reused[0], plain[0], 1e-4 * plain[0]);
}

TEST(LightReuse, OfNoLightsChangesNoBit) {
    const Picture small{16, 12, 1};
    const Surroundings surroundings(room(true), {});
    const auto pixels = [&](int neighbours) {
        VirtualLightSettings s = sampled_by("resampled_combined", neighbours);
        s.count = 0;
        return pixels_of(shot_of(s, small), surroundings);
    };
    EXPECT_EQ(pixels(4), pixels(0));
}

TEST(LightReuse, OfOneLightHasItsMean) {
    const Picture picture;
    const Surroundings surroundings(room(false), {});
    VirtualLightSettings s = sampled_by("all");
    s.count = 1;
    const Pixels truth = pixels_of(shot_of(s, picture), surroundings);
    s.sampling = "resampled";
    s.resampling_neighbours = 4;
    const Pixels reused = pixels_of(shot_of(s, picture), surroundings);
    const Difference d = difference(reused, truth, picture);
    EXPECT_LE(std::abs(d.mean), kSigmas * d.error);
    for (const double p : reused)
        EXPECT_TRUE(std::isfinite(p));
}

TEST(LightReuse, OfACameraThatSeesNothingIsBlack) {
    const Surroundings surroundings(room(false), {});
    Shot shot = shot_of(sampled_by("resampled", 4), {8, 8, 1});
    shot.camera.eye = {0.0, -9.0, 0.0};
    shot.camera.target = {0.0, -20.0, 0.0};
    for (const double p : pixels_of(shot, surroundings))
        EXPECT_EQ(p, 0.0);
}

TEST(LightReuse, IsTheSameBitsOnAnyThreads) {
    const Picture small{40, 30, 2};
    const Surroundings surroundings(room(true), {});
    for (const double sharing : {0.0, 0.2}) {
        VirtualLightSettings s = sampled_by("resampled_combined", 4);
        s.sharing_radius = sharing;
        s.resampling_rounds = sharing > 0.0 ? 1 : 3;
        const auto pixels = [&](int threads) {
            const ThreadLimit limit(threads);
            return pixels_of(shot_of(s, small), surroundings);
        };
        const Pixels one = pixels(1);
        EXPECT_EQ(one, pixels(2));
        EXPECT_EQ(one, pixels(8));
    }
}

TEST(LightReuse, IsRefusedWhereNothingIsResampled) {
    for (const TechniqueChoice& gatherer : light_gatherers()) {
        const bool resamples = gatherer.name == "resampled" || gatherer.name == "resampled_combined";
        VirtualLightSettings s = sampled_by(gatherer.name, 4);
        EXPECT_EQ(why_not_together(s).empty(), resamples) << gatherer.name;
        s.resampling_neighbours = 0;
        EXPECT_EQ(why_not_together(s), "") << gatherer.name;
    }
    try {
        check(sampled_by("power", 4));
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Usage);
        EXPECT_NE(std::string(error.what())
                      .find("resampling_neighbours needs a sampling that resamples: resampled, "
                            "resampled_combined; sampling power goes with resampling_neighbours=0"),
                  std::string::npos)
            << error.what();
    }
}

}  // namespace
}  // namespace brisance
