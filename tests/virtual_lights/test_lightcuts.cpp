// Cuts through the tree of lights, deterministic and stochastic, at single vertices, where points have no other noise.
#include <gtest/gtest.h>

#include <numeric>

#include "room.h"
#include "transport/light_cut.h"
#include "virtual_lights/flux/deposit_flux.h"
#include "virtual_lights/gatherers/lightcuts.h"
#include "virtual_lights/gatherers/stochastic_lightcuts.h"
#include "virtual_lights/kinds/point_light.h"
#include "virtual_lights/technique.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kVertices = 60;

// Points on light paths in a room with a floor of rough metal.
struct Points {
    explicit Points(int count = 300, const SceneSettings& scene = glossy_room()) : room(scene) {
        settings.count = count;
        settings.placement = "light_paths";
        settings.flux = "own";
        settings.kind = "point";
        settings.sampling = "power";
        settings.path_extension = false;
        settings.point_bound = 3.0;
        set = lights_of(settings);
        for (std::uint64_t i = 0; vertices.size() < kVertices; ++i) {
            Rng rng(Stream::Path, i);
            const Ray ray = room.ray(64.0 * rng.next_double(), 64.0 * rng.next_double());
            const RaySegment segment = room.direct.segment_along(ray);
            if (segment.point && segment.point->material.base_colour != Rgb(0.0f))
                vertices.emplace_back(*segment.point, ray.direction);
        }
    }

    std::unique_ptr<LightSet> lights_of(const VirtualLightSettings& s) const {
        auto out = std::make_unique<LightSet>(room.direct, s);
        const Technique technique = technique_of(s);
        const PixelCamera camera = room.camera();
        technique.build(*out, *technique.placement, {camera, {}});
        technique.fit(*out);
        return out;
    }

    // The same lights under other settings of the gatherer.
    std::unique_ptr<LightSet> with(const VirtualLightSettings& s) const {
        auto out = std::make_unique<LightSet>(room.direct, s);
        out->lights = set->lights;
        out->complete = set->complete;
        return out;
    }

    // The mean and the standard error of what the vertex scatters.
    struct Seen {
        double mean = 0.0, error = 0.0;
    };
    Seen seen(const VirtualLightSettings& s, const PathVertex& vertex, int samples) const {
        const std::unique_ptr<LightSet> lights = with(s);
        const auto gatherer = technique_of(s).gather(*lights, power_alone);
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < samples; ++i) {
            Rng rng(Stream::Surface, static_cast<std::uint64_t>(i));
            const double x = luminance(gatherer->from_lights(vertex, rng));
            sum += x;
            squares += x * x;
        }
        const double mean = sum / samples;
        return {mean, std::sqrt(std::max(0.0, squares / samples - mean * mean) / samples)};
    }

    std::vector<double> of_all() const {
        VirtualLightSettings s = settings;
        s.sampling = "all";
        std::vector<double> out;
        for (const PathVertex& vertex : vertices)
            out.push_back(seen(s, vertex, 1).mean);
        return out;
    }

    Room room;
    VirtualLightSettings settings;
    std::unique_ptr<LightSet> set;
    std::vector<PathVertex> vertices;
};

// What the lights of a node would send without occlusion is never above its bound, from anywhere.
TEST(NodeBounds, HoldForTheLightsBelowThem) {
    const Points points;
    const LightTree tree(bounds_of(points.set->lights, LobeBrightness::Peak));
    const PointKind::Of<DepositFlux> kind(*points.set);
    std::vector<double> sum(tree.node_count());
    for (const PathVertex& vertex : points.vertices) {
        const VertexBounds bounds(tree, vertex, 0.0);
        std::fill(sum.begin(), sum.end(), 0.0);
        for (auto node = static_cast<std::uint32_t>(tree.node_count()); node-- > 0;) {
            if (tree.is_leaf(node)) {
                const std::size_t light = tree.light(node);
                Rng rng(Stream::Path, 0);
                const dvec3 direction = kind.sample(light, vertex, rng);
                sum[node] = luminance(kind.radiance(light, vertex, direction) * vertex.at(direction).value);
            } else {
                sum[node] = sum[tree.left(node)] + sum[tree.right(node)];
            }
            EXPECT_LE(sum[node], bounds.of(node).largest() * (1.0 + 1e-4)) << node;
        }
    }
}

TEST(Lightcuts, WithoutErrorAreAllLights) {
    const Points points;
    const std::vector<double> truth = points.of_all();
    VirtualLightSettings s = points.settings;
    s.sampling = "lightcuts";
    s.lightcuts_error = 0.0;
    s.lightcuts_most = 1000000;
    for (int i = 0; i < kVertices; ++i)
        EXPECT_NEAR(points.seen(s, points.vertices[i], 1).mean, truth[i], 1e-4 * truth[i] + 1e-9);
}

double error_of(const Points& points, const VirtualLightSettings& s, const std::vector<double>& truth) {
    double squares = 0.0, all = 0.0;
    for (int i = 0; i < kVertices; ++i) {
        squares += std::pow(points.seen(s, points.vertices[i], 1).mean - truth[i], 2);
        all += truth[i] * truth[i];
    }
    return std::sqrt(squares / all);
}

// 2 % is what one node may err; nodes do not err all to one side.
TEST(Lightcuts, ErrAboutAsMuchAsTheyMay) {
    const Points points(1000);
    const std::vector<double> truth = points.of_all();
    VirtualLightSettings s = points.settings;
    s.sampling = "lightcuts";
    EXPECT_LT(error_of(points, s, truth), 0.02);
    s.lightcuts_error = 0.2;
    EXPECT_GT(error_of(points, s, truth), 0.002) << "it saves nothing";
    EXPECT_LT(error_of(points, s, truth), 0.2);
    s.lightcuts_most = 1;
    EXPECT_GT(error_of(points, s, truth), 0.2) << "one light stands for all";
}

