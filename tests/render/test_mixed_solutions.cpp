// Pictures between the lighting grid and volumetric photons: whole pictures of both, mixed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "fixtures/media.h"
#include "forecast/plan.h"
#include "forecast/scattering_choice.h"
#include "render/render_frame.h"

namespace brisance::test_mixed_solutions {
namespace {

using namespace testing;

constexpr float kMiddle = 0.5f;

Shot lamp_in_haze(float escape) {
    Shot shot;
    shot.camera_given = true;
    shot.camera.eye = {0.3, -5.0, 1.5};
    shot.camera.target = {0.0, 0.0, 0.0};
    shot.camera.vertical_fov_degrees = 32.0;
    shot.camera.width = shot.camera.height = 16;
    shot.camera.samples_per_axis = 3;
    shot.certify.belief = 0.0;
    shot.correction.samples = 0;  // by lights alone
    shot.scattering.escape = escape;
    shot.scattering_methods.get<VolumetricPhotonSettings>().paths = 30000;
    return shot;
}

Shot by_name(const std::string& method, float escape) {
    Shot shot = lamp_in_haze(escape);
    shot.scattering_methods.method = method;
    return shot;
}

Medium haze(float mean_cosine, float extinction = 0.5f) {
    Recipe r;
    r.box = cube(-8, 8);
    r.world_from_index = cubic(0.125);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = Rgb(0.9f, 0.8f, 0.7f);
    r.settings.smoke.mean_cosine = mean_cosine;
    return make_medium(r);
}

// In the haze, where the two solutions differ most: the grid does not see it.
const Surroundings& lamp() {
    static const Surroundings around = [] {
        LightSettings light;
        light.position = {0.3, -0.2, 0.25};
        light.power = Rgb(10.0f);
        return Surroundings(Scene{}, {light});
    }();
    return around;
}

RenderedFrame render(const Shot& shot, const Medium& medium) {
    Progress silent;
    return render_medium(shot, medium, silent, &lamp());
}

bool ran(const RenderedFrame& frame, const std::string& part) {
    return std::ranges::any_of(frame.statistics.stages,
                               [&](const StageCost& s) { return s.name.find(part) != std::string::npos; });
}

// The escape probability whose picture is photons' to this share, for sharp phase functions.
float escape_for(float share) {
    float low = 0.0f, high = 1.0f;
    for (int i = 0; i < 30; ++i) {
        const float middle = 0.5f * (low + high);
        (thinness(middle) < share ? low : high) = middle;
    }
    return high;
}

// Of all pixels and colours: photons are noise from pixel to pixel.
double mean_of(const Image& image) {
    const std::vector<float>& pixels = image.layer("").pixels;
    double sum = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        sum += i % 4 < 3 ? pixels[i] : 0.0;
    return sum;
}

double change(const Image& from, const Image& to) {
    return std::abs(mean_of(to) / mean_of(from) - 1.0);
}

constexpr const char *kGridStage = "orders of scattering", *kPhotonStage = "photons (MM, SM)";

TEST(MixedSolutions, AreNotComputedAtTheEnds) {
    const Medium sharp = haze(0.8f);
    const RenderedFrame grid = render(lamp_in_haze(0.0f), sharp), photons = render(lamp_in_haze(1.0f), sharp),
                        both = render(lamp_in_haze(escape_for(kMiddle)), sharp);
    EXPECT_TRUE(ran(grid, kGridStage));
    EXPECT_FALSE(ran(grid, kPhotonStage));
    EXPECT_FALSE(ran(photons, kGridStage));
    EXPECT_TRUE(ran(photons, kPhotonStage));
    EXPECT_TRUE(ran(both, kGridStage));
    EXPECT_TRUE(ran(both, kPhotonStage));
    // They are those of the methods by name, bit by bit.
    EXPECT_EQ(render(by_name(kLightingGridMethod, 0.0f), sharp).image.layer("").pixels, grid.image.layer("").pixels);
    EXPECT_EQ(render(by_name(VolumetricPhotonsMethod::kName, 1.0f), sharp).image.layer("").pixels,
              photons.image.layer("").pixels);
}

TEST(MixedSolutions, AreTheWeightedSumsOfBoth) {
    const Medium sharp = haze(0.8f);
    const float escape = escape_for(kMiddle), share = thinness(escape);
    const Image grid = render(by_name(kLightingGridMethod, escape), sharp).image,
                photons = render(by_name(VolumetricPhotonsMethod::kName, escape), sharp).image;
    const RenderedFrame mixed = render(lamp_in_haze(escape), sharp);
    EXPECT_NEAR(share, kMiddle, 1e-3f);
    for (const Layer& layer : mixed.image.layers) {
        const std::vector<float>&a = grid.layer(layer.name).pixels, &b = photons.layer(layer.name).pixels;
        for (std::size_t i = 0; i < a.size(); ++i)
            ASSERT_NEAR(layer.pixels[i], a[i] + share * (b[i] - a[i]), 1e-6f * (std::abs(a[i]) + std::abs(b[i])))
                << layer.name;
    }
    double stages = 0.0;
    for (const StageCost& s : mixed.statistics.stages)
        stages += s.seconds;
    EXPECT_NEAR(stages, mixed.statistics.seconds, 1e-6 + 1e-6 * stages);
}

// Fire alone: no rays look for lamps in either picture.
TEST(MixedSolutions, NeedNoLamps) {
    Recipe r = glowing_ball(8, 1.0f);
    r.settings.smoke.albedo = Rgb(0.8f);
    r.settings.smoke.mean_cosine = 0.7f;
    const Medium medium = make_medium(r);
    Progress silent;
    for (const float escape : {0.0f, escape_for(kMiddle), 1.0f}) {
        const Shot shot = lamp_in_haze(escape);
        EXPECT_EQ(plan_cells(shot, medium).emitters_by_rays, 0.0f);
        const RenderedFrame frame = render_medium(shot, medium, silent);
        EXPECT_EQ(ran(frame, kGridStage), escape < 1.0f) << escape;
        EXPECT_EQ(ran(frame, kPhotonStage), escape > 0.0f) << escape;
        EXPECT_GT(mean_of(frame.image), 0.0) << escape;
    }
}

// From the grid's picture to the photons' while g rises from 0.4 to 0.6.
TEST(MixedSolutions, FollowTheMeanCosineWithoutJumps) {
    const Shot shot = lamp_in_haze(1.0f);
    Image before = render(shot, haze(0.36f)).image;
    for (int k = 38; k <= 64; k += 2) {
        Image next = render(shot, haze(0.01f * float(k))).image;
        const double step = change(before, next);
        std::printf("g = %.2f: change %.4f\n", 0.01 * k, step);
        EXPECT_LT(step, 0.02) << k;
        before = std::move(next);
    }
}

// With the lamp inside and this peak, the two solutions differ by a seventh. The picture itself loses up to 7 % from
// step to step.
TEST(MixedSolutions, FollowTheDensityWithoutJumps) {
    constexpr float kPeak = 0.9f;
    const Shot shot = lamp_in_haze(-1.0f);
    const auto picture = [&](const std::string& method, float extinction) {
        return render(by_name(method, -1.0f), haze(kPeak, extinction)).image;
    };
    const std::string grid = kLightingGridMethod, photons = VolumetricPhotonsMethod::kName;
    EXPECT_GT(change(picture(grid, 3.5f), picture(photons, 3.5f)), 0.07);
    int mixed = 0;
    std::vector<float> shares;
    Image before = picture(kAutomaticMethod, 2.9f);
    for (float extinction = 3.1f; shares.empty() || shares.back() > 0.0f; extinction *= 1.07f) {
        shares.push_back(plan_cells(shot, haze(kPeak, extinction), &lamp()).share_of_method);
        mixed += shares.back() > 0.0f && shares.back() < 1.0f;
        Image next = picture(kAutomaticMethod, extinction);
        const double step = change(before, next);
        std::printf("extinction %.3g: photons %.3f, change %.4f\n", extinction, shares.back(), step);
        EXPECT_LT(step, 0.11) << extinction;
        before = std::move(next);
    }
    EXPECT_EQ(shares.front(), 1.0f);
    EXPECT_GT(mixed, 3);
}

TEST(MixedSolutions, DoNotDependOnThreads) {
    const Medium sharp = haze(0.55f);
    const Shot shot = lamp_in_haze(escape_for(kMiddle));
    const auto pixels = [&](int threads) {
        const ThreadLimit limit(threads);
        return render(shot, sharp).image.layer("").pixels;
    };
    EXPECT_EQ(pixels(1), pixels(2));
}

}  // namespace
}  // namespace brisance::test_mixed_solutions
