// Transmittance and free flights, against the optical depth in closed form: sums over nodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fixtures/tracing_fixture.h"

namespace brisance {
namespace {

using namespace testing;

constexpr int kLong = 96;  // nodes along z

// Extinction by z alone, voxels of 1 m, in a pipe of 7 x 7 nodes around x = y = 4: along z its optical depth is the sum
// of the nodes.
Recipe pipe(const std::function<float(int)>& extinction) {
    Recipe r;
    r.box = {ivec3(0), ivec3(8, 8, kLong + 1)};
    r.world_from_index = cubic(1.0);
    r.density = [=](const ivec3& n) {
        return std::min({n.x, n.y, n.z}) > 0 && n.x < 8 && n.y < 8 && n.z <= kLong ? extinction(n.z) : 0.0f;
    };
    r.settings = black_smoke();
    return r;
}

struct OneDimensional {
    const char* name;
    std::function<float(int)> extinction;
    double marched;  // relative standard error that ray marching is sampled to; 0: its variance has no useful bound
};

// All but two of optical depth 6.6 or so: what 0.1 % of the light gets through.
const OneDimensional kPipes[] = {
    {"even", [](int) { return 0.07f; }, kSharp},
    {"thin", [](int z) { return z % 2 ? 2e-4f : 0.0f; }, kSharp},
    {"spikes", [](int z) { return z % 12 == 5 ? 0.8f : 0.002f; }, kSharp},
    {"noise", [](int z) { return 0.35f * std::pow(testing::noise(ivec3(z), 1), 4.0f); }, 0.01},
    {"one wall", [](int z) { return z == 50 ? 6.5f : 0.001f; }, 0.0},
    {"needles", [](int z) { return z % 31 == 7 ? 500.0f : 0.0f; }, 0.0},
};

double depth_of_nodes(const OneDimensional& pipe) {
    double sum = 0.0;
    for (int z = 1; z <= kLong; ++z)
        sum += pipe.extinction(z);
    return sum;
}

struct Field {
    explicit Field(const Recipe& recipe) : medium(make_medium(recipe)), field(medium) {}
    Medium medium;
    TrackingField field;
};

// Along z at (x, y), or aslant by that much.
Ray along_pipe(double x, double y, double slant = 0.0) {
    return {dvec3(x, y, -0.5), glm::normalize(dvec3(slant, -0.7 * slant, 1.0))};
}

const Ray kRays[] = {along_pipe(4.31, 3.77), along_pipe(4.0, 5.0), along_pipe(3.1, 4.6, 0.02)};

constexpr double kEverywhere = 1e9;

TEST(OpticalDepth, IsTheSumOfTheNodes) {
    for (const OneDimensional& p : kPipes) {
        const Field f(pipe(p.extinction));
        for (const Ray& ray : kRays)
            EXPECT_NEAR(optical_depth(f.field, ray, kEverywhere) * ray.direction.z / depth_of_nodes(p), 1.0, 2e-6)
                << p.name;
    }
}

// Inside smoke of one density every brick has its mean.
TEST(CoarseDepth, IsExactInEvenSmoke) {
    Recipe r;
    r.box = cube(0, 40);
    r.world_from_index = transform(some_linear_map(), dvec3(3.0, -7.0, 1.0));
    r.density = [](const ivec3&) { return 2.0f; };
    r.settings = black_smoke();
    const Field f(r);
    const dvec3 begin(f.medium.local_of_node({10, 12, 17})), end(f.medium.local_of_node({30, 27, 11}));
    const double distance = glm::length(end - begin);
    const Ray ray{begin, (end - begin) / distance};
    EXPECT_NEAR(coarse_depth(f.field, ray, distance), optical_depth(f.field, ray, distance),
                1e-5 * optical_depth(f.field, ray, distance));
}

// Through a whole brick of noise it is near: 81 nodes of the way's cross-section, or 729, have the same mean.
TEST(CoarseDepth, IsAboutTheOpticalDepth) {
    Recipe r;
    r.box = cube(0, 64);
    r.density = [](const ivec3& n) { return 5.0f * testing::noise(n, 1); };
    r.settings = black_smoke();
    const Field f(r);
    const dvec3 begin(f.medium.local_of_node({16, 20, 20})), end(f.medium.local_of_node({48, 44, 44}));
    const double distance = glm::length(end - begin);
    const Ray ray{begin, (end - begin) / distance};
    const double exact = optical_depth(f.field, ray, distance);
    EXPECT_NEAR(coarse_depth(f.field, ray, distance), exact, 0.2 * exact);
    EXPECT_NE(coarse_depth(f.field, ray, distance), exact);
}

TEST(OpticalDepth, OfPartsAddsUp) {
    for (const OneDimensional& p : kPipes) {
        const Field f(pipe(p.extinction));
        double before = 0.0;
        for (double end = 0.0; end < 100.0; end += 0.37) {
            const double now = optical_depth(f.field, kRays[2], end);
            EXPECT_GE(now, before - 1e-9);
            before = now;
        }
        EXPECT_NEAR(before, optical_depth(f.field, kRays[2], kEverywhere), 1e-6 * before);
    }
}

TEST(OpticalDepth, IsTheSameThereAndBack) {
    Recipe r;
    r.box = cube(0, 20);
    r.world_from_index = transform(some_linear_map(), dvec3(3.0, -7.0, 1.0));
    r.density = [](const ivec3& n) { return 5.0f * testing::noise(n, 1); };
    r.settings = black_smoke();
    const Field f(r);
    const dvec3 middle(f.medium.local_of_node(ivec3(10)));
    for (int i = 0; i < 200; ++i) {
        Rng rng(Stream::Path, i);
        const double u = rng.next_double();
        const dvec3 direction = uniform_direction(u, rng.next_double()), begin = middle - 9.0 * direction;
        const double there = optical_depth(f.field, {begin, direction}, 18.0);
        EXPECT_NEAR(there, optical_depth(f.field, {begin + 18.0 * direction, -direction}, 18.0), 1e-6 * there);
    }
}

// Integral of extinction^2 / majorant along the ray: a polynomial of degree six in every cell.
double integral_of_squares(const TrackingField& field, const Ray& ray) {
    constexpr double x[] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
    constexpr double w[] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};
    double sum = 0.0;
    walk_bricks(field.bricks(), field.enter(ray), [&](const VoxelSegment& s) {
        return walk_cubes<1>(s, [&](const VoxelSegment& cell) {
            for (int i = 0; field.majorant(s.brick) > 0.0f && i < 4; ++i)
                sum += w[i] * (cell.end - cell.begin) * std::pow(field.extinction_along(cell).at(x[i]), 2) /
                       field.majorant(s.brick);
            return true;
        });
    });
    return sum;
}

// Variance T^2 (exp(integral of extinction^2 / majorant) - 1), that is: the mean square is T^2 times the exponential.
// Here of a third of each pipe's depth; the mean square takes many more samples than the mean.
TEST(RatioTracking, HasTheMeanAndVarianceOfTheory) {
    Rows means("ratio tracking, mean"), squares("ratio tracking, mean square");
    for (const OneDimensional& p : kPipes) {
        const double depth = 0.3 * depth_of_nodes(p);
        if (depth > 20.0)
            continue;  // needles: walked exactly, see below
        const Field f(pipe([&](int z) { return 0.3f * p.extinction(z); }));
        const auto sample = [&](const dvec3&, Rng& rng, double* out) {
            out[0] = ratio_tracking(f.field, f.field.enter(kRays[0]), rng);
            out[1] = out[0] * out[0];
        };
        const Estimate e = estimate_to(kSharp, 1, sample), moments = estimate(2, 2000, sample);
        means.expect(p.name, e.mean[0], e.error[0], std::exp(-depth), 3e-6 * std::exp(-depth));
        const double square = std::exp(integral_of_squares(f.field, kRays[0]) - 2.0 * depth);
        squares.expect(p.name, moments.mean[1], moments.error[1], square, 1e-5 * square, 0.02);
    }
}

// The textbook's case: extinction half its majorant, optical depth 2, relative variance e - 1.
TEST(RatioTracking, OfHalfTheMajorantHasRelativeVarianceEMinusOne) {
    Recipe r = pipe([](int) { return 1.0f; });
    // One node of each brick is twice as dense, far from the ray.
    r.density = [](const ivec3& n) {
        if (n.x < 1 || n.y < 1 || n.x > 7 || n.y > 7 || n.z < 1 || n.z > kLong)
            return 0.0f;
        return n.x == 7 && n.y == 7 ? 2.0f : 1.0f;
    };
    r.settings.smoke.extinction_per_metre = static_cast<float>(2.0 / kLong);
    const Field f(r);
    const Ray ray = along_pipe(3.3, 3.6);
    const Estimate e = estimate(2, 4000, [&](const dvec3&, Rng& rng, double* out) {
        out[0] = ratio_tracking(f.field, f.field.enter(ray), rng);
        out[1] = out[0] * out[0];
    });
    Rows rows("half the majorant");
    rows.expect("mean", e.mean[0], e.error[0], std::exp(-2.0), 1e-6);
    // The ramps at both ends are less than half: one node's share of two.
    rows.expect("mean square", e.mean[1], e.error[1], std::exp(-3.0), 0.01 * std::exp(-3.0), 2.0 * kSharp);
    EXPECT_NEAR(integral_of_squares(f.field, ray), 1.0, 0.01);
}

// A wall of a single voxel is left out: a comb of samples coarser than the wall is unbiased, but one estimate in many
// millions makes up for all others.
TEST(UnbiasedRayMarch, HasTheMeanOfTheOpticalDepth) {
    Rows rows("unbiased ray march");
    for (const OneDimensional& p : kPipes) {
        const Field f(pipe(p.extinction));
        for (const Ray& ray : kRays) {
            if (p.marched == 0.0)
                continue;
            const double truth = std::exp(-depth_of_nodes(p) / ray.direction.z);
            const Estimate e = estimate_to(p.marched, 1, [&](const dvec3&, Rng& rng, double* out) {
                out[0] = unbiased_ray_march(f.field, f.field.enter(ray), rng);
            });
            rows.expect(p.name, e.mean[0], e.error[0], truth, 3e-6 * truth, p.marched);
        }
    }
}

// Delta tracking's estimate is 1 or 0, its variance T (1 - T) whatever the majorant: known to a few percent once the
// rarer of the two was seen a thousand times.
TEST(DeltaTracking, LetsThroughWhatTheOpticalDepthSays) {
    constexpr double sharp = 2.0 * kSharp, seen = 1000.0;
    Rows rows("delta tracking");
    for (const OneDimensional& p : kPipes) {
        const double truth = std::exp(-0.3 * depth_of_nodes(p));
        if (truth < 1e-6)
            continue;
        const Field f(pipe([&](int z) { return 0.3f * p.extinction(z); }));
        const double samples =
            std::max(1.5 * (1.0 - truth) / (truth * sharp * sharp), seen / std::min(truth, 1.0 - truth));
        const Estimate e = estimate(1, 1 + std::uint64_t(samples / kBatches), [&](const dvec3&, Rng& rng, double* out) {
            out[0] = null_collision_flight(f.field, kRays[0], kEverywhere, rng) ? 0.0 : 1.0;
        });
        rows.expect(p.name, e.mean[0], e.error[0], truth, 3e-6 * truth, sharp);
        const double spread = std::sqrt(2.0 / (kBatches - 1.0) + 1.0 / seen);
        EXPECT_NEAR(e.error[0] * e.error[0] * e.samples / (truth * (1.0 - truth)), 1.0, kSigmas * spread) << p.name;
    }
}

// The end of a path's segment when LineTracker inverts the optical depth of each voxel.
std::optional<Collision> exact_flight(const TrackingField& field, const Ray& ray, double end, Rng& rng) {
    TracingSettings settings;
    settings.free_flight = FreeFlight::Exact;
    return LineTracker(field, settings).follow_path(ray, rng, end).collision;
}

TEST(Trackers, SeeNothingThroughNeedles) {
    const Field f(pipe(kPipes[5].extinction));
    Rng rng(Stream::Path, 1);
    for (int i = 0; i < 100; ++i) {
        EXPECT_LT(ratio_tracking(f.field, f.field.enter(kRays[0]), rng), 1e-300);
        EXPECT_LT(std::abs(unbiased_ray_march(f.field, f.field.enter(kRays[0]), rng)), 1e-300);
        EXPECT_TRUE(exact_flight(f.field, kRays[0], kEverywhere, rng));
        EXPECT_TRUE(null_collision_flight(f.field, kRays[0], kEverywhere, rng));
    }
}

using Flight = std::optional<Collision> (*)(const TrackingField&, const Ray&, double, Rng&);

// Kolmogorov and Smirnov: the greatest distance between the flights' distribution and 1 - exp(-optical depth). By
// chance it exceeds 2.23 / sqrt(n) once in ten thousand times.
void expect_exponential(Flight flight, const TrackingField& field, const Ray& ray, double end,
                        const std::string& what) {
    constexpr int n = 20000;
    std::vector<double> passed;
    Rng rng(Stream::Path, 17);
    for (int i = 0; i < n; ++i)
        if (const auto c = flight(field, ray, end, rng)) {
            ASSERT_LE(c->distance, end);
            passed.push_back(-std::expm1(-optical_depth(field, ray, c->distance)));
        }
    std::sort(passed.begin(), passed.end());
    const double all = -std::expm1(-optical_depth(field, ray, end));
    double worst = std::abs(passed.size() / double(n) - all);
    for (std::size_t i = 0; i < passed.size(); ++i)
        worst = std::max({worst, std::abs(passed[i] - i / double(n)), std::abs(passed[i] - (i + 1) / double(n))});
    EXPECT_LT(worst * std::sqrt(n), 2.23) << what;
}

TEST(Flights, EndWhereTheOpticalDepthSays) {
    for (const OneDimensional& p : kPipes) {
        const Field f(pipe(p.extinction));
        for (const Ray& ray : kRays)
            for (const double end : {31.4, kEverywhere}) {
                expect_exponential(exact_flight, f.field, ray, end, std::string("exact, ") + p.name);
                expect_exponential(null_collision_flight, f.field, ray, end, std::string("null collisions, ") + p.name);
            }
    }
}

// Sheared voxels, uneven in all directions, some of them stiff.
TEST(Flights, EndWhereTheOpticalDepthSaysInAnyLattice) {
    for (const float power : {1.0f, 20.0f}) {
        Recipe r;
        r.box = cube(0, 30);
        r.world_from_index = transform(some_linear_map(), dvec3(0.0));
        r.density = [=](const ivec3& n) { return (0.3f + power) * std::pow(testing::noise(n, 1), power); };
        r.settings = black_smoke();
        const Field f(r);
        const dvec3 middle(f.medium.local_of_node(ivec3(15)));
        for (int i = 0; i < 4; ++i) {
            const dvec3 direction = uniform_direction(0.15 + 0.2 * i, 0.7 * i);
            const Ray ray{middle - (i < 2 ? 10.0 : 0.1) * direction, direction};
            expect_exponential(exact_flight, f.field, ray, kEverywhere, "exact");
            expect_exponential(null_collision_flight, f.field, ray, kEverywhere, "null collisions");
        }
    }
}

// A collision lies where it says it does, and in smoke.
TEST(Flights, KnowTheirPlaceInTheLattice) {
    Recipe r;
    r.box = cube(-9, 9);
    r.world_from_index = transform(some_linear_map(), dvec3(0.4, -0.2, 0.9));
    r.density = [](const ivec3& n) { return testing::noise(n, 1) > 0.7f ? 9.0f : 0.0f; };
    r.settings = black_smoke();
    const Field f(r);
    const dmat3 linear(f.medium.world_from_index);
    Rng rng(Stream::Path, 5);
    for (int i = 0; i < 2000; ++i) {
        const double u = rng.next_double();
        const Ray ray{dvec3(0.0), uniform_direction(u, rng.next_double())};
        const auto c = (i & 1 ? exact_flight : null_collision_flight)(f.field, ray, kEverywhere, rng);
        if (!c)
            continue;
        const dvec3 node = dvec3(f.field.bricks().first_node(c->brick)) + dvec3(c->position);
        const dvec3 local = linear * (node - dvec3(f.medium.reference_node));
        EXPECT_LT(glm::length(local - ray.direction * c->distance), 1e-5);
        EXPECT_GT(f.field.extinction(c->brick, c->position), 0.0f);
    }
}

// The depth of a cubic never falls, so its inverse is unique; also where the cubic starts or ends at zero.
TEST(Flights, InvertTheDepthOfACell) {
    const Cubic cubics[] = {{{1, 0, 0, 0}},   {{0, 2, 0, 0}},     {{2, -2, 0, 0}},
                            {{0, 0, 3, 0}},   {{0, 3, -6, 4}},    {{1e-8, 0, 0, 1e8}},
                            {{1, -3, 3, -1}}, {{0.25, -1, 1, 0}}, {{1e8, -1e8, 0, 0}}};
    for (const Cubic& c : cubics)
        for (const double metres : {1e-3, 1.0, 50.0})
            for (double part = 0.0; part <= 1.0; part += 1.0 / 64.0) {
                const double depth = part * c.integral(1.0) * metres;
                const double u = invert_depth(c, metres, depth);
                EXPECT_GE(u, 0.0);
                EXPECT_LE(u, 1.0);
                EXPECT_NEAR(c.integral(u) * metres, depth, 1e-9 * c.integral(1.0) * metres);
            }
}

}  // namespace
}  // namespace brisance