// Over trees drawn anew the mean is right, however small the cut.
TEST(Lightcuts, HaveTheRightMeanOverRepresentatives) {
    const Points points;
    VirtualLightSettings s = points.settings;
    s.sampling = "lightcuts";
    s.lightcuts_most = 16;
    constexpr int kTrees = 1000;
    const std::vector<double> truth = points.of_all();
    for (const int vertex : {0, 20, 40}) {
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < kTrees; ++i) {
            s.seed = static_cast<std::uint32_t>(i);
            const double x = points.seen(s, points.vertices[vertex], 1).mean;
            sum += x;
            squares += x * x;
        }
        const double mean = sum / kTrees, error = std::sqrt((squares / kTrees - mean * mean) / kTrees);
        EXPECT_NEAR(mean, truth[vertex], kSigmas * error);
        EXPECT_LT(error, 0.1 * truth[vertex]);
    }
}

// Every vertex alone has the right mean, whatever the size of the cut; one that holds all lights has no noise.
TEST(StochasticLightcuts, HaveTheRightMeanAtEveryVertex) {
    const Points points;
    const std::vector<double> truth = points.of_all();
    VirtualLightSettings s = points.settings;
    s.sampling = "stochastic_lightcuts";
    for (const int size : {1, 2, 10, 100}) {
        s.stochastic_cut_size = size;
        for (int i = 0; i < kVertices; i += 6) {
            const Points::Seen seen = points.seen(s, points.vertices[i], 2000);
            EXPECT_NEAR(seen.mean, truth[i], kSigmas * seen.error + 1e-4 * truth[i]) << size << " " << i;
        }
    }
    s.stochastic_cut_size = 1000000;
    for (int i = 0; i < kVertices; ++i)
        EXPECT_NEAR(points.seen(s, points.vertices[i], 1).mean, truth[i], 1e-4 * truth[i] + 1e-9);
}

// In a small room, where every light is about as near as any other, and half of what is chosen may be hidden.
TEST(StochasticLightcuts, OfTenHaveLessNoiseThanTenUniform) {
    const Points points(2000, coloured_room());
    VirtualLightSettings cut = points.settings, uniform = points.settings;
    cut.sampling = "stochastic_lightcuts";
    uniform.sampling = "uniform";
    uniform.light_samples = 10;
    double of_cuts = 0.0, of_uniform = 0.0;
    for (int i = 0; i < kVertices; i += 3) {
        of_cuts += std::pow(points.seen(cut, points.vertices[i], 200).error, 2);
        of_uniform += std::pow(points.seen(uniform, points.vertices[i], 200).error, 2);
    }
    EXPECT_LT(std::sqrt(of_cuts), 0.8 * std::sqrt(of_uniform));
}

// The same mean for any split of the samples, and the noise of that many.
TEST(LightSamples, AreThatManyLights) {
    const Points points;
    const std::vector<double> truth = points.of_all();
    for (const char* sampling : {"power", "uniform", "plain_power", "light_tree"}) {
        VirtualLightSettings s = points.settings;
        s.sampling = sampling;
        const Points::Seen one = points.seen(s, points.vertices[0], 6400);
        s.light_samples = 16;
        const Points::Seen many = points.seen(s, points.vertices[0], 400);
        EXPECT_NEAR(one.mean, truth[0], kSigmas * one.error) << sampling;
        EXPECT_NEAR(many.mean, truth[0], kSigmas * many.error) << sampling;
        EXPECT_NEAR(many.error / one.error, 1.0, 0.4) << sampling;
    }
}

// As many lights as you like in one point are one light.
TEST(StochasticLightcuts, OfVeryManyLightsInOnePoint) {
    LightBounds one;
    one.low = one.high = dvec3(0.0, 1.0, 0.0);
    one.axis = dvec3(0.0, -1.0, 0.0);
    one.reach = std::acos(-1.0) / 2.0;
    one.intensity = 1.0;
    constexpr std::size_t kLights = 200000;
    const LightTree tree(std::vector<LightBounds>(kLights, one));
    EXPECT_EQ(representatives(tree, 0).size(), tree.node_count());
    for (const dvec3& at : {dvec3(0.0), dvec3(0.0, 1.0, 0.0)}) {
        const PathVertex vertex(at, dvec3(0.0, 1.0, 0.0), 0.0f);
        const VertexBounds bounds(tree, vertex, 0.0);
        const auto choice = tree.choose_below(0, 0.37, [&](std::uint32_t left, std::uint32_t right) {
            return share_by_distances(bounds.of(left), bounds.of(right));
        });
        ASSERT_TRUE(choice);
        EXPECT_NEAR(choice->probability * kLights, 1.0, 0.2);
    }
}

TEST(Shares, AreByPowerWhereNothingElseIsKnown) {
    const NodeBound here{3.0, 0.0, 0.0}, same{1.0, 0.0, 0.0}, dark{0.0, 1.0, 2.0}, far{1.0, 4.0, 9.0};
    EXPECT_DOUBLE_EQ(share_by_distances(here, same), 0.75);
    EXPECT_EQ(share_by_distances(dark, dark), -1.0);
    EXPECT_EQ(share_by_distances(dark, far), 0.0);
    EXPECT_EQ(share_by_distances(far, dark), 1.0);
    EXPECT_DOUBLE_EQ(share_by_distances(far, far), 0.5);
    // The vertex lies in the left box: nearest distances say everything, farthest ones something else.
    const NodeBound around{1.0, 0.0, 9.0};
    EXPECT_DOUBLE_EQ(share_by_distances(around, far), 0.75);
}

}  // namespace
}  // namespace brisance
