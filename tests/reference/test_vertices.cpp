// The vertices of a path account for all of its radiance, and recording them does not change the path.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "camera/camera.h"
#include "fixtures/tracing_fixture.h"
#include "reference/trace_picture.h"
#include "render/trace_path.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kPixels = 12;  // along the picture's sides

// Half of it thin enough for lines toward the fire.
Medium burning_ball() {
    Recipe r = scattering_ball(8, 2.0, Rgb(0.9f, 0.8f, 0.5f));
    r.density = [density = r.density](const ivec3& n) { return (n.x > 0 ? 0.1f : 1.0f) * density(n); };
    return make_medium(r);
}

CameraSettings from_outside() {
    CameraSettings camera;
    camera.eye = dvec3(0.5, -5.0, 0.7);
    camera.vertical_fov_degrees = 25.0;
    camera.width = camera.height = kPixels;
    return camera;
}

PathSum gathered(const std::vector<TracedVertex>& vertices) {
    PathSum sum{};
    for (const TracedVertex& v : vertices)
        sum[std::min(v.order, kPathOrders - 1)] += v.from_fire + v.along_segment;
    return sum;
}

void expect_whole_paths(const std::vector<TracedVertex>& vertices) {
    ASSERT_FALSE(vertices.empty());
    EXPECT_EQ(vertices[0].order, 0);
    for (std::size_t i = 1; i < vertices.size(); ++i)
        EXPECT_TRUE(vertices[i].order == 1 || vertices[i].order == vertices[i - 1].order + 1);
}

class VerticesOf : public ::testing::TestWithParam<std::pair<EmissionEstimator, PixelFilter>> {};

TEST_P(VerticesOf, AddUpToThePath) {
    const Medium medium = burning_ball();
    TracingSettings settings;
    settings.emission = GetParam().first;
    CameraSettings camera_settings = from_outside();
    camera_settings.filter = GetParam().second;
    const Camera camera(camera_settings, medium);
    const PathTracer tracer(medium, settings, -1);
    int from_fire = 0, longest = 0;
    for (std::size_t pixel = 0; pixel < kPixels * kPixels; ++pixel) {
        std::vector<TracedVertex> vertices;
        PathStatistics unseen, seen;
        seen.vertices = &vertices;
        const PathSum path = trace_sample(tracer, camera, pixel, 3, seen);
        EXPECT_EQ(path, trace_sample(tracer, camera, pixel, 3, unseen));
        EXPECT_EQ(seen.scatterings, unseen.scatterings);
        expect_whole_paths(vertices);
        EXPECT_EQ(vertices.size(), 1 + seen.scatterings);
        const PathSum sum = gathered(vertices);
        for (int order = 0; order < kPathOrders; ++order)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(sum[order][c], path[order][c], 1e-5f * std::abs(path[order][c]));
        for (const TracedVertex& v : vertices) {
            from_fire += v.from_fire != Rgb(0.0f);
            longest = std::max(longest, v.order);
        }
    }
    EXPECT_GE(longest, 3);
    EXPECT_EQ(from_fire > 0, settings.emission == EmissionEstimator::Line);
}

// If the radiance of a path is not finite, one of its vertices gathered that value.
TEST(Vertices, ShowWhereAPathIsNotFinite) {
    Medium medium = burning_ball();
    medium.source.at(medium.lattice.find_node(ivec3(1, 2, -3))) = Rgb(std::numeric_limits<float>::quiet_NaN());
    const Camera camera(from_outside(), medium);
    const PathTracer tracer(medium, {}, -1);
    int bad_paths = 0;
    for (std::size_t pixel = 0; pixel < kPixels * kPixels; ++pixel) {
        std::vector<TracedVertex> vertices;
        PathStatistics statistics;
        statistics.vertices = &vertices;
        const PathSum path = trace_sample(tracer, camera, pixel, 0, statistics);
        const bool bad = std::any_of(path.begin(), path.end(), [](const Rgb& c) { return !std::isfinite(c.x); });
        EXPECT_EQ(std::all_of(vertices.begin(), vertices.end(), [](const TracedVertex& v) { return finite(v); }), !bad);
        bad_paths += bad;
    }
    EXPECT_GT(bad_paths, 0);
}

INSTANTIATE_TEST_SUITE_P(BothTrackers, VerticesOf,
                         ::testing::Values(std::pair(EmissionEstimator::Line, PixelFilter::Box),
                                           std::pair(EmissionEstimator::Line, PixelFilter::Gaussian),
                                           std::pair(EmissionEstimator::Collision, PixelFilter::Box)));

}  // namespace
}  // namespace brisance
