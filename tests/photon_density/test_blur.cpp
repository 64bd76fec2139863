// Photons that are laid out by hand in even haze: what they show along a ray has a closed form, and so has the bias of
// the blur.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "fixtures/media.h"
#include "fixtures/ray_fixture.h"
#include "medium/phase.h"
#include "photon_density/kernel.h"
#include "photon_density/photon_beams.h"
#include "photon_density/photon_points.h"

namespace brisance {
namespace {

using namespace testing;

constexpr float kG = 0.7f, kAlbedo = 0.5f;

// A cube from -1 to 1 in steps of 0.1.
Medium cube_of(float extinction, const NodeScalar& density) {
    Recipe r;
    r.box = cube(-10, 10);
    r.world_from_index = cubic(0.1);
    r.density = density;
    r.settings = black_smoke();
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = Rgb(kAlbedo);
    r.settings.smoke.mean_cosine = kG;
    return make_medium(r);
}

Medium haze(float extinction) {
    return cube_of(extinction, [](const ivec3&) { return 1.0f; });
}

RayMedium along(const TrackingField& field, const Ray& ray) {
    RayMedium seen;
    seen.look(field, ray, kNoEnd);
    return seen;
}

TEST(Kernel, IntegratesToOneAndHasItsSecondMoment) {
    constexpr int kSteps = 100'000;
    constexpr double kRadius = 0.3;
    const double shell[] = {2.0, 2.0 * kPi64, 4.0 * kPi64};  // of the ball's surface at radius 1
    for (int d = 1; d <= 3; ++d) {
        double whole = 0.0, second = 0.0;
        for (int i = 0; i < kSteps; ++i) {
            const double x = (i + 0.5) / kSteps * kRadius;
            const double kernel = d == 1   ? epanechnikov<1>(x * x, kRadius)
                                  : d == 2 ? epanechnikov<2>(x * x, kRadius)
                                           : epanechnikov<3>(x * x, kRadius);
            const double part = kernel * shell[d - 1] * std::pow(x, d - 1) * kRadius / kSteps;
            whole += part;
            second += part * x * x / d;
        }
        EXPECT_NEAR(whole, 1.0, 1e-6) << d;
        EXPECT_NEAR(second, kRadius * kRadius / (4.0 + d), 1e-6) << d;
    }
}

// The mean of a field over a ball that it fills, where it is linear; and at the face of a cube half of it.
TEST(ExtinctionAround, IsTheMeanOverTheBall) {
    const Medium even = haze(2.0f);
    const TrackingField field(even);
    EXPECT_NEAR(extinction_around(field, dvec3(0.1, -0.2, 0.3), 0.4), 2.0, 1e-5);
    EXPECT_NEAR(extinction_around(field, dvec3(0.0, 0.3, 0.9999), 0.5), 1.0, 0.1);
    const Medium rising = cube_of(1.0f, [](const ivec3& n) { return 20.0f + n.x + 0.5f * n.y - 0.3f * n.z; });
    const TrackingField slope(rising);
    const dvec3 p(0.13, -0.21, 0.17);
    EXPECT_NEAR(extinction_around(slope, p, 0.5), RayProbe(slope, {p, {1, 0, 0}}).at(0.0).extinction, 1e-4);
    EXPECT_NEAR(extinction_around(slope, p, 0.5), 20.0 + 1.3 - 1.05 - 0.51, 1e-3);
    // Quadratic but for its interpolation: the second moment of the kernel is r^2 / 7 along each axis.
    const Medium bowl = cube_of(1.0f, [](const ivec3& n) { return 1.0f + 0.01f * float(n.x * n.x); });
    const TrackingField curved(bowl);
    EXPECT_NEAR(extinction_around(curved, dvec3(0.0), 0.6), 1.0 + 0.36 / 7.0, 0.01);
}

// Photons that collide evenly all over the haze, of parallel light whose irradiance is E(y) = 1 + bend y^2.
std::vector<PhotonFlight> collisions(double extinction, const dvec3& direction, double bend, int count) {
    std::vector<PhotonFlight> flights;
    Rng rng(Stream::Points, 21);
    for (int i = 0; i < count; ++i) {
        const dvec3 end = 2.0 * dvec3(rng.next_double(), rng.next_double(), rng.next_double()) - 1.0;
        const double power = extinction * 8.0 / count * (1.0 + bend * end.y * end.y);
        flights.push_back({vec3(end - 0.5 * direction), vec3(direction), Rgb(float(power)), 0.5f, true});
    }
    return flights;
}

// Beams of the same light that cross the whole cube along z, or at an angle to it in the plane of x and z.
std::vector<PhotonFlight> parallel_beams(const dvec3& direction, double bend, int count) {
    std::vector<PhotonFlight> flights;
    Rng rng(Stream::Points, 22);
    for (int i = 0; i < count; ++i) {
        const dvec3 on_plane(6.0 * rng.next_double() - 3.0, 2.0 * rng.next_double() - 1.0, 0.0);
        const double power = 12.0 * std::abs(direction.z) / count * (1.0 + bend * on_plane.y * on_plane.y);
        flights.push_back({vec3(on_plane - 3.0 * direction), vec3(direction), Rgb(float(power)), 6.0f, false});
    }
    return flights;
}

struct Shown {
    double mean, error;
};

// By rays along x near the middle of the cube that share all photons, which a few parts of the photons tell the error
// of.
template <class Estimator>
Shown shown_along_x(const TrackingField& field, const Estimator& estimate_of) {
    constexpr int kSets = 16;
    double sum = 0.0, square = 0.0;
    for (int set = 0; set < kSets; ++set) {
        const RayMedium seen = along(field, {{-4.0, 0.0, 0.0}, {1.0, 0.0, 0.0}});
        const double v = estimate_of(seen, set);
        sum += v / kSets;
        square += v * v / kSets;
    }
    return {sum, std::sqrt((square - sum * sum) / (kSets - 1))};
}

template <class T>
std::vector<T> part_of(const std::vector<T>& all, int set, int sets) {
    std::vector<T> part;
    for (std::size_t i = std::size_t(set); i < all.size(); i += std::size_t(sets)) {
        part.push_back(all[i]);
        part.back().power *= float(sets);
    }
    return part;
}

// Single scattering of the light at y = 0 in haze of extinction s, along two metres: albedo p (1 - exp(-2 s)); a bend
// of the irradiance adds bend r^2 / (4 + dimensions).
void expect_closed_form(const Shown& shown, double extinction, double cosine, double bias, const char* what) {
    const double expected = kAlbedo * henyey_greenstein(float(cosine), kG) * -std::expm1(-2.0 * extinction);
    std::printf("%s: %.5f +- %.2g %%, closed form %.5f with the blur's %+.2f %%\n", what, shown.mean / expected,
                100.0 * shown.error / expected, 1.0 + bias, 100.0 * bias);
    EXPECT_NEAR(shown.mean / expected, 1.0 + bias, kSigmas * shown.error / expected + 1e-3) << what;
    EXPECT_LT(shown.error / expected, 0.02) << what << ": not sampled enough";
}

TEST(Blur, PointsShowParallelLight) {
    constexpr float kExtinction = 0.6f;
    const Medium medium = haze(kExtinction);
    const TrackingField field(medium);
    const dvec3 direction = glm::normalize(dvec3(-0.4, 0.5, 0.6));
    for (const double radius : {0.3, 0.6})
        for (const double bend : {0.0, 3.0}) {
            const auto all = collisions(kExtinction, direction, bend, 320'000);
            const Shown discs = shown_along_x(field, [&](const RayMedium& seen, int set) {
                return double(PhotonPoints(field, part_of(all, set, 16), radius).along(seen, kG).x);
            });
            expect_closed_form(discs, kExtinction, -direction.x, bend * radius * radius / 6.0, "discs");
            // Not at the ends of the ray, where balls reach beyond the cube's faces and find nothing.
            const Shown balls = shown_along_x(field, [&](const RayMedium& seen, int set) {
                Rng rng(Stream::Points, std::uint64_t(set));
                double mean = 0.0;
                const PhotonPoints points(field, part_of(all, set, 16), radius);
                for (int i = 0; i < 16; ++i)
                    mean += double(points.around(seen, kG, rng).x) / 16.0;
                return mean;
            });
            const double lit = balls.mean, error = balls.error;
            if (bend == 0.0)
                expect_closed_form({lit, error}, kExtinction, -direction.x, 0.0, "balls");
        }
}

TEST(Blur, BeamsShowParallelLight) {
    constexpr float kExtinction = 0.6f;
    const Medium medium = haze(kExtinction);
    const TrackingField field(medium);
    for (const dvec3& direction : {dvec3(0.0, 0.0, 1.0), glm::normalize(dvec3(0.5, 0.0, -1.0))})
        for (const double radius : {0.1, 0.4})
            for (const double bend : {0.0, 3.0}) {
                const auto all = parallel_beams(direction, bend, 160'000);
                const Shown shown = shown_along_x(field, [&](const RayMedium& seen, int set) {
                    return double(PhotonBeams(part_of(all, set, 16), radius, 0.25).along(seen, kG).x);
                });
                expect_closed_form(shown, kExtinction, -direction.x, bend * radius * radius / 5.0, "beams");
            }
}

// Where a beam is cut makes no difference.
TEST(Blur, PiecesAreTheirBeam) {
    const Medium medium = haze(0.6f);
    const TrackingField field(medium);
    const auto all = parallel_beams(glm::normalize(dvec3(0.3, 0.2, 1.0)), 1.0, 4000);
    const RayMedium seen = along(field, {{-3.0, 0.2, -0.1}, glm::normalize(dvec3(1.0, 0.1, 0.2))});
    const float whole = PhotonBeams(all, 0.1, 100.0).along(seen, kG).x;
    EXPECT_GT(whole, 0.0f);
    EXPECT_NEAR(PhotonBeams(all, 0.1, 0.07).along(seen, kG).x / whole, 1.0, 1e-4);
}

// A photon lights what smoke there is around it, however little, and keeps its energy: also at the skin, where half of
// its ball is outside, and in a wisp beside dense smoke.
TEST(Blur, PhotonsKeepTheirEnergy) {
    const Medium medium = cube_of(1e-4f, [](const ivec3& n) { return n.z > 5 ? 1.0f : 0.05f; });
    const TrackingField field(medium);
    const dvec3 direction(0.0, 0.0, 1.0);
    for (const dvec3& at : {dvec3(0.0), dvec3(0.1, 0.2, 0.97), dvec3(0.98, 0.03, 0.02), dvec3(0.1, 0.0, 0.5)}) {
        const std::vector<PhotonFlight> one = {{vec3(at - direction), vec3(direction), Rgb(1.0f), 1.0f, true}};
        const PhotonPoints points(field, one, 0.25);
        // All that its ball sends along x, through every place that the ray may take.
        double all = 0.0;
        constexpr int kSteps = 120;
        for (int i = 0; i < kSteps; ++i)
            for (int k = 0; k < kSteps; ++k) {
                const double y = at.y + 0.6 * ((i + 0.5) / kSteps - 0.5), z = at.z + 0.6 * ((k + 0.5) / kSteps - 0.5);
                const RayMedium seen = along(field, {{-3.0, y, z}, {1.0, 0.0, 0.0}});
                if (!seen.empty())
                    all += points.along(seen, kG).x * 0.36 / (kSteps * kSteps);
            }
        const double expected = kAlbedo * henyey_greenstein(0.0f, kG);
        std::printf("photon at z = %g: keeps %.3f of its energy\n", at.z, all / expected);
        EXPECT_NEAR(all / expected, 1.0, at.x == 0.0 ? 0.01 : 0.25);
    }
}

}  // namespace
}  // namespace brisance
