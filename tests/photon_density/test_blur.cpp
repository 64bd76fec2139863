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

// A cube from -1 to 1 in steps of 0.1, whose smoke fades out over one more: as deep as two metres and a tenth.
constexpr double kEdge = 1.1, kDepth = 2.1;

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

// An eye in the direction from which rays along x come.
const dvec3 kFar(-1e4, 0.0, 0.0);

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

TEST(Extinction, IsTheMeanOverBallsAndDiscs) {
    const dvec3 axis = glm::normalize(dvec3(0.2, -0.5, 0.7));
    const Medium even = haze(2.0f);
    const TrackingField field(even);
    EXPECT_NEAR(extinction_in_ball(field, dvec3(0.1, -0.2, 0.3), 0.4), 2.0, 1e-5);
    EXPECT_NEAR(extinction_in_disc(field, dvec3(0.1, -0.2, 0.3), axis, 0.4), 2.0, 1e-5);
    const Medium rising = cube_of(1.0f, [](const ivec3& n) { return 20.0f + n.x + 0.5f * n.y - 0.3f * n.z; });
    const TrackingField slope(rising);
    const dvec3 p(0.13, -0.21, 0.17);
    EXPECT_NEAR(extinction_in_ball(slope, p, 0.5), 20.0 + 1.3 - 1.05 - 0.51, 1e-3);
    EXPECT_NEAR(extinction_in_disc(slope, p, axis, 0.5), 20.0 + 1.3 - 1.05 - 0.51, 1e-3);
    // A square, but for its interpolation, which adds h^2 / 6: the second moments are r^2 / 7 and r^2 / 6.
    const Medium bowl = cube_of(1.0f, [](const ivec3& n) { return 1.0f + 0.01f * float(n.x * n.x); });
    const TrackingField curved(bowl);
    EXPECT_NEAR(extinction_in_ball(curved, dvec3(0.0), 0.7), 1.0 + 0.49 / 7.0 + 0.01 / 6.0, 2e-3);
    EXPECT_NEAR(extinction_in_disc(curved, dvec3(0.0), {0, 0, 1}, 0.7), 1.0 + 0.49 / 6.0 + 0.01 / 6.0, 2e-3);
    EXPECT_NEAR(extinction_in_disc(curved, dvec3(0.0), {1, 0, 0}, 0.7), 1.0, 1e-6);
    // On the face of the smoke a half is outside.
    const dvec3 on_face(0.0, 0.3, 0.5 * kDepth);
    EXPECT_NEAR(extinction_in_ball(field, on_face, 0.5), 1.0, 0.1);
    EXPECT_NEAR(extinction_in_disc(field, on_face, {1, 0, 0}, 0.5), 1.0, 0.1);
    EXPECT_NEAR(extinction_in_disc(field, dvec3(0.0, 0.3, 0.99), {0, 0, 1}, 0.5), 2.0, 1e-5);
}

// Photons that collide evenly all over the haze, of parallel light whose irradiance is E(y) = 1 + bend y^2.
std::vector<PhotonFlight> collisions(double extinction, const dvec3& direction, double bend, int count) {
    std::vector<PhotonFlight> flights;
    Rng rng(Stream::Points, 21);
    for (int i = 0; i < count; ++i) {
        const dvec3 end = kEdge * (2.0 * dvec3(rng.next_double(), rng.next_double(), rng.next_double()) - 1.0);
        const dvec3 fades = glm::clamp((kEdge - glm::abs(end)) / 0.1, 0.0, 1.0);
        const double power =
            extinction * fades.x * fades.y * fades.z * std::pow(2.0 * kEdge, 3) / count * (1.0 + bend * end.y * end.y);
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

// Single scattering of the light at y = 0 in haze of extinction s and depth d: albedo p (1 - exp(-s d)); a bend of the
// irradiance adds bend r^2 / (4 + dimensions).
void expect_closed_form(const Shown& shown, double extinction, double cosine, double bias, const char* what) {
    const double expected = kAlbedo * henyey_greenstein(float(cosine), kG) * -std::expm1(-kDepth * extinction);
    std::printf("%s: %.5f +- %.2g %%, closed form %.5f with the blur's %+.2f %%\n", what, shown.mean / expected,
                100.0 * shown.error / expected, 1.0 + bias, 100.0 * bias);
    EXPECT_NEAR(shown.mean / expected, 1.0 + bias, kSigmas * shown.error / expected + 1e-3) << what;
    EXPECT_LT(shown.error / expected, 0.02) << what << ": not sampled enough";
}

TEST(Blur, PointsShowParallelLight) {
    constexpr float kExtinction = 0.3f;
    const Medium medium = haze(kExtinction);
    const TrackingField field(medium);
    const dvec3 direction = glm::normalize(dvec3(-0.4, 0.5, 0.6));
    for (const double radius : {0.25, 0.5})
        for (const double bend : {0.0, 3.0}) {
            const auto all = collisions(kExtinction, direction, bend, 160'000);
            for (const bool discs : {true, false})
                expect_closed_form(
                    shown_along_x(field,
                                  [&](const RayMedium& seen, int set) {
                                      const PhotonPoints points(field, part_of(all, set, 16), radius, discs, kFar);
                                      Rng rng(Stream::Points, std::uint64_t(set));
                                      double mean = 0.0;
                                      for (int i = 0; i < (discs ? 1 : 16); ++i)
                                          mean += (discs ? points.along(seen, kG) : points.around(seen, kG, rng)).x;
                                      return mean / (discs ? 1 : 16);
                                  }),
                    kExtinction, -direction.x, bend * radius * radius / (discs ? 6.0 : 7.0), discs ? "discs" : "balls");
        }
}

TEST(Blur, BeamsShowParallelLight) {
    constexpr float kExtinction = 0.6f;
    const Medium medium = haze(kExtinction);
    const TrackingField field(medium);
    for (const dvec3& direction : {dvec3(0.0, 0.0, 1.0), glm::normalize(dvec3(0.5, 0.0, -1.0))})
        for (const double radius : {0.2, 0.4})
            for (const double bend : {0.0, 3.0}) {
                const auto all = parallel_beams(direction, bend, 64'000);
                const Shown shown = shown_along_x(field, [&](const RayMedium& seen, int set) {
                    return double(PhotonBeams(part_of(all, set, 16), radius, 1.0).along(seen, kG).x);
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
        const PhotonPoints points(field, one, 0.25, true, kFar);
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
        EXPECT_NEAR(all / expected, 1.0, at.x == 0.0 ? 0.01 : 0.1);
    }
}

}  // namespace
}  // namespace brisance
