// Rays and triangles: no leaks and no self-intersections, at any scale and far from the origin.
#include <gtest/gtest.h>

#include <cmath>

#include "core/parallel.h"
#include "core/rng.h"
#include "fixtures/sets.h"
#include "geometry/surface_point.h"

namespace brisance {
namespace {

using namespace testing;

dvec3 uniform_direction(Rng& rng) {
    const double z = 1.0 - 2.0 * rng.next_double(), azimuth = 6.283185307179586 * rng.next_double();
    const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
    return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

TEST(Intersector, NothingIsBuiltForNothing) {
    const Scene scene;
    const Intersector intersector(scene);
    EXPECT_TRUE(intersector.empty());
    EXPECT_EQ(intersector.bytes(), 0u);
    EXPECT_FALSE(intersector.first_hit({dvec3(0.0), dvec3(0, 0, 1)}));
    EXPECT_FALSE(intersector.occluded({dvec3(0.0), dvec3(0, 0, 1)}));
}

TEST(Intersector, HitsLieWhereTheyShould) {
    Scene scene;
    add_quad(scene, {-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, lambert(0.5f));
    const Intersector intersector(scene);
    const auto hit = intersector.first_hit({dvec3(0.25, -0.5, 0.0), dvec3(0, 0, 1)});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance, 2.0, 1e-6);
    const SurfacePoint point = surface_point(scene, *hit, dvec3(0, 0, -1));
    EXPECT_NEAR(glm::distance(point.position, dvec3(0.25, -0.5, 2.0)), 0.0, 1e-6);
    EXPECT_FALSE(intersector.first_hit({dvec3(0.25, -0.5, 0.0), dvec3(0, 0, 1)}, 1.9)) << "ends before it";
    EXPECT_TRUE(intersector.occluded({dvec3(0.25, -0.5, 0.0), dvec3(0, 0, 1)}, 2.1));
    EXPECT_FALSE(intersector.first_hit({dvec3(1.5, 0.0, 0.0), dvec3(0, 0, 1)})) << "beside it";
}

// Scale of the set [m], and how far from the local origin it stands, in its own size.
struct ScaleAndOffset {
    float scale, away;
};

class AtAnyScale : public ::testing::TestWithParam<ScaleAndOffset> {
protected:
    vec3 centre() const { return GetParam().scale * GetParam().away * vec3(0.6f, -0.64f, 0.48f); }
};

// From everywhere on the inside of a closed mesh a ray must find the mesh, farther off than rounding.
TEST_P(AtAnyScale, ClosedMeshesHoldTheirRays) {
    Scene scene;
    add_ball(scene, centre(), GetParam().scale, 24, lambert(0.5f));
    const Intersector intersector(scene);
    Rng rng(Stream::Points, 1);
    dvec3 from(centre());
    int lost = 0;
    for (int i = 0; i < 100000; ++i) {
        const dvec3 d = uniform_direction(rng);
        const auto hit = intersector.first_hit({from, d});
        if (!hit) {
            ++lost;
            from = dvec3(centre());
            continue;
        }
        const SurfacePoint point = surface_point(scene, *hit, -d);
        // On along the inside, any direction of the hemisphere.
        dvec3 on = uniform_direction(rng);
        if (glm::dot(on, point.geometric_normal) > 0.0)
            on = -on;
        from = point.leaving(on).origin;
    }
    EXPECT_EQ(lost, 0);
}

// A convex body throws no shadow on itself.
TEST_P(AtAnyScale, SurfacesDoNotMeetThemselves) {
    for (const bool round : {false, true}) {
        Scene scene;
        const float s = GetParam().scale;
        if (round)
            add_ball(scene, centre(), s, 24, lambert(0.5f));
        else
            add_box(scene, centre() - s, centre() + s, lambert(0.5f));
        const Intersector intersector(scene);
        Rng rng(Stream::Points, 2);
        int met = 0, tested = 0;
        for (int i = 0; i < 30000; ++i) {
            const dvec3 inward = uniform_direction(rng);
            const auto hit = intersector.first_hit({dvec3(centre()) - 3.0 * double(s) * inward, inward});
            if (!hit)
                continue;
            const SurfacePoint point = surface_point(scene, *hit, -inward);
            for (int k = 0; k < 4; ++k) {
                dvec3 d = uniform_direction(rng);
                // Grazing directions are the hard ones.
                if (k % 2)
                    d = glm::normalize(d - (1.0 - 1e-3) * glm::dot(d, point.geometric_normal) * point.geometric_normal);
                if (glm::dot(d, point.geometric_normal) < 0.0)
                    d = -d;
                ++tested;
                met += intersector.occluded(point.leaving(d));
            }
        }
        EXPECT_GT(tested, 50000);
        EXPECT_EQ(met, 0) << (round ? "ball" : "box");
    }
}

// The gap between a wall and what stands a thousandth of its size in front of it lets light in.
TEST_P(AtAnyScale, NearSurfacesAreStillApart) {
    Scene scene;
    const float s = GetParam().scale, gap = 1e-3f * s;
    add_quad(scene, centre() + vec3(-s, -s, 0), {2 * s, 0, 0}, {0, 2 * s, 0}, lambert(0.5f));
    add_quad(scene, centre() + vec3(-s, -s, gap), {2 * s, 0, 0}, {0, 2 * s, 0}, lambert(0.5f));
    const Intersector intersector(scene);
    const dvec3 up(0, 0, 1);
    const auto hit = intersector.first_hit({dvec3(centre()) - up * double(s), up});
    ASSERT_TRUE(hit);
    const SurfacePoint point = surface_point(scene, *hit, up);
    const auto next = intersector.first_hit(point.leaving(up));
    ASSERT_TRUE(next);
    EXPECT_EQ(next->mesh, 1u);
}

INSTANTIATE_TEST_SUITE_P(Intersector, AtAnyScale,
                         ::testing::Values(ScaleAndOffset{1.0f, 0.0f}, ScaleAndOffset{1e-6f, 0.0f},
                                           ScaleAndOffset{1e6f, 0.0f}, ScaleAndOffset{1.0f, 100.0f},
                                           ScaleAndOffset{1e-3f, 100.0f}, ScaleAndOffset{1e3f, 30.0f}));

// any_within() must find every surface that a ray hits within the radius. Inside a mesh of a ball it may report few
// surfaces that are farther away.
TEST_P(AtAnyScale, NothingNearIsOverlooked) {
    const double size = GetParam().scale;
    Scene scene;
    add_ball(scene, centre(), GetParam().scale, 24, lambert(0.5f));
    add_quad(scene, centre() + GetParam().scale * vec3(-2.0f, -2.0f, -1.4f), GetParam().scale * vec3(4, 0, 1.3f),
             GetParam().scale * vec3(0, 4, 0.4f), lambert(0.5f));
    const Intersector intersector(scene);
    Rng rng(Stream::Points, 5);
    int found = 0, far = 0, said_near = 0;
    for (int i = 0; i < 20000; ++i) {
        const dvec3 point = dvec3(centre()) + 2.5 * size * rng.next_double() * uniform_direction(rng);
        const double radius = size * rng.next_double() * rng.next_double();
        const bool near = intersector.any_within(point, radius);
        bool hit = false;
        for (int k = 0; k < 8 && !hit; ++k)
            hit = intersector.first_hit({point, uniform_direction(rng)}, radius).has_value();
        EXPECT_TRUE(near || !hit) << "a surface is hit within " << radius;
        found += hit;
        const double from_ball = glm::distance(point, dvec3(centre())) / size;
        if (from_ball < 0.9 && from_ball + radius / size < 0.9 && point.z > centre().z + 0.5 * size) {
            ++far;
            said_near += near;
        }
    }
    EXPECT_GT(found, 1000);
    ASSERT_GT(far, 50);
    EXPECT_LT(said_near, far / 10) << "nothing is gained";
}

// Of coincident faces every intersector finds the same one.
TEST(Intersector, CoincidentFacesAreOneSurface) {
    Scene scene;
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, lambert(0.2f));
    add_quad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, lambert(0.8f));
    const Intersector a(scene), b(scene);
    Rng rng(Stream::Points, 3);
    for (int i = 0; i < 1000; ++i) {
        const Ray ray{dvec3(1.9 * rng.next_double() - 0.95, 1.9 * rng.next_double() - 0.95, 1.0), dvec3(0, 0, -1)};
        const auto hit = a.first_hit(ray), again = b.first_hit(ray);
        ASSERT_TRUE(hit && again);
        EXPECT_EQ(hit->mesh, again->mesh);
        const SurfacePoint point = surface_point(scene, *hit, dvec3(0, 0, 1));
        EXPECT_FALSE(a.occluded(point.leaving(dvec3(0, 0, 1)))) << "its twin throws no shadow on it";
    }
}

TEST(Intersector, AnswersDoNotDependOnThreads) {
    Scene scene;
    add_ball(scene, {0, 0, 0}, 1.0f, 64, lambert(0.5f));
    const auto answers = [&](int threads) {
        const ThreadLimit limit(threads);
        const Intersector intersector(scene);
        std::vector<double> found;
        Rng rng(Stream::Points, 4);
        for (int i = 0; i < 20000; ++i) {
            const dvec3 d = uniform_direction(rng);
            const auto hit = intersector.first_hit({0.5 * uniform_direction(rng), d});
            found.push_back(hit ? hit->distance + hit->triangle : -1.0);
        }
        return found;
    };
    EXPECT_EQ(answers(1), answers(2));
    EXPECT_EQ(answers(1), answers(8));
}

// One quad whose texture is opaque on its left half.
Scene half_there(AlphaMode mode, std::uint8_t alpha) {
    Scene scene;
    SceneMaterial material = lambert(0.5f);
    material.alpha_mode = mode;
    material.base_colour.texture = 0;
    add_quad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, material);
    scene.meshes[0].uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    Texture texture;
    texture.width = 2;
    texture.height = 1;
    texture.nearest = true;
    texture.bytes = {255, 255, 255, 255, 255, 255, 255, alpha};
    scene.textures.push_back(std::make_shared<const Texture>(texture));
    return scene;
}

