// What rays from surfaces see of a medium, against closed forms and against rays of the camera.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "camera_rays/integrate.h"
#include "camera_rays/secondary_field.h"
#include "core/rng.h"
#include "fixtures/media.h"

namespace brisance {
namespace {

using testing::cubic;
using testing::make_medium;
using testing::Recipe;

// 64 voxels of 0.1 m along z, without ends that a ray inside it could meet.
Medium even_smoke(double voxel_depth) {
    Recipe r;
    r.box = {ivec3(-8, -8, 0), ivec3(8, 8, 64)};
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings = testing::black_smoke();
    r.settings.smoke.extinction_per_metre = static_cast<float>(voxel_depth / 0.1);
    return make_medium(r);
}

Medium uneven_smoke() {
    Recipe r;
    r.box = testing::cube(-20, 20);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3& n) {
        return testing::ball(n, dvec3(0.0), 16.0) * float(0.2 + std::pow(testing::noise(n, 1), 4.0));
    };
    r.flame = [](const ivec3& n) { return testing::ball(n, dvec3(3.0, 0.0, 0.0), 9.0); };
    r.settings.smoke.extinction_per_metre = 12.0f;
    r.settings.smoke.albedo = Rgb(0.6f);
    return make_medium(r);
}

dvec3 any_direction(Rng& rng) {
    const double z = 2.0 * rng.next_double() - 1.0, turn = 2.0 * std::numbers::pi * rng.next_double(),
                 r = std::sqrt(1.0 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
}

TEST(SecondaryField, OfASourceThatRisesAlongTheRayIsExactInEvenSmoke) {
    for (const double voxel : {1e-4, 1e-2, 0.2, 1.0, 10.0, 1e3}) {
        const Medium medium = even_smoke(voxel);
        NodeSources sources;
        for (std::size_t i = 0; i < medium.lattice.node_count(); ++i)
            sources.single.push_back(Rgb(static_cast<float>(medium.lattice.node(i).z * 0.1)));
        const SourceField field(medium, sources);
        const SecondaryField secondary(field);
        const double from = 0.53, length = 4.94, sigma = voxel / 0.1, depth = sigma * length;
        const SecondaryField::Seen seen =
            secondary.along({dvec3(medium.local_of_world({0.013, 0.027, from})), {0, 0, 1}}, length);
        // int_0^L sigma exp(-sigma z) (from + z) dz
        const double exact = -from * std::expm1(-depth) + (1.0 - (1.0 + depth) * std::exp(-depth)) / sigma;
        EXPECT_NEAR(seen.scattered.x / exact, 1.0, depth < 1e-2 ? 1e-4 : 1e-3) << "a voxel's depth: " << voxel;
        EXPECT_NEAR(seen.transmittance, std::exp(-depth), 1.1e-5 + 1e-4 * std::exp(-depth));
        EXPECT_EQ(seen.emission, Rgb(0.0f));
    }
}

TEST(SecondaryField, ShowsWhatTheCameraSees) {
    const Medium medium = uneven_smoke();
    NodeSources sources;
    for (std::size_t i = 0; i < medium.lattice.node_count(); ++i) {
        const ivec3 node = medium.lattice.node(i);
        sources.single.push_back(Rgb(float(testing::noise(node, 2)), 1.0f, 0.5f));
        sources.multiple.push_back(Rgb(0.3f, float(testing::noise(node, 3)), 0.1f));
        sources.from_emitters.push_back(Rgb(0.2f));
        sources.from_surfaces.push_back(Rgb(0.1f, 0.2f, 0.3f));
    }
    sources.emitters_at_nodes = 0.25f;
    const SourceField field(medium, sources);
    const SecondaryField secondary(field);
    Rgb emission(0.0f), scattered(0.0f), emission_exact(0.0f), scattered_exact(0.0f);
    double through = 0.0, through_exact = 0.0;
    for (int i = 0; i < 500; ++i) {
        Rng rng(Stream::Path, i);
        const dvec3 from = 2.5 * any_direction(rng), toward = 0.8 * any_direction(rng);
        const Ray ray{from, glm::normalize(toward - from)};
        const double end = 5.0 * rng.next_double();
        const SecondaryField::Seen seen = secondary.along(ray, end);
        const RaySum sum = integrate(field, ray, 8, {end});
        emission += seen.emission;
        emission_exact += sum.cells.at(Cell::V);
        scattered += seen.scattered;
        for (const Cell cell : {Cell::MV, Cell::MM, Cell::MS, Cell::MA})
            scattered_exact += sum.cells.at(cell);
        through += seen.transmittance;
        through_exact += sum.through;
    }
    ASSERT_GT(emission_exact.y, 0.0f);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(emission[c] / emission_exact[c], 1.0, 0.01);
        EXPECT_NEAR(scattered[c] / scattered_exact[c], 1.0, 0.01);
    }
    EXPECT_NEAR(through / through_exact, 1.0, 0.005);
}

}  // namespace
}  // namespace brisance
