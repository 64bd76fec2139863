// The layers of output.layers.bound: SS in two parts, where the bound acts, and what both cost.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "core/parallel.h"
#include "film/write_image.h"
#include "fixtures/luminances.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"

namespace brisance {
namespace {

using namespace testing;

using Pixels = std::vector<double>;  // luminance

constexpr int kWidth = 32, kHeight = 24;

// A room of 2 x 2 x 2 m without the wall on the camera's side, and a lamp under its ceiling.
Scene room() {
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, lambert(0.7f));
    add_quad(scene, {-1, -1, 2}, {0, 2, 0}, {2, 0, 0}, lambert(0.7f));
    add_quad(scene, {-1, -1, 0}, {0, 2, 0}, {0, 0, 2}, lambert(0.6f));
    add_quad(scene, {1, -1, 0}, {0, 0, 2}, {0, 2, 0}, lambert(0.5f));
    add_quad(scene, {-1, 1, 0}, {2, 0, 0}, {0, 0, 2}, lambert(0.8f));
    add_quad(scene, {-0.3f, -0.3f, 1.9f}, {0, 0.6f, 0}, {0.6f, 0, 0}, emitting(Rgb(20.0f)));
    return scene;
}

VirtualLightSettings bounded(double bound, BoundCompensation compensation, const std::string& sampling = "power") {
    VirtualLightSettings s;
    s.placement = "light_paths";
    s.flux = "own";
    s.kind = "point";
    s.sampling = sampling;
    s.light_samples = 8;
    s.path_extension = false;
    s.sharing_radius = 0.0;
    s.count = 400;
    s.photons = 100000;
    s.point_bound = bound;
    s.point_bound_of = BoundedTerm::BothCosines;
    s.compensation = compensation;
    return s;
}

Shot shot_of(const VirtualLightSettings& settings) {
    Shot shot;
    shot.camera_given = true;
    shot.camera.eye = {0.0, -4.2, 1.0};
    shot.camera.target = {0.0, 0.0, 1.0};
    shot.camera.vertical_fov_degrees = 32.0;
    shot.camera.width = kWidth;
    shot.camera.height = kHeight;
    shot.camera.samples_per_axis = 2;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    shot.virtual_lights = settings;
    shot.output.bound_layers = true;
    return shot;
}

RenderedFrame rendered(const Shot& shot) {
    static const Surroundings surroundings(room(), {});
    Progress silent;
    const Medium nothing;
    return render_medium(shot, nothing, silent, &surroundings);
}

double mean(const Pixels& pixels) {
    return std::accumulate(pixels.begin(), pixels.end(), 0.0) / double(pixels.size());
}

bool has(const Image& image, const std::string& name) {
    return std::any_of(image.layers.begin(), image.layers.end(), [&](const Layer& l) { return l.name == name; });
}

std::vector<Shot> all_ways() {
    std::vector<Shot> shots;
    for (const BoundCompensation way : {BoundCompensation::Exact, BoundCompensation::ScreenSpace})
        for (const double sharing : {0.0, 0.2}) {
            shots.push_back(shot_of(bounded(1.0, way)));
            shots.back().virtual_lights.sharing_radius = sharing;
        }
    shots.push_back(shot_of(bounded(1.0, BoundCompensation::Exact, "resampled")));
    shots.back().virtual_lights.resampling_neighbours = 2;
    shots.push_back(shots.back());
    shots.back().virtual_lights.sharing_radius = 0.2;
    return shots;
}

TEST(BoundLayers, AddUpToSS) {
    for (const Shot& shot : all_ways()) {
        const Image image = rendered(shot).image;
        const std::vector<float>&all = image.layer("SS").pixels, &kept = image.layer("SS_bounded").pixels,
              &rest = image.layer("SS_residual").pixels;
        ASSERT_EQ(kept.size(), all.size());
        ASSERT_EQ(rest.size(), all.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            ASSERT_NEAR(kept[i] + rest[i], all[i], 1e-6f * all[i]);
            ASSERT_GE(kept[i], 0.0f);
            ASSERT_GE(rest[i], 0.0f);
        }
        EXPECT_GT(mean(luminances(image.layer("SS_residual"))), 0.02 * mean(luminances(image.layer("SS"))));
    }
}

// As far as halves go: each of the three is rounded by a part of 2^-11.
TEST(BoundLayers, AddUpInTheFile) {
    const auto file = std::filesystem::path(::testing::TempDir()) / "bound_layers.exr";
    write_exr(file, rendered(all_ways().front()).image, {});
    const Image read = read_exr(file);
    const std::vector<float>&all = read.layer("SS").pixels, &kept = read.layer("SS_bounded").pixels,
          &rest = read.layer("SS_residual").pixels;
    for (std::size_t i = 0; i < all.size(); ++i)
        ASSERT_NEAR(kept[i] + rest[i], all[i], std::ldexp(2.0f * all[i] + 1e-4f, -11));
    EXPECT_EQ(read.layer("bound").pixels.size(), std::size_t(kWidth) * kHeight);
    std::filesystem::remove(file);
}

// Both are other random numbers' business: what is bounded does not know of what compensates.
TEST(BoundLayers, OfBoundedLightAreThePictureWithoutCompensation) {
    for (Shot shot : all_ways()) {
        const std::vector<float> kept = rendered(shot).image.layer("SS_bounded").pixels;
        shot.virtual_lights.compensation = BoundCompensation::None;
        const std::vector<float> none = rendered(shot).image.layer("SS").pixels;
        for (std::size_t i = 0; i < none.size(); ++i)
            ASSERT_NEAR(kept[i], none[i], 1e-4f * none[i]);
    }
}

TEST(BoundLayers, OfNoBoundAreBlack) {
    for (const BoundCompensation way : {BoundCompensation::Exact, BoundCompensation::ScreenSpace}) {
        const Image image = rendered(shot_of(bounded(std::numeric_limits<double>::infinity(), way))).image;
        EXPECT_EQ(image.layer("SS_bounded").pixels, image.layer("SS").pixels);
        for (const char* name : {"SS_residual", "bound"})
            for (const float pixel : image.layer(name).pixels)
                ASSERT_EQ(pixel, 0.0f) << name;
    }
}

// Over 24 sets of lights, within four standard errors (one in 15,000 by chance), which are a part of the residual.
TEST(BoundLayers, OfTheResidualAreWhatPathsFindBeyondTheBound) {
    constexpr int kSets = 24;
    Shot traced = shot_of({});
    traced.output.bound_layers = false;
    traced.method = RenderMethod::Path;
    traced.tracing.samples = 512;
    const double paths = mean(luminances(rendered(traced).image.layer("SS")));
    double sum = 0.0, squares = 0.0, residual = 0.0;
    for (int seed = 0; seed < kSets; ++seed) {
        Shot shot = shot_of(bounded(1.0, BoundCompensation::Exact));
        shot.virtual_lights.seed = std::uint32_t(seed);
        shot.virtual_lights.count = 2000;
        const Image image = rendered(shot).image;
        const double found = mean(luminances(image.layer("SS_residual"))),
                     wanted = paths - mean(luminances(image.layer("SS_bounded")));
        residual += found / kSets;
        sum += (found - wanted) / kSets;
        squares += (found - wanted) * (found - wanted) / kSets;
    }
    const double standard_error = std::sqrt((squares - sum * sum) / (kSets - 1));
    std::printf("residual %.5f of SS %.5f, beyond paths %.5f +- %.5f\n", residual, paths, sum, standard_error);
    EXPECT_LT(std::abs(sum), 4.0 * standard_error);
    EXPECT_LT(4.0 * standard_error, 0.5 * residual) << "says nothing";
}

TEST(BoundLayers, ShowWhereTheBoundActs) {
    const Image image = rendered(shot_of(bounded(1.0, BoundCompensation::None, "all"))).image;
    const std::vector<float>& map = image.layer("bound").pixels;
    for (const float pixel : map) {
        ASSERT_GE(pixel, 0.0f);
        ASSERT_LE(pixel, 1.0f);
    }
    // The back wall covers the middle 17 x 17 pixels or so.
    const auto part = [&](int from_x, int from_y) {
        double sum = 0.0;
        for (int y = from_y; y < from_y + 3; ++y)
            for (int x = from_x; x < from_x + 3; ++x)
                sum += map[std::size_t(y * kWidth + x)] / 9.0;
        return sum;
    };
    const double middle = part(15, 10);
    const double half = 0.5 * kHeight * (1.0 / 5.2) / std::tan(glm::radians(16.0));  // of the back wall [pixels]
    const int low = int(kHeight / 2 - half), left = int(kWidth / 2 - half);
    for (const auto& [x, y] : {std::pair(left, low), std::pair(kWidth - left - 3, low),
                               std::pair(left, kHeight - low - 3), std::pair(kWidth - left - 3, kHeight - low - 3)})
        EXPECT_GT(part(x, y), 2.0 * middle) << x << " " << y;
}

// Samplings have weights of their own, and find the same share. Lights are few and samples many: a light near by that
// no sample has met takes nothing away.
TEST(BoundLayers, ShowTheSameByAllSamplings) {
    const auto share = [](const std::string& sampling) {
        Shot shot = shot_of(bounded(1.0, BoundCompensation::None, sampling));
        shot.virtual_lights.count = 12;
        shot.virtual_lights.light_samples = 32;
        shot.virtual_lights.stochastic_cut_size = 8;
        shot.camera.samples_per_axis = 6;
        const Image image = rendered(shot).image;
        return mean({image.layer("bound").pixels.begin(), image.layer("bound").pixels.end()});
    };
    const double all = share("all");
    for (const char* sampling : {"power", "uniform", "light_tree", "lightcuts", "stochastic_lightcuts", "resampled"}) {
        const double found = share(sampling);
        std::printf("%s: %.4f, all %.4f\n", sampling, found, all);
        EXPECT_NEAR(found, all, 0.1 * all) << sampling;
    }
}

TEST(BoundLayers, ChangeNoOtherBitOnAnyThreads) {
    for (Shot shot : all_ways()) {
        const auto image = [&](int threads, bool asked) {
            const ThreadLimit limit(threads);
            shot.output.bound_layers = asked;
            return rendered(shot).image;
        };
        const Image one = image(1, true), two = image(2, true), off = image(2, false);
        ASSERT_EQ(one.layers.size(), two.layers.size());
        EXPECT_EQ(off.layers.size() + 3, one.layers.size());
        for (const Layer& layer : one.layers)
            EXPECT_EQ(layer.pixels, two.layer(layer.name).pixels) << layer.name;
        for (const Layer& layer : off.layers)
            EXPECT_EQ(layer.pixels, one.layer(layer.name).pixels) << layer.name;
    }
}

TEST(BoundLayers, AreCounted) {
    for (const Shot& shot : all_ways()) {
        const RenderedFrame frame = rendered(shot);
        const auto stage = std::find_if(frame.statistics.stages.begin(), frame.statistics.stages.end(),
                                        [](const StageCost& s) { return s.detail.contains("residual_share_of_SS"); });
        ASSERT_NE(stage, frame.statistics.stages.end());
        EXPECT_NEAR(stage->detail["residual_share_of_SS"].get<double>(),
                    mean(luminances(frame.image.layer("SS_residual"))) / mean(luminances(frame.image.layer("SS"))),
                    1e-5);
        const auto lights = stage->detail["bounded_lights_cpu_seconds"].get<double>(),
                   rest = stage->detail["compensation_cpu_seconds"].get<double>();
        EXPECT_GT(lights, 0.0);
        EXPECT_GT(rest, 0.0);
        EXPECT_NEAR(stage->detail["compensation_share_of_time"].get<double>(), rest / (lights + rest), 1e-9);
    }
}

TEST(BoundLayers, WithoutCompensationAreTheMapAlone) {
    const Image image = rendered(shot_of(bounded(1.0, BoundCompensation::None))).image;
    EXPECT_TRUE(has(image, "bound"));
    EXPECT_FALSE(has(image, "SS_bounded"));
    EXPECT_FALSE(has(image, "SS_residual"));
}

std::string refusal(const Shot& shot) {
    try {
        rendered(shot);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Usage);
        return error.what();
    }
    return "";
}

TEST(BoundLayers, AreRefusedWithWhatWouldDo) {
    for (const char* kind : {"patch", "sphere"}) {
        Shot shot = shot_of(bounded(1.0, BoundCompensation::None));
        shot.virtual_lights.flux = "gathered";
        shot.virtual_lights.kind = kind;
        EXPECT_EQ(
            refusal(shot),
            std::string("output.layers.bound needs a kind of light with a bound: kind point, diffuse_point; kind ") +
                kind + " goes with output.layers.bound=false");
    }
    Shot shot = shot_of(bounded(1.0, BoundCompensation::Exact));
    shot.output.cell_layers = false;
    EXPECT_EQ(refusal(shot), "output.layers.bound needs output.layers.cells=true: it divides the layer SS");
}

}  // namespace
}  // namespace brisance
