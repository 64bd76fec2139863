// Pictures with an open shutter: the smoke moves.
#include <gtest/gtest.h>

#include <cmath>

#include "camera_rays/moment_mean.h"
#include "camera_rays/picture.h"
#include "moving_media.h"
#include "render/many_lights.h"
#include "render/render_frame.h"

namespace brisance {
namespace {

using namespace testing;

Shot shot_of(int width, double shutter) {
    Shot shot;
    shot.camera_given = true;
    shot.camera.eye = dvec3(0.0, -12.0, 0.0);
    shot.camera.target = dvec3(0.0);
    shot.camera.vertical_fov_degrees = 30.0;
    shot.camera.width = width;
    shot.camera.height = width / 2;
    shot.shutter.length = shutter;
    shot.shutter.most_moments = 32;
    shot.lighting.error = 0.05f;
    shot.scattering.bounces = 1;
    shot.certify.belief = 0.0;
    shot.correction.samples = 0;  // by lights alone
    return shot;
}

Image render(const Shot& shot, const Medium& medium) {
    Progress silent;
    return render_medium(shot, medium, silent).image;
}

// Root of the summed squared differences over that of the squares.
double difference(const Layer& a, const Layer& b) {
    double sum = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        if (i % a.channels.size() < 3) {
            sum += std::pow(double(a.pixels[i]) - b.pixels[i], 2);
            norm += std::pow(double(b.pixels[i]), 2);
        }
    return std::sqrt(sum / norm);
}

// Smoke that moves one way before a camera looks as resting smoke does to a camera that moves the other way, which
// resamples nothing. The mean of such pictures, at other and more moments, is the truth. The light is the same in all.
Image mean_of_moved_cameras(const Shot& shot, const Medium& resting, const dvec3& velocity, int count) {
    const Plan plan = plan_cells(shot, resting, nullptr);
    const Camera middle(shot.camera, resting);
    Statistics ignored;
    Progress silent;
    const DrawInput input{shot, plan, resting, nullptr, middle};
    const ManyLights lights(input, ignored, silent);
    PictureSettings settings;
    settings.samples_per_axis = 2;
    settings.layers = plan.needed;
    settings.layers.set(Cell::V, true);
    MomentMean mean;
    for (int k = 0; k < count; ++k) {
        const dvec3 shift = -shot.shutter.length * ((k + 0.5) / count - 0.5) * velocity;
        CameraSettings camera = shot.camera;
        camera.eye += shift;
        camera.target += shift;
        mean.add(render_picture(lights.medium().field(), Camera(camera, resting), settings, silent));
    }
    return mean.take();
}

TEST(MotionBlur, MovingSmokeLooksAsFromAMovingCamera) {
    const vec3 v(1.7f, 0.0f, 0.6f);
    const Medium resting = gaussian(dvec3(0.0), 2.0f, 0.6f);
    Shot shot = shot_of(96, 0.8);
    shot.scattering.bounces = -1;
    const Image blurred = render(shot, with_velocity(resting, everywhere(v)));
    const Image truth = mean_of_moved_cameras(shot, resting, dvec3(v), 48);
    for (const char* cell : {"", "V", "MV", "MM"})
        EXPECT_LT(difference(blurred.layer(cell), truth.layer(cell)), 0.02) << cell;
    // The blur is far larger than that.
    EXPECT_GT(difference(render(shot_of(96, 0.0), resting).layer("V"), truth.layer("V")), 0.15);
}

// exp(-(a + b) / 2) is less than the mean of exp(-a) and exp(-b): a mean of densities would look denser.
TEST(MotionBlur, TransmittanceIsAveragedNotDensity) {
    const Medium resting = gaussian(dvec3(0.0), 40.0f);
    Shot shot = shot_of(64, 0.5);
    shot.scattering.bounces = 0;
    const Image blurred = render(shot, with_velocity(resting, everywhere(vec3(6.0f, 0.0f, 0.0f))));
    // Ray through the middle: the depth at distance d from the axis is 40 s sqrt(2 pi) exp(-d^2 / 2 s^2).
    double opacity = 0.0;
    constexpr int kSteps = 1000;
    for (int k = 0; k < kSteps; ++k) {
        const double d = 3.0 * ((k + 0.5) / kSteps - 0.5) / kDeviation;
        opacity += (1.0 - std::exp(-40.0 * kDeviation * std::sqrt(2.0 * M_PI) * std::exp(-0.5 * d * d))) / kSteps;
    }
    const std::size_t middle = 16 * 64 + 32;
    EXPECT_NEAR(blurred.layer("").pixels[4 * middle + 3], opacity, 0.04);
    EXPECT_LT(opacity, 0.95);
}

TEST(MotionBlur, WhatStandsStillIsTheSameToTheBit) {
    const Medium resting = gaussian(dvec3(0.0), 2.0f, 0.6f);
    const Image still = render(shot_of(48, 0.0), resting);
    const Image open = render(shot_of(48, 0.5), resting);
    const Image slow = render(shot_of(48, 0.5), with_velocity(resting, everywhere(vec3(1e-4f, 0.0f, 0.0f))));
    const Image closed = render(shot_of(48, 0.0), with_velocity(resting, everywhere(vec3(5.0f, 0.0f, 0.0f))));
    for (const Image* image : {&open, &slow, &closed})
        EXPECT_EQ(image->layer("").pixels, still.layer("").pixels);
}

TEST(MotionBlur, MoreLightingTimesAgreeWhereNothingChangesTheLight) {
    const Medium moving = with_velocity(gaussian(dvec3(0.0), 2.0f, 0.6f), everywhere(vec3(1.7f, 0.0f, 0.0f)));
    Shot shot = shot_of(64, 0.5);
    const Image once = render(shot, moving);
    shot.shutter.lighting_times = 3;
    const Image thrice = render(shot, moving);
    for (const char* cell : {"V", "MV"})
        EXPECT_LT(difference(once.layer(cell), thrice.layer(cell)), 0.02) << cell;
}

TEST(MotionBlur, SaysWhatItDidAndWhatItLeftOut) {
    Shot shot = shot_of(96, 0.5);
    shot.shutter.most_moments = 4;
    shot.scattering.bounces = 0;
    Listener listener;
    render_medium(shot, with_velocity(gaussian(dvec3(0.0)), everywhere(vec3(4.0f, 0.0f, 0.0f))), listener);
    const auto said = [&](const std::string& part) {
        return std::any_of(listener.notices.begin(), listener.notices.end(),
                           [&](const std::string& line) { return line.find(part) != std::string::npos; });
    };
    EXPECT_TRUE(said("at 4 moments"));
    EXPECT_TRUE(said("shutter.most_moments"));
}

// The certificate's paths draw a moment each. Two standard errors beyond the interval allow for its confidence.
TEST(MotionBlur, PathsAgreeWithTheGridWithinItsError) {
    Shot shot = shot_of(48, 0.8);
    shot.certify.enabled = true;
    shot.certify.samples = 1 << 17;
    Progress silent;
    const Medium moving = with_velocity(gaussian(dvec3(0.0), 2.0f, 0.6f), everywhere(vec3(1.7f, 0.0f, 0.6f)));
    const RenderedFrame frame = render_medium(shot, moving, silent);
    for (const auto& cell : frame.statistics.certificate["cells"])
        EXPECT_LT(cell["error"].get<double>(), 0.04) << cell.dump();
    shot.method = RenderMethod::Path;
    shot.certify.enabled = false;
    shot.tracing.samples = 256;
    const Image paths = render_medium(shot, moving, silent).image;
    for (const char* cell : {"", "V", "MV"})
        EXPECT_LT(difference(frame.image.layer(cell), paths.layer(cell)), 0.06) << cell;
}

}  // namespace
}  // namespace brisance
