// Samples of the camera that reuse the lights chosen around them: the mean stays, noise falls, nothing else changes.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "fixtures/estimate.h"
#include "fixtures/luminances.h"
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

struct Picture {
    int width = 96, height = 64, samples = 2;  // along a pixel's side
};

Shot shot_of(const VirtualLightSettings& settings, const Picture& picture) {
    Shot shot;
    shot.camera_given = true;
    shot.camera.eye = {0.1, -0.95, 0.0};
    shot.camera.target = {0.0, 1.0, -0.2};
    shot.camera.vertical_fov_degrees = 60.0;
    shot.camera.width = picture.width;
    shot.camera.height = picture.height;
    shot.camera.samples_per_axis = picture.samples;
    shot.certify.belief = 0.0;  // nobody looks at it
    shot.virtual_lights = settings;
    return shot;
}

using Pixels = std::vector<double>;  // luminance

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

struct Difference {
    double truth = 0.0, mean = 0.0, error = 0.0, variance = 0.0;  // of single pixels
};

// Of pictures of the same lights. Neighbours have errors in common: the standard error is that of means over blocks,
// which are larger than the radius of reuse.
Difference difference(const Pixels& ours, const Pixels& truth, const Picture& picture) {
    constexpr int kBlock = 16;
    const int across = picture.width / kBlock, blocks = across * (picture.height / kBlock);
    std::vector<double> mean(std::size_t(blocks), 0.0);
    Difference d;
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const std::size_t p = std::size_t(y) * picture.width + x;
            const double apart = ours[p] - truth[p];
            mean[(y / kBlock) * across + x / kBlock] += apart / (kBlock * kBlock);
            d.truth += truth[p] / double(truth.size());
            d.variance += apart * apart / double(truth.size());
        }
    double squares = 0.0;
    for (const double m : mean) {
        d.mean += m / blocks;
        squares += m * m / blocks;
    }
    d.error = std::sqrt((squares - d.mean * d.mean) / (blocks - 1));
    return d;
}

void expect_no_bias(const Difference& d, const std::string& what) {
    EXPECT_LT(std::abs(d.mean), kSigmas * d.error) << what;
    EXPECT_LT(d.error, 0.03 * d.truth) << what << ": not sampled enough";
    std::printf("%s: %+.2f %% +- %.2f %%\n", what.c_str(), 100.0 * d.mean / d.truth, 100.0 * d.error / d.truth);
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

// Lights with numbers for brightness: what a vertex sees of a light depends on where it stands, and some see nothing of
// some lights. The target is not the light itself, as where something is hidden.
class Numbers : public ReservoirLights {
public:
    bool visibility = false;

    static constexpr int kLights = 5, kCandidates = 2;

    double bright(std::size_t light, const glm::dvec2& u, double x) const {
        const double shift = x - double(light);
        return std::abs(shift) > 2.5 ? 0.0 : (1.0 + double(light)) * (0.2 + u.x) / (0.3 + shift * shift);
    }
    double target(const LightReservoir& y, const PathVertex& vertex) const override {
        return bright(y.light, y.numbers, vertex.position().x);
    }
    // Some of it is hidden, elsewhere in every column.
    static double hidden(double x) { return 0.5 + 0.4 * std::sin(5.0 * x); }
    double shown(const LightReservoir& y, double x) const {
        return y.numbers.y < hidden(x) ? 0.0 : bright(y.light, y.numbers, x) * (0.5 + y.numbers.y);
    }
    // Over both numbers: the means of 0.2 + u, and of 0.5 + v where that is not hidden.
    double truth(double x) const {
        double sum = 0.0;
        for (std::size_t light = 0; light < kLights; ++light)
            sum += bright(light, {0.5, 0.0}, x) * (0.5 * (1.0 - hidden(x)) + 0.5 * (1.0 - hidden(x) * hidden(x)));
        return sum;
    }
    Rgb fill(const PathVertex& vertex, LightReservoir& out, Rng& rng) const override {
        double sum = 0.0;
        LightReservoir kept;
        for (int i = 0; i < kCandidates; ++i) {
            LightReservoir y;
            y.light = std::size_t(rng.next_double() * kLights);
            y.numbers.x = rng.next_double();
            y.numbers.y = rng.next_double();
            y.target = target(y, vertex);
            sum += y.target * kLights / kCandidates;
            if (rng.next_double() * sum < y.target * kLights / kCandidates)
                kept = y;
        }
        out = kept;
        out.weight = sum > 0.0 && (!visibility || reaches(kept, vertex)) ? sum / kept.target : 0.0;
        return Rgb(0.0f);
    }
    bool reaches(const LightReservoir& y, const PathVertex& vertex) const override {
        return shown(y, vertex.position().x) > 0.0;
    }
    BoundedLight from_reservoir(const LightReservoir& y, const PathVertex& vertex, Rng&) const override {
        return Rgb(float(y.weight * shown(y, vertex.position().x)));
    }
};

struct ByNumbers {
    int width = 384, height = 384;
    std::uint64_t seed = 0;  // of what samples choose
    Numbers lights{};

    // Positions vary along a row. `rows_at_once`: samples are added so.
    std::vector<Rgb> pixels(const LightReuse::Settings& settings, int rows_at_once) const {
        LightReuse reuse(lights, width, height, settings, nullptr);
        std::vector<LightReuse::Sample> samples;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x)
                samples.push_back(sample(std::uint32_t(y * width + x)));
            if ((y + 1) % rows_at_once == 0 || y + 1 == height) {
                reuse.add(std::move(samples));
                samples.clear();
            }
        }
        return reuse.take_pixels();
    }

    LightReuse::Sample sample(std::uint32_t pixel) const {
        SurfacePoint point;
        point.position = {place(int(pixel % std::uint32_t(width))), 0.0, 0.0};
        point.geometric_normal = {0.0, 0.0, 1.0};
        point.frame = frame_around(point.geometric_normal);
        LightReuse::Sample s{.pixel = pixel, .vertex = PathVertex(point, dvec3(0.0, 0.0, -1.0)), .reservoir = {}};
        s.from_eye = 1.0;
        Rng rng(Stream::Points, pixel, seed);
        lights.fill(s.vertex, s.reservoir, rng);
        return s;
    }
    double place(int x) const { return 5.0 * (x + 0.5) / width - 0.5; }
};

