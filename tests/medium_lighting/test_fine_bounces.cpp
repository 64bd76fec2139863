// Bounces on the lattice of the light itself after a series on a coarser one: they take away what the coarse lattice
// errs by, and are the last of the orders where those are counted.
#include <gtest/gtest.h>

#include <cstdio>

#include "fixtures/media.h"
#include "layer_difference.h"
#include "render/render_frame.h"
#include "small_view.h"

namespace brisance {
namespace {

using namespace testing;

// Ragged smoke of 24 nodes across, of about half a mean free path to a voxel, around a fire; `mean_cosine` of its
// scattering.
Medium lumpy_smoke(float mean_cosine) {
    Recipe r;
    r.box = {ivec3(-12), ivec3(12)};
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3& n) { return ball(n, dvec3(0.0), 11.0) * (0.2f + 1.6f * noise(n >> 1, 1)); };
    r.flame = [](const ivec3& n) { return ball(n, dvec3(2.0, -3.0, 0.0), 4.0); };
    r.settings.smoke.extinction_per_metre = 5.0f;
    r.settings.smoke.albedo = Rgb(0.8f);
    r.settings.smoke.mean_cosine = mean_cosine;
    r.settings.fire.convention = EmissionConvention::Direct;
    return make_medium(r);
}

Image picture(const Medium& medium, int bounces, int lattice_level, int fine_bounces) {
    Shot shot = small_view(24);
    shot.scattering_methods.method = kLightingGridMethod;
    shot.scattering.bounces = bounces;
    shot.scattering.lattice_level = lattice_level;
    shot.scattering.fine_bounces = fine_bounces;
    Progress silent;
    return render_medium(shot, medium, silent).image;
}

TEST(FineBounces, TakeAwayMostOfWhatACoarseLatticeErrsBy) {
    for (const float mean_cosine : {0.0f, 0.4f}) {
        const Medium medium = lumpy_smoke(mean_cosine);
        const Image fine = picture(medium, -1, 0, 0), coarse = picture(medium, -1, 2, 0),
                    once = picture(medium, -1, 2, 1), twice = picture(medium, -1, 2, 2);
        const double error = layer_difference(coarse, fine, "MM"), left = layer_difference(once, fine, "MM"),
                     least = layer_difference(twice, fine, "MM");
        std::printf("g %.1f: coarse %.4f, one bounce %.4f, two %.4f\n", mean_cosine, error, left, least);
        EXPECT_GT(error, 0.04) << "the coarse lattice has to err";
        EXPECT_LT(left, 0.65 * error);
        EXPECT_LT(least, 0.8 * left);
    }
}

// The series may add 5/8 of lighting.error, and is on a coarser lattice than the light's own.
TEST(SeriesLattice, AddsNoMoreThanTheErrorAllows) {
    const Medium medium = lumpy_smoke(0.0f);
    const Image chosen = picture(medium, -1, -1, 1), fine = picture(medium, -1, 0, 0);
    const double added = layer_difference(chosen, fine);
    EXPECT_GT(added, 0.0);
    EXPECT_LT(added, 0.625 * 0.02);
}

// Of three scatterings the last is that toward the camera, and the fine bounce makes the second: nothing is left for
// the coarse lattice.
TEST(FineBounces, MakeTheLastOfCountedOrders) {
    const Medium medium = lumpy_smoke(0.0f);
    const Image one = picture(medium, 3, 1, 1), two = picture(medium, 3, 2, 1);
    EXPECT_EQ(one.layer("MM").pixels, two.layer("MM").pixels);
    EXPECT_GT(layer_difference(picture(medium, 3, 1, 0), picture(medium, 3, 2, 0), "MM"), 0.005)
        << "without it lattices differ";
    EXPECT_GT(layer_difference(picture(medium, 2, 1, 1), one, "MM"), 0.05) << "the third order counts";
}

}  // namespace
}  // namespace brisance
