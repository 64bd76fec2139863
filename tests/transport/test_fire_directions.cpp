// Directions toward the fire and directions of scattering: samples follow their stated densities.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/tracing_fixture.h"
#include "medium/phase.h"

namespace brisance {
namespace {

using namespace testing;

// A chi-square test of counts against expectations; cells expecting less than twenty are joined. By chance it fails
// once in ten thousand times.
void expect_counts(const std::vector<double>& counts, const std::vector<double>& expected, const std::string& what) {
    double chi_square = 0.0, rest = 0.0, rest_expected = 0.0;
    int cells = 0;
    const auto add = [&](double count, double mean) {
        chi_square += (count - mean) * (count - mean) / mean;
        ++cells;
    };
    for (std::size_t i = 0; i < counts.size(); ++i) {
        if (expected[i] >= 20.0) {
            add(counts[i], expected[i]);
            continue;
        }
        rest += counts[i];
        rest_expected += expected[i];
    }
    if (rest_expected >= 20.0)
        add(rest, rest_expected);
    else
        EXPECT_LT(rest, rest_expected + 10.0 * std::sqrt(rest_expected + 1.0)) << what;
    ASSERT_GT(cells, 3) << what;
    EXPECT_GT(chi_square_tail(chi_square, cells - 1), 1e-4) << what << ": " << chi_square << " for " << cells - 1;
}

// Uneven fire and smoke on a sheared lattice, in several bricks, off the origin.
Medium some_fire(bool direct) {
    Recipe r;
    r.box = cube(-11, 14);
    r.world_from_index = transform(some_linear_map(), dvec3(0.1, 0.2, -0.1));
    r.density = [](const ivec3& n) { return testing::noise(n, 1); };
    r.flame = [](const ivec3& n) {
        return std::max(0.0f, testing::noise(n / 4, 2) - 0.6f) + (n == ivec3(3) ? 30.f : 0.f);
    };
    r.settings.fire.convention = direct ? EmissionConvention::Direct : EmissionConvention::TimesAbsorption;
    return make_medium(r);
}

struct Fire {
    explicit Fire(bool direct) : medium(some_fire(direct)), field(medium), directions(field) {}
    Medium medium;
    TrackingField field;
    FireDirections directions;
};

// Inside the fire, at its edge, near it, and far away, where it fills a cone of this cosine about the way to the
// middle.
struct View {
    const char* name;
    dvec3 from;
    double cosine;
};

const View kViews[] = {{"inside", dvec3(0.05, -0.1, 0.2), -1.0},
                       {"on a node", dvec3(0.0), -1.0},
                       {"at the edge", dvec3(2.0, 1.0, 1.5), -1.0},
                       {"near", dvec3(-4.0, 3.0, 2.0), -1.0},
                       {"far", dvec3(200.0, -300.0, 150.0), 0.9996}};

// Maps a point of the unit square to a direction in a view's cone; equal areas go to equal solid angles.
dvec3 in_cone(const View& view, double u, double v) {
    if (view.cosine == -1.0)
        return uniform_direction(u, v);
    const dvec3 axis = glm::normalize(-view.from);
    const dvec3 x = glm::normalize(glm::cross(axis, dvec3(0, 0, 1)));
    const dvec3 local = uniform_direction(0.5 * (1.0 - view.cosine) * u, v);
    return local.z * axis + local.x * x + local.y * glm::cross(axis, x);
}

double solid_angle(const View& view) {
    return 2.0 * kPi64 * (1.0 - view.cosine);
}

TEST(FireDirections, TheirDensityIntegratesToOne) {
    Rows rows("integral of the density");
    for (const bool direct : {false, true}) {
        const Fire fire(direct);
        for (const View& view : kViews) {
            const Estimate e = estimate_to(kSharp, 1, [&](const dvec3& u, Rng&, double* out) {
                out[0] = fire.directions.pdf({view.from, in_cone(view, u.x, u.y)}) * solid_angle(view);
            });
            rows.expect(view.name, e.mean[0], e.error[0], 1.0, 1e-6);
        }
    }
}

// Cells of equal area; what each should get by the midpoint rule, 32 x 32 to a cell.
TEST(FireDirections, SamplesFollowTheirDensity) {
    constexpr int kRows = 12, kColumns = 16, kFine = 32, kSamples = 100000;
    const Fire fire(false);
    for (const View& view : kViews) {
        std::vector<double> counts(kRows * kColumns), expected(kRows * kColumns);
        for (int row = 0; row < kRows * kFine; ++row)
            for (int column = 0; column < kColumns * kFine; ++column) {
                const dvec3 d = in_cone(view, (row + 0.5) / (kRows * kFine), (column + 0.5) / (kColumns * kFine));
                expected[row / kFine * kColumns + column / kFine] += fire.directions.pdf({view.from, d}) *
                                                                     solid_angle(view) * kSamples /
                                                                     (kRows * kColumns * kFine * kFine);
            }
        const dvec3 axis = in_cone(view, 0.0, 0.0),
                    x = glm::normalize(in_cone(view, 0.5, 0.0) - axis * glm::dot(axis, in_cone(view, 0.5, 0.0)));
        Rng rng(Stream::Path, 3);
        for (int i = 0; i < kSamples; ++i) {
            const dvec3 d = fire.directions.sample(view.from, rng);
            ASSERT_NEAR(glm::length(d), 1.0, 1e-12);
            const double u = (1.0 - glm::dot(d, axis)) / (1.0 - view.cosine);
            const double angle = std::atan2(glm::dot(d, glm::cross(axis, x)), glm::dot(d, x)) / (2.0 * kPi64);
            ASSERT_LT(u, 1.0 + 1e-9);
            const int row = std::min(int(u * kRows), kRows - 1);
            const int column = std::min(int((angle < 0.0 ? angle + 1.0 : angle) * kColumns), kColumns - 1);
            counts[row * kColumns + column] += 1.0;
        }
        expect_counts(counts, expected, view.name);
    }
}

// The mean of 1 / pdf over the samples is the solid angle that the fire fills: all of the sphere from within.
TEST(FireDirections, TheirInverseDensityFillsTheSphere) {
    const Fire fire(false);
    Rows rows("inverse density");
    const Estimate e = estimate_to(kSharp, 1, [&](const dvec3&, Rng& rng, double* out) {
        const dvec3 d = fire.directions.sample(kViews[0].from, rng);
        out[0] = 1.0 / fire.directions.pdf({kViews[0].from, d});
    });
    rows.expect("inside", e.mean[0], e.error[0], 4.0 * kPi64, 1e-6);
}

// Any integral over directions may be sampled by them: here of a function that is unrelated to the fire.
TEST(FireDirections, MeasureWhatUniformDirectionsMeasure) {
    const Fire fire(true);
    Rows rows("some function of directions");
    const auto some = [](const dvec3& d) { return std::exp(d.x - 0.5 * d.y) + d.z * d.z; };
    for (const View& view : {kViews[0], kViews[1]}) {
        const Estimate e = estimate_to(kSharp, 2, [&](const dvec3& u, Rng& rng, double* out) {
            const dvec3 d = fire.directions.sample(view.from, rng);
            out[0] = some(d) / fire.directions.pdf({view.from, d});
            out[1] = some(uniform_direction(u.x, u.y)) * 4.0 * kPi64;
        });
        rows.expect(view.name, e.mean[0], std::hypot(e.error[0], e.error[1]), e.mean[1], 0.0, 2.0 * kSharp);
    }
}

TEST(FireDirections, NoFireHasNone) {
    Recipe r;
    r.box = cube(0, 7);
    r.density = [](const ivec3&) { return 1.0f; };
    r.settings = black_smoke();
    const Medium medium = make_medium(r);
    const TrackingField field(medium);
    EXPECT_TRUE(FireDirections(field).empty());
}

// Probability that Henyey and Greenstein scatter by less than this cosine.
double cosine_distribution(double cosine, double g) {
    if (g == 0.0)
        return 0.5 * (1.0 + cosine);
    return (1.0 - g * g) / (2.0 * g) * (1.0 / std::sqrt(1.0 + g * g - 2.0 * g * cosine) - 1.0 / (1.0 + g));
}

// Bins of equal probability in the cosine, by angle about the axis.
TEST(ScatteredDirections, FollowThePhaseFunction) {
    constexpr int kCosines = 40, kAngles = 8, kSamples = 200000;
    for (const float g : {0.0f, 0.3f, -0.3f, 0.9f, -0.9f, 0.999f})
        for (const dvec3& forward : {dvec3(0, 0, 1), dvec3(0, 0, -1), glm::normalize(dvec3(0.3, -0.5, -0.8))}) {
            const dvec3 x = glm::normalize(glm::cross(forward, dvec3(0.1, 1.0, 0.2))), y = glm::cross(forward, x);
            std::vector<double> counts(kCosines * kAngles), expected(counts.size(), kSamples / double(counts.size()));
            Rng rng(Stream::Path, 9);
            double sum = 0.0;
            for (int i = 0; i < kSamples; ++i) {
                const dvec3 d = sample_henyey_greenstein(forward, g, rng);
                ASSERT_NEAR(glm::length(d), 1.0, 1e-12);
                const double cosine = glm::dot(d, forward), angle = std::atan2(glm::dot(d, y), glm::dot(d, x));
                sum += cosine;
                const double p = cosine_distribution(cosine, g), turn = angle / (2.0 * kPi64) + 0.5;
                const int bin = std::clamp(int(p * kCosines), 0, kCosines - 1);
                counts[bin * kAngles + std::clamp(int(turn * kAngles), 0, kAngles - 1)] += 1.0;
            }
            expect_counts(counts, expected, "g = " + std::to_string(g));
            EXPECT_NEAR(sum / kSamples, g, kSigmas * std::sqrt((1.0 - g * g) / kSamples)) << g;
        }
}

// The density that paths are weighted with is the one that they are drawn by.
TEST(ScatteredDirections, HaveTheDistributionOfThePhaseFunctionItself) {
    for (const float g : {0.0f, 0.3f, -0.3f, 0.9f, -0.9f, 0.999f}) {
        constexpr int n = 200000;
        double sum = 0.0, worst = 0.0;
        // Steps of equal size in the square root of the angle from the peak.
        for (int i = 0; i < n; ++i) {
            const double a0 = kPi64 * std::pow(double(i) / n, 3), a1 = kPi64 * std::pow((i + 1.0) / n, 3);
            const double middle = 0.5 * (a0 + a1), cosine = g < 0.0f ? -std::cos(middle) : std::cos(middle);
            sum += 2.0 * kPi64 * std::sin(middle) * (a1 - a0) * henyey_greenstein(float(cosine), g);
            const double truth =
                g < 0.0f ? cosine_distribution(-std::cos(a1), g) : 1.0 - cosine_distribution(std::cos(a1), g);
            worst = std::max(worst, std::abs(sum - truth));
        }
        EXPECT_LT(worst, g > 0.99f ? 2e-2 : 1e-4) << g;
    }
}

}  // namespace
}  // namespace brisance
