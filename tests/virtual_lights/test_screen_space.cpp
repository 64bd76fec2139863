// Light that the bound of point lights takes away, found among what pixels show: the integral, and what it misses.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "fixtures/luminances.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"
#include "surface_lighting/screen_space_compensation.h"

namespace brisance {
namespace {

using namespace testing;

VirtualLightSettings bounded(double bound, BoundedTerm of) {
    VirtualLightSettings s;
    s.placement = "light_paths";
    s.flux = "own";
    s.kind = "point";
    s.sampling = "all";
    s.path_extension = false;
    s.sharing_radius = 0.0;
    s.count = 400;
    s.photons = 100000;
    s.point_bound = bound;
    s.point_bound_of = of;
    return s;
}

// A floor (z = 0) and a wall (x = 0) of 1 x 1 m that meet, each on one half of the picture. The floor is black to
// look at and receives; the wall shines.
constexpr int kSide = 100;
constexpr float kPixel = 1.0f / kSide;  // [m]

ScreenSpaceCompensation::Sample on_corner(int x, int y, Rng& rng) {
    const float u = (float(x % kSide) + rng.next()) * kPixel, v = (float(y) + rng.next()) * kPixel;
    const bool floor = x < kSide;
    ScreenSpaceCompensation::Sample s;
    s.pixel = std::uint32_t(y * 2 * kSide + x);
    s.position = floor ? vec3(u, v, 0.0f) : vec3(0.0f, v, u);
    s.normal = floor ? vec3(0.0f, 0.0f, 1.0f) : vec3(1.0f, 0.0f, 0.0f);
    s.area = kPixel * kPixel;
    s.light = Rgb(floor ? 0.0f : 1.0f);
    s.albedo = Rgb(floor ? 1.0f : 0.0f);
    return s;
}

// By a sum over points of the wall that are ten times as dense.
double integral(const vec3& at, double bound, BoundedTerm of) {
    constexpr int kDense = 10 * kSide;
    double sum = 0.0;
    for (int i = 0; i < kDense; ++i)
        for (int j = 0; j < kDense; ++j) {
            const dvec3 offset = dvec3(0.0, (i + 0.5) / kDense, (j + 0.5) / kDense) - dvec3(at);
            const double d2 = glm::dot(offset, offset), d = std::sqrt(d2);
            const double here = offset.z / d, there = -offset.x / d;
            const double term = of == BoundedTerm::BothCosines ? here * there / d2 : there / d2;
            sum += here * there / d2 * std::max(0.0, 1.0 - bound / term) / (kDense * kDense);
        }
    return sum * std::numbers::inv_pi;
}

// Pixels of 1 cm and four rays each: 5 % from five of them on. Without the compensation all of it would be missing.
TEST(ScreenSpace, IsTheIntegralOverWhatIsSeen) {
    for (const BoundedTerm of : {BoundedTerm::LightCosine, BoundedTerm::BothCosines})
        for (const double bound : {1.5, 6.0}) {
            ScreenSpaceCompensation found(2 * kSide, kSide, bounded(bound, of), 4);
            Rng rng(Stream::Surface, 7);
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < 2 * kSide; ++x)
                    for (int k = 0; k < 4; ++k) {
                        ScreenSpaceCompensation::Sample s = on_corner(x, y, rng);
                        s.share = 0.25f;
                        found.add(s);
                    }
            const std::vector<Rgb> pixels = found.take_pixels();
            for (const int from_wall : {5, 10, 15}) {
                const vec3 at((float(from_wall) + 0.5f) * kPixel, 0.505f, 0.0f);
                const double truth = integral(at, bound, of);
                EXPECT_NEAR(pixels[std::size_t(50 * 2 * kSide + from_wall)].y, truth, 0.05 * truth)
                    << from_wall << " " << bound;
                EXPECT_GT(truth, 0.0);
            }
            // No cosine is above 1: nothing is taken from beyond 1 / sqrt(bound).
            const int beyond = int(kSide / std::sqrt(bound)) + 2;
            EXPECT_EQ(pixels[std::size_t(50 * 2 * kSide + beyond)].y, 0.0f) << bound;
        }
}

TEST(ScreenSpace, OfNothingIsNothing) {
    ScreenSpaceCompensation empty(5, 3, bounded(1.0, BoundedTerm::BothCosines), 1);
    for (const Rgb& p : empty.take_pixels())
        EXPECT_EQ(p, Rgb(0.0f));
}

// Three walls of 1 x 1 m that meet at the origin, and a lamp that no camera here sees.
Scene corner() {
    Scene scene;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, lambert(0.7f));
    add_quad(scene, {0, 0, 0}, {0, 1, 0}, {0, 0, 1}, lambert(0.6f));
    add_quad(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, lambert(0.8f));
    add_quad(scene, {1.6f, 1.6f, 3.2f}, {0, 0.4f, 0}, {0.4f, 0, 0}, emitting(Rgb(40.0f)));
    return scene;
}