TEST(Intersector, CutOutsLetRaysThrough) {
    const Scene scene = half_there(AlphaMode::Mask, 0);
    const Intersector intersector(scene);
    for (const double y : {0.1, 0.5, 0.9}) {
        const Ray left{dvec3(0.25, y, 1.0), dvec3(0, 0, -1)}, right{dvec3(0.75, y, 1.0), dvec3(0, 0, -1)};
        EXPECT_TRUE(intersector.first_hit(left) && intersector.occluded(left));
        EXPECT_FALSE(intersector.first_hit(right) || intersector.occluded(right));
    }
}

TEST(Intersector, BlendsLetThroughInProportion) {
    const Scene scene = half_there(AlphaMode::Blend, 64);
    const Intersector intersector(scene);
    Rng rng(Stream::Points, 5);
    const int n = 40000;
    int stopped = 0;
    for (int i = 0; i < n; ++i) {
        const Ray ray{dvec3(0.51 + 0.48 * rng.next_double(), rng.next_double(), 1.0), dvec3(0, 0, -1)};
        stopped += intersector.occluded(ray);
        EXPECT_EQ(intersector.occluded(ray), intersector.first_hit(ray).has_value());
    }
    const double alpha = 64.0 / 255.0, error = std::sqrt(alpha * (1.0 - alpha) / n);
    EXPECT_NEAR(double(stopped) / n, alpha, 4.0 * error) << "four standard errors";
}

}  // namespace
}  // namespace brisance
