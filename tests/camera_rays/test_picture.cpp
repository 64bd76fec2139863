// Pictures: pixels are averages of rays, and nothing but the scene shows in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "camera_rays/automatic_samples.h"
#include "camera_rays/picture.h"
#include "core/parallel.h"
#include "fixtures/media.h"
#include "medium/lattice/voxel_walk.h"
#include "render/render_frame.h"

namespace brisance {
namespace {

using testing::cubic;
using testing::make_medium;
using testing::noise;
using testing::Recipe;

Recipe cloud(double spacing = 0.1, float extinction = 4.0f, const dvec3& origin = dvec3(0.0)) {
    Recipe r;
    r.box = testing::cube(-16, 16);
    r.world_from_index = cubic(spacing, origin);
    r.density = [](const ivec3& n) { return testing::ball(n, dvec3(0.0), 13.0) * noise(n >> 1, 1); };
    r.flame = [](const ivec3& n) { return noise(n, 2); };
    r.settings = testing::black_smoke();
    r.settings.smoke.albedo = Rgb(0.25f);
    r.settings.smoke.extinction_per_metre = extinction;
    return r;
}

CameraSettings front(double scale = 1.0, const dvec3& origin = dvec3(0.0)) {
    CameraSettings s;
    s.eye = origin + scale * dvec3(1.0, -5.0, 0.7);
    s.target = origin;
    s.vertical_fov_degrees = 40.0;
    s.width = 24;
    s.height = 20;
    return s;
}

Image picture(const Medium& medium, const CameraSettings& camera, int samples = 1) {
    const SourceField field(medium);
    PictureSettings settings;
    settings.samples_per_axis = samples;
    Progress silent;
    return render_picture(field, Camera(camera, medium), settings, silent);
}

double largest_difference(const Layer& a, const Layer& b) {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        largest = std::max(largest, std::abs(double(a.pixels[i]) - b.pixels[i]));
    return largest;
}

double brightest(const Layer& layer) {
    return *std::max_element(layer.pixels.begin(), layer.pixels.end());
}

TEST(Picture, AnEvenGlowIsEvenUnderEveryFilter) {
    Recipe r = cloud();
    r.density = r.flame = [](const ivec3&) { return 1.0f; };
    r.settings = testing::black_smoke();
    r.settings.smoke.extinction_per_metre = 30.0f;
    const Medium medium = make_medium(r);
    CameraSettings inside = front();
    inside.eye = {0.03, 0.02, 0.01};
    inside.target = {0.03, 1.0, 0.01};
    for (const PixelFilter filter : {PixelFilter::Box, PixelFilter::Gaussian})
        for (const float width : {0.5f, 1.0f, 2.0f, 3.3f})
            for (const int samples : {1, 3}) {
                inside.filter = filter;
                inside.filter_width_pixels = width;
                const Image image = picture(medium, inside, samples);
                for (const float v : image.layer("").pixels)
                    ASSERT_NEAR(v, 1.0f, 2e-5f);
            }
}

TEST(Picture, AGaussianFilterWeighsTheMiddleMore) {
    // One opaque half of the picture: how fast the edge turns dark shows the filter.
    Recipe r = cloud();
    r.density = [](const ivec3& n) { return n.x >= 0 ? 1.0f : 0.0f; };
    r.settings.smoke.extinction_per_metre = 1e4f;
    const Medium medium = make_medium(r);
    CameraSettings camera = front();
    camera.eye = {-0.1, -40.0, 0.0};
    camera.target = {-0.1, 0.0, 0.0};  // the ramp begins on the picture's axis
    camera.vertical_fov_degrees = 2.0;
    camera.width = 41;
    camera.filter_width_pixels = 4.0f;
    const auto row = [&](PixelFilter filter) {
        camera.filter = filter;
        const Image image = picture(medium, camera, 4);
        std::vector<float> alpha;
        for (int x = 0; x < 41; ++x)
            alpha.push_back(image.layer("").pixels[4 * (10 * 41 + x) + 3]);
        return alpha;
    };
    const std::vector<float> box = row(PixelFilter::Box), gaussian = row(PixelFilter::Gaussian);
    EXPECT_NEAR(box[20], gaussian[20], 0.03f) << "symmetric about the edge";
    EXPECT_GT(gaussian[21], box[21] + 0.05f);
    EXPECT_LT(gaussian[19], box[19] - 0.05f);
}

TEST(Picture, BeautyIsTheSumOfItsCells) {
    const Medium medium = make_medium(cloud());
    std::vector<Rgb> single(medium.lattice.node_count()), multiple(single.size());
    for (std::size_t i = 0; i < single.size(); ++i) {
        single[i] = Rgb(float(i % 7), 1.0f, 0.5f);
        multiple[i] = Rgb(1.0f, float(i % 5), 0.0f);
    }
    const NodeSources sources{single, multiple, {}, {}};
    const SourceField field(medium, sources);
    PictureSettings settings;
    settings.layers = {Cell::V, Cell::MV, Cell::MM};
    Progress silent;
    const Image image = render_picture(field, Camera(front(), medium), settings, silent);
    double largest = 0.0;
    for (std::size_t p = 0; p < 24 * 20; ++p)
        for (int c = 0; c < 3; ++c) {
            const float sum = image.layer("V").pixels[3 * p + c] + image.layer("MV").pixels[3 * p + c] +
                              image.layer("MM").pixels[3 * p + c];
            ASSERT_EQ(image.layer("").pixels[4 * p + c], sum);
            largest = std::max<double>(largest, sum);
        }
    EXPECT_GT(largest, 1.0);
}

// Forward peaks count as no scattering on the way to the picture, but not in its layers.
TEST(Picture, ForwardScatteringStandsInItsOwnLayer) {
    Recipe r = cloud();
    r.settings.smoke.mean_cosine = 0.8f;
    const Medium medium = make_medium(r);
    Shot shot;
    shot.camera = front();
    shot.camera_given = true;
    shot.camera.samples_per_axis = 2;  // second looks follow the whole picture
    shot.correction.samples = 0;       // by lights alone
    Progress silent;
    const Image all = render_medium(shot, medium, silent).image;
    shot.scattering.bounces = 1;
    const Image single = render_medium(shot, medium, silent).image;
    EXPECT_LT(largest_difference(all.layer("MV"), single.layer("MV")), 1e-3 * brightest(single.layer("MV")));
    const Layer &v = all.layer("V"), &mv = all.layer("MV"), &mm = all.layer("MM"), &beauty = all.layer("");
    EXPECT_GT(brightest(mm), 0.05 * brightest(mv));
    for (std::size_t i = 0; i < mm.pixels.size(); ++i) {
        EXPECT_GE(mm.pixels[i], 0.0f);
        const double sum = double(v.pixels[i]) + mv.pixels[i] + mm.pixels[i];
        EXPECT_NEAR(sum, beauty.pixels[i / 3 * 4 + i % 3], 1e-5 * brightest(beauty));
    }
}

TEST(Picture, DepthIsMeasuredAlongTheViewAxis) {
    Recipe r = cloud();
    r.box = {ivec3(-40, 0, -40), ivec3(40, 15, 40)};
    r.density = [](const ivec3&) { return 1.0f; };
    r.flame = nullptr;
    r.settings.smoke.extinction_per_metre = 1e4f;
    const Medium wall = make_medium(r);  // opaque within a thousandth of a voxel of its ramp
    CameraSettings camera = front();
    camera.eye = {0.0, -5.0, 0.0};
    const Image image = picture(wall, camera);
    for (const float z : image.layer("Z").pixels)
        ASSERT_NEAR(z, 4.9f, 0.05f);  // the ramp begins one voxel before the wall
    camera.target = {0.0, -9.0, 0.0};
    const Image away = picture(wall, camera);
    for (const float z : away.layer("Z").pixels)
        ASSERT_EQ(z, 1e10f);
    for (const float v : away.layer("").pixels)
        ASSERT_EQ(v, 0.0f);
}

TEST(Picture, AlbedoIsPremultipliedByAlpha) {
    const Image image = picture(make_medium(cloud()), front());
    for (std::size_t p = 0; p < 24 * 20; ++p)
        ASSERT_NEAR(image.layer("albedo").pixels[3 * p], 0.25f * image.layer("").pixels[4 * p + 3], 1e-4f);
    EXPECT_GT(brightest(image.layer("albedo")), 0.05);
}

TEST(Picture, IsTheSameAMillionMetresAway) {
    const dvec3 far(1e6, -1e6, 1e6);
    const Image here = picture(make_medium(cloud()), front());
    const Image there = picture(make_medium(cloud(0.1, 4.0f, far)), front(1.0, far));
    EXPECT_LT(largest_difference(here.layer(""), there.layer("")), 1e-3 * brightest(here.layer("")));
    EXPECT_LT(largest_difference(here.layer("V"), there.layer("V")), 1e-3 * brightest(here.layer("V")));
}

TEST(Picture, TwiceTheSizeAndHalfTheExtinctionIsTheSamePicture) {
    const Image small = picture(make_medium(cloud()), front());
    for (const double scale : {2.0, 100.0, 0.01}) {
        const Image scaled = picture(make_medium(cloud(0.1 * scale, static_cast<float>(4.0 / scale))), front(scale));
        EXPECT_LT(largest_difference(small.layer(""), scaled.layer("")), 1e-4 * brightest(small.layer(""))) << scale;
    }
}

TEST(Picture, TheNumberOfThreadsDoesNotShow) {
    const Medium medium = make_medium(cloud());
    std::vector<Image> images;
    for (const int threads : {1, 2, 8}) {
        const ThreadLimit limit(threads);
        images.push_back(picture(medium, front(), 2));
    }
    for (const Layer& layer : images[0].layers) {
        EXPECT_EQ(layer.pixels, images[1].layer(layer.name).pixels);
        EXPECT_EQ(layer.pixels, images[2].layer(layer.name).pixels);
    }
}

TEST(Picture, FinerPixelsNeedFewerSamples) {
    const Medium medium = make_medium(cloud());
    CameraSettings camera = front();
    camera.height = camera.width = 1000;
    EXPECT_EQ(automatic_samples(Camera(camera, medium), medium).few, 1);
    EXPECT_EQ(automatic_samples(Camera(camera, medium), medium).enough, 1);
    camera.height = camera.width = 100;
    const AutomaticSamples medium_size = automatic_samples(Camera(camera, medium), medium);
    EXPECT_LT(medium_size.few, medium_size.enough);
    camera.height = camera.width = 5;
    EXPECT_EQ(automatic_samples(Camera(camera, medium), medium).few, 8);
    EXPECT_EQ(automatic_samples(Camera(camera, medium), medium).enough, 8);
}

// Smoke is as fine in haze as without: what has no detail, and is nearest, says nothing of the rays that smoke needs.
TEST(Picture, HazeAroundTheCameraLeavesTheSamples) {
    Recipe r = cloud();
    const auto ball = [](const ivec3& n) { return testing::ball(n, dvec3(0.0), 13.0); };
    r.flame = [ball](const ivec3& n) { return ball(n) * noise(n, 2); };
    const Medium alone = make_medium(r);
    r.box = testing::cube(-56, 56);
    r.density = [ball](const ivec3& n) { return 1e-3f + ball(n) * noise(n >> 1, 1); };
    const Medium in_haze = make_medium(r);
    for (const int size : {50, 100, 300}) {
        CameraSettings camera = front();
        camera.height = camera.width = size;
        const AutomaticSamples a = automatic_samples(Camera(camera, alone), alone),
                               b = automatic_samples(Camera(camera, in_haze), in_haze);
        EXPECT_EQ(a.few, b.few) << size;
        EXPECT_EQ(a.enough, b.enough) << size;
    }
}

// Fine smoke over coarse pixels: one ray in each is off. A second look finds where. Most pixels err by far less than
// the most that is tolerated of one.
double error_after_second_look(const Medium& medium, const CameraSettings& camera, float tolerance) {
    const SourceField field(medium);
    PictureSettings settings;
    settings.finest_medium_samples_per_axis = 8;
    settings.tolerance = tolerance;
    Progress silent;
    const Image seen = render_picture(field, Camera(camera, medium), settings, silent),
                truth = picture(medium, camera, 24);
    const std::vector<float>&a = seen.layer("").pixels, &b = truth.layer("").pixels;
    double square = 0.0, norm = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        square += (a[i] - b[i]) * (a[i] - b[i]);
        norm += b[i] * b[i];
    }
    return std::sqrt(square / norm);
}

TEST(Picture, SecondLooksErrByNoMoreThanIsTolerated) {
    const Medium medium = make_medium(cloud());
    EXPECT_GT(error_after_second_look(medium, front(), 0.0f), 0.05);
    for (const float tolerance : {0.03f, 0.01f})
        EXPECT_LT(error_after_second_look(medium, front(), tolerance), tolerance);
}

}  // namespace
}  // namespace brisance
