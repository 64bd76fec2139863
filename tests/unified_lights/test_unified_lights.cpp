// Lights of all kinds chosen together: each cell keeps the mean that it has by itself, and samples go where the light
// comes from.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "transport/light_cut.h"
#include "unified_lights/lit_set.h"

namespace brisance {
namespace {

using namespace testing;

void expect_means(const LitSet& set, const Estimate& apart, const std::string& sampling,
                  const UnifiedLightSettings& settings, const char* what) {
    const UnifiedLights unified = set.unified(sampling, settings);
    const Estimate together = set.together(unified, 0.02);
    const char* const cells[] = {"SS", "SV", "SA"};
    for (int c = 0; c < 3; ++c) {
        const double error = std::hypot(apart.error[c], together.error[c]);
        std::printf("%s, %s, %s: apart %.4g, together %.4g, standard error %.2g\n", what, sampling.c_str(), cells[c],
                    apart.mean[c], together.mean[c], error);
        EXPECT_GT(apart.mean[c], 0.0);
        EXPECT_NEAR(together.mean[c], apart.mean[c], 4.0 * error) << what << ", " << sampling << ", " << cells[c];
    }
}

void expect_means_by_all(const LitSet& set, const char* what) {
    const Estimate apart = set.apart(0.01);
    for (const UnifiedLightSampling& row : unified_light_samplings()) {
        UnifiedLightSettings s;
        s.lightcuts_error = 0.0;
        s.lightcuts_most = 100000;
        s.samples = 8;
        expect_means(set, apart, row.name, s, what);
    }
    UnifiedLightSettings one;
    one.stochastic_cut_size = 1;
    expect_means(set, apart, "stochastic_lightcuts", one, what);
}

TEST(UnifiedLights, HaveTheMeansOfTheirCells) {
    expect_means_by_all(LitSet(small_fire(1.0f), floor_and_wall(0.0f), lamp_sun_and_sky()), "matt");
}

TEST(UnifiedLights, HaveTheMeansOfTheirCellsOnGlossAndWithTriangles) {
    Scene set = floor_and_wall(0.5f);
    add_ceiling(set, 6, 0.2f);
    expect_means_by_all(LitSet(small_fire(1.0f), std::move(set), lamp_sun_and_sky()), "glossy");
}

// A cut of one node has the right mean over trees drawn anew, whatever it errs.
TEST(UnifiedLights, ACutOfOneHasTheMeanOverItsRepresentatives) {
    const LitSet set(small_fire(1.0f), floor_and_wall(0.0f), lamp_sun_and_sky(), 20);
    const dvec3 u(0.3, 0.4, 0.0);
    const PathVertex v = set.vertex(u), b = set.base(u);
    const auto mean_of = [&](const UnifiedLights& unified, int times) {
        double sum = 0.0;
        for (int i = 0; i < times; ++i) {
            Rng rng = unified.rng(1, static_cast<std::uint64_t>(i));
            sum += luminance(unified.at({v, &b}, rng)) / times;
        }
        return sum;
    };
    const double truth = mean_of(set.unified("all", {}), 200);
    constexpr int kDraws = 400;
    double sum = 0.0, square = 0.0;
    for (std::uint32_t seed = 0; seed < kDraws; ++seed) {
        UnifiedLightSettings s;
        s.lightcuts_most = 1;
        s.seed = seed;
        const double mean = mean_of(set.unified("lightcuts", s), 1);
        sum += mean / kDraws;
        square += mean * mean / kDraws;
    }
    const double error = std::sqrt((square - sum * sum) / (kDraws - 1));
    std::printf("cuts of one: %.4g +- %.2g, all lights: %.4g\n", sum, error, truth);
    EXPECT_NEAR(sum, truth, 4.0 * error + 0.02 * truth);
    EXPECT_GT(error, 0.0);
}

// Points of light that count as no nearer than some distance, around a point of the floor and in its plane: together
// those of a node never scatter more than its bound, and it is far below the bound of the boxes alone around the point.
void expect_bounds_of_nodes(const PathVertex& vertex, double loosest) {
    const dvec3 p = vertex.position();
    Rng rng(Stream::Points, 21);
    LightLimits limits;
    for (int i = 0; i < 400; ++i) {
        LightBounds b;
        const double height = i % 4 == 0 ? 0.0 : i % 4 == 1 ? -rng.next_double() : 2.0 * rng.next_double();
        b.low = b.high = p + dvec3(4.0 * rng.next_double() - 2.0, 4.0 * rng.next_double() - 2.0, height);
        b.spread = kPi64;
        b.reach = kPi64 / 2.0;
        b.intensity = rng.next_double();
        limits.bounds.push_back(b);
        limits.least2.push_back(0.01 + 0.1 * rng.next_double());
    }
    const LightTree tree(limits.bounds);
    const std::vector<NodeLimit> of_nodes = limits_of_nodes(tree, limits);
    const VertexBounds tight(tree, vertex, 0.0, of_nodes), loose(tree, vertex, 0.0);
    std::vector<double> scattered(tree.node_count());
    for (auto node = static_cast<std::uint32_t>(tree.node_count()); node-- > 0;) {
        if (tree.is_leaf(node)) {
            const std::size_t light = tree.light(node);
            const dvec3 offset = limits.bounds[light].low - p;
            const double distance2 = glm::dot(offset, offset);
            scattered[node] = double(luminance(vertex.at(offset / std::sqrt(distance2)).value)) *
                              limits.bounds[light].intensity / std::max(distance2, limits.least2[light]);
        } else {
            scattered[node] = scattered[tree.left(node)] + scattered[tree.right(node)];
        }
        EXPECT_LE(scattered[node], tight.of(node).largest() * (1.0 + 1e-6)) << node;
        EXPECT_LE(tight.of(node).largest(), loose.of(node).largest() * (1.0 + 1e-6)) << node;
    }
    EXPECT_LT(tight.of(0).largest(), loosest * loose.of(0).largest());
}

TEST(UnifiedLights, NodesBoundWhatTheirLightsScatter) {
    const LitSet set(small_fire(1.0f), floor_and_wall(0.0f), {}, 0);
    expect_bounds_of_nodes(set.vertex({0.5, 0.5, 0.0}), 1e-3);
}

// Seen from the side, where lobes are at grazing angles.
TEST(UnifiedLights, NodesBoundWhatTheirLightsScatterOnGloss) {
    for (const float roughness : {0.1f, 0.4f, 1.0f})
        for (const float metallic : {0.0f, 1.0f})
            for (const double down : {-1.0, -0.3, -0.03}) {
                SurfacePoint point;
                point.geometric_normal = {0.0, 0.0, 1.0};
                point.frame = frame_around(point.geometric_normal);
                point.material = lambert(0.6f).surface;
                point.material.specular = 1.0f;
                point.material.metallic = metallic;
                point.material.roughness = roughness;
                expect_bounds_of_nodes(
                    PathVertex(point, glm::normalize(dvec3(std::sqrt(1.0 - down * down), 0.1, down))), 1e-2);
            }
}

// One lamp, which every sampling has to find without noise.
TEST(UnifiedLights, OneLampHasItsClosedForm) {
    Scene floor;
    add_quad(floor, {-4, -4, -1.6f}, {8, 0, 0}, {0, 8, 0}, lambert(0.6f));
    Recipe dark = small_fire(0.0f);
    dark.settings.fire.model = FireModel::None;
    dark.density = [](const ivec3&) { return 0.0f; };
    LightSettings lamp;
    lamp.position = {0.0, 0.0, 0.4};
    lamp.power = Rgb(2.0f);
    const LitSet set(dark, std::move(floor), {lamp}, 0);
    const dvec3 u(0.8, 0.5, 0.0);
    const PathVertex v = set.vertex(u);
    const dvec3 p = v.position();
    const double height = 2.0, distance2 = height * height + p.x * p.x + p.y * p.y;
    const double expected = 0.6 / kPi64 * 2.0 * height / std::pow(distance2, 1.5);
    for (const UnifiedLightSampling& row : unified_light_samplings()) {
        const UnifiedLights unified = set.unified(row.name, {});
        EXPECT_EQ(unified.lights().size(), 1u);
        Rng rng = unified.rng(0, 0);
        const LightBySender light = unified.at({v, &v}, rng);
        EXPECT_NEAR(light.emitters.x, expected, 1e-5 * expected) << row.name;
        EXPECT_EQ(light.fire, Rgb(0.0f));
        EXPECT_EQ(light.surfaces, Rgb(0.0f));
    }
}

TEST(UnifiedLights, WithoutLightsAreBlack) {
    const LitSet set(small_fire(1.0f), floor_and_wall(0.0f), lamp_sun_and_sky(), 0);
    const PathVertex v = set.vertex({0.5, 0.5, 0.0});
    for (const UnifiedLightSampling& row : unified_light_samplings()) {
        const UnifiedLights none = set.unified(row.name, {}, {});
        EXPECT_EQ(none.lights().size(), 0u);
        Rng rng = none.rng(0, 0);
        EXPECT_EQ(luminance(none.at({v, &v}, rng)), 0.0f) << row.name;
    }
}

// Variance of the sum at some points of the floor, of twelve lights: a cut of all kinds, and one of four for each kind.
TEST(UnifiedLights, ShareSamplesOutByWhatShines) {
    struct Case {
        const char* name;
        float fire, ceiling;
    };
    for (const Case& c : {Case{"fire", 30.0f, 0.002f}, Case{"ceiling", 0.01f, 1.0f}}) {
        Scene scene = floor_and_wall(0.0f);
        add_ceiling(scene, 12, c.ceiling);
        const LitSet set(small_fire(c.fire), std::move(scene));
        UnifiedLightSettings of_all, of_each;
        of_all.stochastic_cut_size = 12;
        of_each.stochastic_cut_size = 4;
        const UnifiedLights all = set.unified("stochastic_lightcuts", of_all),
                            surfaces = set.unified("stochastic_lightcuts", of_each, {Cell::SS}),
                            fire = set.unified("stochastic_lightcuts", of_each, {Cell::SV}),
                            emitters = set.unified("stochastic_lightcuts", of_each, {Cell::SA});
        const auto variance = [&](const std::vector<const UnifiedLights*>& parts) {
            double out = 0.0;
            for (const double x : {0.2, 0.5, 0.8}) {
                const PathVertex v = set.vertex({x, 0.4, 0.0}), b = set.base({x, 0.4, 0.0});
                out += relative_variance(3000, [&](std::uint64_t i) {
                    double light = 0.0;
                    std::uint32_t number = 0;
                    for (const UnifiedLights* part : parts) {
                        Rng rng = part->rng(number++, i);
                        light += luminance(part->at({v, &b}, rng));
                    }
                    return light;
                });
            }
            return out;
        };
        const double together = variance({&all}), apart = variance({&surfaces, &fire, &emitters});
        std::printf("%s dominates: relative variance together %.3g, apart %.3g\n", c.name, together, apart);
        EXPECT_LT(together, 0.75 * apart) << c.name;
    }
}

}  // namespace
}  // namespace brisance