Shot shot_of(const VirtualLightSettings& settings, int width, int height, int samples) {
    Shot shot;
    shot.camera_given = true;
    shot.camera.eye = {3.0, 3.0, 3.0};
    shot.camera.target = {0.3, 0.3, 0.3};
    shot.camera.vertical_fov_degrees = 24.0;
    shot.camera.width = width;
    shot.camera.height = height;
    shot.camera.samples_per_axis = samples;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    shot.virtual_lights = settings;
    return shot;
}

using Pixels = std::vector<double>;  // luminance

Pixels pixels_of(Shot shot, BoundCompensation compensation) {
    static const Surroundings surroundings(corner(), {});
    shot.virtual_lights.compensation = compensation;
    Progress silent;
    const Medium nothing;
    return luminances(render_medium(shot, nothing, silent, &surroundings).image.layer("SS"));
}

double mean(const Pixels& pixels) {
    double sum = 0.0;
    for (const double p : pixels)
        sum += p / double(pixels.size());
    return sum;
}

// All of the corner is on screen: what is missing is what pixels are too coarse for. The noise of `exact` is below 1 %.
TEST(ScreenSpace, FindsMostOfWhatACornerLoses) {
    for (const BoundedTerm of : {BoundedTerm::LightCosine, BoundedTerm::BothCosines}) {
        const Shot shot = shot_of(bounded(1.0, of), 64, 48, 3);
        const double lost = mean(pixels_of(shot, BoundCompensation::None)),
                     exact = mean(pixels_of(shot, BoundCompensation::Exact)),
                     found = mean(pixels_of(shot, BoundCompensation::ScreenSpace));
        std::printf("bounded %.6f, screen space %.6f, exact %.6f\n", lost, found, exact);
        EXPECT_LT(lost, 0.85 * exact) << "nothing to find";
        EXPECT_GT(found, lost + 0.8 * (exact - lost));
        EXPECT_LT(found, 1.01 * exact);
        EXPECT_GT(found, 0.95 * exact);
    }
}

// The camera sees a part of the floor alone, which loses what the walls beside it send.
TEST(ScreenSpace, MissesWhatIsOffScreen) {
    Shot shot = shot_of(bounded(1.0, BoundedTerm::LightCosine), 24, 24, 2);
    shot.camera.eye = {0.3, 0.31, 0.8};
    shot.camera.target = {0.3, 0.3, 0.0};
    const Pixels lost = pixels_of(shot, BoundCompensation::None);
    EXPECT_EQ(pixels_of(shot, BoundCompensation::ScreenSpace), lost);
    EXPECT_GT(mean(pixels_of(shot, BoundCompensation::Exact)), 1.05 * mean(lost));
}

TEST(ScreenSpace, OfALonePixelIsFinite) {
    const Shot shot = shot_of(bounded(0.1, BoundedTerm::BothCosines), 1, 1, 4);
    const Pixels lost = pixels_of(shot, BoundCompensation::None),
                 found = pixels_of(shot, BoundCompensation::ScreenSpace);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(std::isfinite(found[0]));
    EXPECT_GT(found[0], lost[0]);
}

TEST(ScreenSpace, OfACameraThatSeesNothingIsBlack) {
    Shot shot = shot_of(bounded(1.0, BoundedTerm::BothCosines), 8, 8, 1);
    shot.camera.target = {9.0, 9.0, 9.0};
    for (const double p : pixels_of(shot, BoundCompensation::ScreenSpace))
        EXPECT_EQ(p, 0.0);
}

TEST(ScreenSpace, IsTheSameBitsOnAnyThreads) {
    for (const double sharing : {0.0, 0.2}) {
        Shot shot = shot_of(bounded(1.0, BoundedTerm::BothCosines), 40, 30, 2);
        shot.virtual_lights.sharing_radius = sharing;
        const auto pixels = [&](int threads) {
            const ThreadLimit limit(threads);
            return pixels_of(shot, BoundCompensation::ScreenSpace);
        };
        const Pixels one = pixels(1);
        EXPECT_EQ(one, pixels(2));
        EXPECT_NE(one, pixels_of(shot, BoundCompensation::None));
    }
}

// What all pixels share is found with its own noise, and the same mean: half a per cent for what borders see.
TEST(ScreenSpace, GoesWithSharingAmongPixels) {
    Shot shot = shot_of(bounded(1.0, BoundedTerm::BothCosines), 64, 48, 2);
    const auto added = [&] {
        return mean(pixels_of(shot, BoundCompensation::ScreenSpace)) - mean(pixels_of(shot, BoundCompensation::None));
    };
    const double alone = added();
    shot.virtual_lights.sharing_radius = 0.2;
    EXPECT_NEAR(added(), alone, 0.005 * alone);
}

}  // namespace
}  // namespace brisance