// Each column of pixels has a closed form.
TEST(LightReuse, HasTheMeanThatIsKnown) {
    const Picture picture{ByNumbers().width, ByNumbers().height};
    for (const bool visibility : {false, true})
        for (const auto& [neighbours, radius] : {std::pair(0, 0.0), std::pair(6, 5.0), std::pair(6, 30.0)}) {
            ByNumbers scene;
            scene.lights.visibility = visibility;
            const std::vector<Rgb> pixels = scene.pixels({neighbours, radius, visibility}, 1);
            Pixels relative, one(pixels.size(), 1.0);
            for (std::size_t p = 0; p < pixels.size(); ++p)
                relative.push_back(pixels[p].x / scene.lights.truth(scene.place(int(p % std::size_t(scene.width)))));
            expect_no_bias(difference(relative, one, picture), visibility ? "visible numbers" : "numbers");
        }
}

struct Mean {
    double mean = 0.0, error = 0.0;
};

// Rounds spread errors far: pictures of different seeds tell the standard error, whatever pixels have in common.
Mean mean_over_truth(int rounds, int neighbours, double radius, bool visibility) {
    constexpr int kPictures = 24;
    double sum = 0.0, squares = 0.0;
    for (int seed = 0; seed < kPictures; ++seed) {
        ByNumbers scene{.width = 64, .height = 64, .seed = std::uint64_t(seed), .lights = {}};
        scene.lights.visibility = visibility;
        double mean = 0.0, truth = 0.0;
        std::size_t p = 0;
        for (const Rgb& pixel : scene.pixels({neighbours, radius, visibility, rounds, std::uint32_t(seed)}, 1)) {
            mean += pixel.x;
            truth += scene.lights.truth(scene.place(int(p++ % std::size_t(scene.width))));
        }
        sum += mean / truth / kPictures;
        squares += mean / truth * mean / truth / kPictures;
    }
    return {sum, std::sqrt((squares - sum * sum) / (kPictures - 1))};
}

// Whatever the round, and however much those before had in common.
TEST(LightReuse, HasTheMeanThatIsKnownInEveryRound) {
    for (const bool visibility : {false, true})
        for (const int rounds : {1, 2, 3})
            for (const auto& [neighbours, radius] : {std::pair(1, 3.0), std::pair(3, 3.0), std::pair(3, 12.0)}) {
                const Mean e = mean_over_truth(rounds, neighbours, radius, visibility);
                const std::string what = std::to_string(rounds) + " rounds, " + std::to_string(neighbours) + " in " +
                                         std::to_string(int(radius)) + (visibility ? ", visible" : "");
                EXPECT_LT(std::abs(e.mean - 1.0), kSigmas * e.error) << what;
                EXPECT_LT(e.error, 0.01) << what << ": not sampled enough";
                std::printf("%s: %+.2f %% +- %.2f %%\n", what.c_str(), 100.0 * (e.mean - 1.0), 100.0 * e.error);
            }
}

TEST(LightReuse, DoesNotKnowHowManyRowsCameTogether) {
    const ByNumbers scene;
    for (const int rounds : {1, 3}) {
        const std::vector<Rgb> one = scene.pixels({2, 7.5, true, rounds}, 1);
        for (const int rows : {7, 64, 384})
            EXPECT_EQ(one, scene.pixels({2, 7.5, true, rounds}, rows)) << rounds << " rounds, rows " << rows;
    }
}

}  // namespace
}  // namespace brisance
