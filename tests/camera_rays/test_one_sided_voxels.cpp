// Smoke in front of the surface that ends a ray shows the light of that surface's near side.
#include <gtest/gtest.h>

#include <cmath>

#include "camera_rays/integrate.h"
#include "fixtures/media.h"

namespace brisance {
namespace {

using testing::cubic;
using testing::make_medium;
using testing::Recipe;

constexpr float kNear = 2.0f, kFar = 50.0f;

// Even smoke that glows.
Medium even_smoke() {
    Recipe r;
    r.box = testing::cube(-16, 16);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3&) { return 1.0f; };
    r.flame = [](const ivec3&) { return 1.0f; };
    r.settings.smoke.extinction_per_metre = 1.0f;
    r.settings.smoke.albedo = Rgb(0.5f);
    return make_medium(r);
}

// Through a point in the smoke, up to a plane there.
struct LookThrough {
    Ray ray;
    RayEnd end;
    dvec3 through;  // local [m]
};

LookThrough look_through(const Medium& medium, const dvec3& direction, const dvec3& normal) {
    const dvec3 unit = glm::normalize(direction), plane = glm::normalize(normal);
    const dvec3 through = dvec3(medium.local_of_world({0.013, -0.027, 0.041}));
    return {{through - 9.0 * unit, unit}, {9.0, glm::dot(plane, unit) < 0.0 ? plane : -plane}, through};
}

// Light of all kinds on either side of the plane.
NodeSources two_sides(const Medium& medium, const LookThrough& at) {
    NodeSources out;
    for (std::size_t i = 0; i < medium.lattice.node_count(); ++i) {
        const dvec3 node(medium.local_of_node(medium.lattice.node(i)));
        const Rgb light(glm::dot(node - at.through, at.end.normal) > 0.0 ? kNear : kFar);
        out.single.push_back(light);
        out.multiple.push_back(2.0f * light);
        out.from_surfaces.push_back(3.0f * light);
        out.from_emitters.push_back(4.0f * light);
    }
    return out;
}

const dvec3 kDirections[] = {{0, 0, -1}, {1, 2, -3}, {-4, 1, -0.3}, {0.2, -0.1, 5}};
const dvec3 kNormals[] = {{0, 0, 1}, {0.3, -0.2, 1}, {-0.5, 0.4, 0.45}, {1, 1, 1}};

TEST(OneSidedVoxels, ShowNothingOfTheFarSide) {
    const Medium medium = even_smoke();
    for (const dvec3& direction : kDirections)
        for (const dvec3& normal : kNormals) {
            const LookThrough at = look_through(medium, direction, normal);
            const NodeSources sources = two_sides(medium, at);
            const SourceField field(medium, sources);
            const RaySum sum = integrate(field, at.ray, 2, at.end);
            const double opacity = -std::expm1(-double(sum.depth));
            EXPECT_NEAR(sum.cells.at(Cell::MV).x / opacity, kNear, 1e-3 * kNear);
            EXPECT_NEAR(sum.cells.at(Cell::MM).x / opacity, 2.0f * kNear, 2e-3 * kNear);
            EXPECT_NEAR(sum.cells.at(Cell::MS).x / opacity, 3.0f * kNear, 3e-3 * kNear);
            EXPECT_NEAR(sum.cells.at(Cell::MA).x / opacity, 4.0f * kNear, 4e-3 * kNear);
        }
}

// What absorbs and glows is there whatever stands in it. Without a normal the ray sees through the surface.
TEST(OneSidedVoxels, ChangeNeitherSmokeNorFire) {
    const Medium medium = even_smoke();
    const LookThrough at = look_through(medium, {1, 2, -3}, {0.3, -0.2, 1});
    const NodeSources sources = two_sides(medium, at);
    const SourceField field(medium, sources);
    const RaySum with = integrate(field, at.ray, 2, at.end), without = integrate(field, at.ray, 2, {at.end.distance});
    EXPECT_NEAR(with.depth, without.depth, 1e-5 * without.depth);
    EXPECT_NEAR(with.cells.at(Cell::V).x, without.cells.at(Cell::V).x, 1e-5 * without.cells.at(Cell::V).x);
    EXPECT_GT(without.cells.at(Cell::MV).x, 1.02f * with.cells.at(Cell::MV).x);
}

// Forward peaks have a medium of their own, and rays another way through it.
TEST(OneSidedVoxels, AreSoBesideASimilarMedium) {
    const Medium medium = even_smoke(), similar = even_smoke();
    for (const dvec3& normal : kNormals) {
        const LookThrough at = look_through(medium, {1, 2, -3}, normal);
        const NodeSources sources = two_sides(medium, at);
        const SourceField field(medium, sources, &similar, 0.0f);
        const RaySum sum = integrate(field, at.ray, 2, at.end);
        const double opacity = -std::expm1(-double(sum.similar_depth));
        EXPECT_NEAR(sum.cells.at(Cell::MM).x / opacity, 2.0f * kNear, 2e-3 * kNear);
        EXPECT_NEAR(sum.cells.at(Cell::MS).x / opacity, 3.0f * kNear, 3e-3 * kNear);
    }
}

// A surface far away or behind all smoke takes no light from it.
TEST(OneSidedVoxels, LeaveSmokeBeforeTheSurfaceAsItIs) {
    const Medium medium = even_smoke();
    LookThrough at = look_through(medium, {0, 0, -1}, {0, 0, 1});
    const NodeSources sources = two_sides(medium, at);
    const SourceField field(medium, sources);
    at.end.distance = 20.0;
    const RaySum with = integrate(field, at.ray, 2, at.end), without = integrate(field, at.ray, 2);
    EXPECT_EQ(with.cells.at(Cell::MV), without.cells.at(Cell::MV));
}

}  // namespace
}  // namespace brisance
