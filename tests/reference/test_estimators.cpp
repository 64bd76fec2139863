// All estimators give the same picture, order by order: in smoke of uneven density and colour, with fire that is
// tied to absorption and fire that is not, g = 0.5.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/tracing_fixture.h"

namespace brisance {
namespace {

using namespace testing;

// The part of a ball of that radius around a node, in nodes, that a node lies in.
float lump(const ivec3& node, const ivec3& middle, double radius) {
    return testing::ball(node, dvec3(middle), radius) * testing::noise(node, 2);
}

// Two small fires, so that there are lines toward them; smoke thin enough for those lines, and a corner of stiff
// voxels.
Medium mixed_medium() {
    Recipe r;
    r.box = cube(-10, 10);
    r.world_from_index = cubic(0.1);
    r.density = [](const ivec3& n) {
        return n.x > 7 && n.y > 7 ? 300.0f : 6.0f * std::pow(testing::noise(n, 1), 2.0f);
    };
    r.flame = [](const ivec3& n) { return lump(n, ivec3(-3, 2, -4), 3.5); };
    r.colour = [](const ivec3& n) { return Rgb(1.0f, 0.7f, 0.3f) * (0.5f + 0.5f * testing::noise(n, 3)); };
    r.settings.smoke.albedo = Rgb(0.95f);
    r.settings.smoke.mean_cosine = 0.5f;
    r.settings.fire.colour = Rgb(1.0f, 0.5f, 0.2f);
    Medium medium = make_medium(r);
    // Files hold one kind of emission; a medium may hold both.
    medium.emission.resize(medium.lattice.node_count());
    for (std::size_t i = 0; i < medium.emission.size(); ++i) {
        const ivec3 n = medium.lattice.first_node(i / BrickLattice::kNodes) +
                        BrickLattice::node_in_brick(static_cast<int>(i % BrickLattice::kNodes));
        medium.emission[i] = lump(n, ivec3(-5, -2, -3), 2.5) * Rgb(0.3f, 0.6f, 1.0f);
    }
    return medium;
}

// Mean over rays from everywhere of each order's luminance, and of the three channels of all of them.
Estimate look_by_orders(const TracingSettings& settings) {
    const Traced traced(mixed_medium(), settings);
    // The plain tracker's paths are fast and poor.
    const std::uint64_t per_batch = settings.emission == EmissionEstimator::Collision ? 1000 : 125;
    return estimate(kPathOrders + 3, per_batch, [&](const dvec3& u, Rng& rng, double* out) {
        PathSum sum{};
        PathStatistics statistics;
        traced.tracer.trace(ray_through_disc(1.2, u.y, u.z, rng), u.x, rng, sum, statistics);
        dvec3 all(0.0);
        for (int k = 0; k < kPathOrders; ++k) {
            out[k] = luminance(sum[k]);
            all += dvec3(sum[k]);
        }
        for (int c = 0; c < 3; ++c)
            out[kPathOrders + c] = all[c];
    });
}

struct Variant {
    std::string name;
    TracingSettings settings;
};

std::vector<Variant> all_variants() {
    std::vector<Variant> variants;
    for (const bool light : {true, false})
        for (const FreeFlight flight : {FreeFlight::Exact, FreeFlight::NullCollision})
            for (const auto transmittance :
                 {TransmittanceEstimator::Exact, TransmittanceEstimator::RayMarch, TransmittanceEstimator::Ratio}) {
                Variant variant;
                variant.settings.light_sampling = light;
                variant.settings.free_flight = flight;
                variant.settings.transmittance = transmittance;
                variant.name = std::string(light ? "lines to the fire" : "phase function") +
                               (flight == FreeFlight::Exact ? ", exact flight" : ", null collisions") +
                               (transmittance == TransmittanceEstimator::Exact      ? ", exact transmittance"
                                : transmittance == TransmittanceEstimator::RayMarch ? ", ray march"
                                                                                    : ", ratio tracking");
                variants.push_back(variant);
            }
    variants.push_back({"collisions", {}});
    variants.back().settings.emission = EmissionEstimator::Collision;
    return variants;
}

TEST(Estimators, AgreeOrderByOrder) {
    const std::vector<Variant> variants = all_variants();
    Rows rows("estimators against one another");
    std::vector<Estimate> found;
    for (const Variant& variant : variants)
        found.push_back(look_by_orders(variant.settings));
    for (std::size_t i = 0; i < variants.size(); ++i)
        for (int k = 0; k < kPathOrders + 3; ++k) {
            // Against the mean of all others, weighted by their precision.
            double sum = 0.0, weights = 0.0;
            for (std::size_t j = 0; j < variants.size(); ++j) {
                const double weight = i == j ? 0.0 : 1.0 / (found[j].error[k] * found[j].error[k]);
                sum += weight * found[j].mean[k];
                weights += weight;
            }
            rows.expect(variants[i].name + ", " + std::to_string(k), found[i].mean[k],
                        std::hypot(found[i].error[k], 1.0 / std::sqrt(weights)), sum / weights, 0.0,
                        k < 3 ? 0.05 : 0.5);
        }
}

// Cutting paths short leaves out later orders and changes no earlier one.
TEST(Estimators, FewerBouncesAreTheFirstOrders) {
    const Medium medium = mixed_medium();
    const auto orders = [&](int bounces) {
        const PathTracer tracer(medium, {}, bounces);
        return estimate(kPathOrders, 64, [&](const dvec3& u, Rng& rng, double* out) {
            PathSum sum{};
            PathStatistics statistics;
            tracer.trace(ray_through_disc(1.2, u.y, u.z, rng), u.x, rng, sum, statistics);
            for (int k = 0; k < kPathOrders; ++k)
                out[k] = luminance(sum[k]);
        });
    };
    const Estimate all = orders(-1);
    Rows rows("fewer bounces");
    for (const int bounces : {0, 1, 2, 5}) {
        const Estimate some = orders(bounces);
        for (int k = 0; k < kPathOrders; ++k) {
            if (k > bounces)
                EXPECT_EQ(some.mean[k], 0.0);
            else
                rows.expect(std::to_string(bounces) + ", " + std::to_string(k), some.mean[k],
                            std::hypot(some.error[k], all.error[k]), all.mean[k], 1e-6 * all.mean[k], 0.2);
        }
    }
}

// Lengths times s and coefficients over s: the same picture, bit by bit where s is a power of two.
TEST(Estimators, KnowNoUnitOfLength) {
    const auto radiance = [](double scale) {
        Recipe r;
        r.box = cube(-6, 6);
        r.world_from_index = cubic(0.25 * scale);
        r.density = [](const ivec3& n) { return 4.0f * testing::noise(n, 1); };
        r.flame = [](const ivec3& n) { return testing::noise(n, 2); };
        r.settings.smoke.extinction_per_metre = static_cast<float>(1.0 / scale);
        const Traced traced(r);
        std::vector<double> found;
        for (int i = 0; i < 200; ++i) {
            Rng rng(Stream::Path, i);
            Ray ray = ray_through_disc(1.5, (i + 0.5) / 200.0, 0.618 * i, rng);
            ray.origin *= scale;
            double out[3];
            traced.look(ray, 0.3, rng, out);
            found.push_back(out[0]);
        }
        return found;
    };
    EXPECT_EQ(radiance(1.0), radiance(1024.0));
    EXPECT_EQ(radiance(1.0), radiance(1.0 / 4096.0));
}

}  // namespace
}  // namespace brisance
