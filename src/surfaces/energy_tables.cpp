#include "surfaces/energy_tables.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <shared_mutex>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"
#include "surfaces/fresnel.h"
#include "surfaces/ggx.h"

namespace brisance {

namespace {

constexpr int kRoughnesses = 48, kAngles = 80, kMeans = 768, kMeanPoints = 256;

// From 0 at the smooth limit to 1, by the root of roughness: finer where less is lost.
double roughness_coordinate(double alpha) {
    const double least = std::sqrt(std::sqrt(kSmoothAlpha));
    return std::clamp((std::sqrt(std::sqrt(alpha)) - least) / (1.0 - least), 0.0, 1.0);
}

double alpha_of(double coordinate) {
    const double least = std::sqrt(std::sqrt(kSmoothAlpha)), root = least + (1.0 - least) * coordinate;
    return root * root * root * root;
}

// A third of the coordinate goes to cosines around alpha, where masking sets in whatever alpha is, a third to those of
// grazing angles, and a third evenly to all, for the critical angle may be anywhere.
double angle_coordinate(double alpha, double cosine) {
    constexpr double grazing = 0.1;
    return cosine * ((1.0 + alpha) / (cosine + alpha) + (1.0 + grazing) / (cosine + grazing) + 1.0) / 3.0;
}

double cosine_of(double alpha, double coordinate) {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (angle_coordinate(alpha, middle) < coordinate ? low : high) = middle;
    }
    return coordinate >= 1.0 ? 1.0 : low;
}

// Points and weights of Gauss and Legendre on [0, 1], by Newton's method.
std::vector<std::pair<double, double>> gauss_legendre(int n) {
    std::vector<std::pair<double, double>> points;
    for (int i = 0; i < n; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
        for (int step = 0; step < 20; ++step) {
            double before = 1.0, value = x;
            for (int k = 2; k <= n; ++k)
                before = std::exchange(value, ((2.0 * k - 1.0) * x * value - (k - 1.0) * before) / k);
            slope = n * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        points.emplace_back(0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope));
    }
    return points;
}

// Shares of the light on one facet that leave unmasked, by side and without Fresnel terms.
struct Facet {
    double reflected, refracted, blend;
    bool total;  // beyond the critical angle
};

Facet facet_shares(const Ggx& ggx, const dvec3& wo, const dvec3& h, double eta) {
    const double c = glm::dot(wo, h);
    Facet f{0.0, 0.0, dielectric_blend(c, eta), false};
    const double up = 2.0 * c * h.z - wo.z;
    if (up > 0.0)
        f.reflected = ggx.correlated_masking_per_cosines(wo.z, up) * up / ggx.masking_per_cosine(wo.z);
    const std::optional<double> far = refracted_cosine(c, eta);
    f.total = !far;
    if (far) {
        const double down = -((c / eta - *far) * h.z - wo.z / eta);
        f.refracted = down > 0.0 ? ggx.masking(down) : 0.0;
    }
    return f;
}

void add_facet(const Facet& f, double weight, int side, Albedos& sum) {
    const double reflected = weight * f.reflected, refracted = weight * f.refracted;
    if (side == 0) {
        sum.reflect += reflected;
        sum.reflect_blend += reflected * f.blend;
    }
    sum.first[side] += f.total ? reflected : refracted;
    sum.second[side] += f.total ? 0.0 : (reflected - refracted);
    sum.third[side] += f.total ? 0.0 : (reflected - refracted) * f.blend;
}

using Numbers = std::array<double, 8>;

// The table holds reflect_blend relative to the blend at the angle itself, because smooth interfaces have just that.
// The offset keeps the ratio finite at normal incidence.
constexpr double kOffset = 0.1;

double relative_blend(const Albedos& a, double blend) {
    return (a.reflect_blend + kOffset * a.reflect) / (blend + kOffset);
}

double absolute_blend(const Albedos& a, double relative, double blend) {
    return relative * (blend + kOffset) - kOffset * a.reflect;
}

Numbers numbers_of(const Albedos& a) {
    return {a.reflect, a.reflect_blend, a.first[0], a.first[1], a.second[0], a.second[1], a.third[0], a.third[1]};
}

Albedos albedos_of(const Numbers& n) {
    return {n[0], n[1], {n[2], n[3]}, {n[4], n[5]}, {n[6], n[7]}};
}

// Of `count` entries evenly over 0..1: the one below x, and the fraction by which x lies beyond it.
std::pair<int, double> interval_of(double x, int count) {
    const double position = std::clamp(x, 0.0, 1.0) * (count - 1);
    const int interval = std::min(static_cast<int>(position), count - 2);
    return {interval, position - interval};
}

double mean_blend_of(double ior) {
    double sum = 0.0;
    for (const auto& [x, weight] : gauss_legendre(64))
        sum += weight * 2.0 * x * dielectric_blend(x, ior);
    return sum;
}

template <class Entry>
void store(const Numbers& numbers, Entry& entry) {
    for (std::size_t i = 0; i < numbers.size(); ++i)
        entry[i] = static_cast<float>(numbers[i]);
}

template <class Entry>
void add(const Entry& entry, double weight, Numbers& sum) {
    for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] += weight * entry[i];
}

}  // namespace

// A Fibonacci lattice is even along every line, as the kinks of Fresnel terms and the horizon require.
Albedos integrate_albedos(double ior, double alpha, double cosine, int least) {
    int points = 1, step = 1;
    while (points < least)
        step = std::exchange(points, points + step);
    const Ggx ggx{alpha};
    const dvec3 wo(std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.0, cosine);
    Albedos sum;
    sum.reflect = sum.first[0] = sum.first[1] = 0.0;
    for (int i = 0; i < points; ++i) {
        // GGX's tail lies within alpha^2 of v = 1, hence the power.
        const double y = (i + 0.5) / points, v = 1.0 - y * y * y, share = 3.0 * y * y / points;
        const dvec3 h = ggx.sample_visible(wo, double(std::int64_t(i) * step % points) / points, v);
        for (int side = 0; side < 2; ++side)
            add_facet(facet_shares(ggx, wo, h, side == 0 ? ior : 1.0 / ior), share, side, sum);
    }
    return sum;
}

EnergyTables::EnergyTables(double ior)
    : ior_(ior), mean_blend_(mean_blend_of(ior)), table_(kRoughnesses * kAngles), means_(kMeans) {
    parallel_for(table_.size(), [&](std::size_t i) {
        const std::size_t row = i / kAngles;
        const double alpha = alpha_of(double(row) / (kRoughnesses - 1));
        const double cosine = cosine_of(alpha, double(i % kAngles) / (kAngles - 1));
        Albedos a = integrate_albedos(ior, alpha, cosine);
        a.reflect_blend = relative_blend(a, dielectric_blend(cosine, ior));
        store(numbers_of(a), table_[i]);
    });
    // Means of the interpolated table, not of the exact integrals: errors of interpolation then cancel over directions.
    parallel_for(means_.size(), [&](std::size_t i) {
        const double alpha = alpha_of(double(i) / (kMeans - 1));
        Numbers sum{};
        for (int k = 0; k < kMeanPoints; ++k) {
            const double from = cosine_of(alpha, double(k) / kMeanPoints);
            const double to = cosine_of(alpha, double(k + 1) / kMeanPoints);
            add(numbers_of(at(alpha, 0.5 * (from + to))), to * to - from * from, sum);
        }
        store(sum, means_[i]);
    });
}

EnergyTables::Row EnergyTables::row(double alpha) {
    const auto [first, above] = interval_of(roughness_coordinate(alpha), kRoughnesses);
    return {alpha, first, above};
}

// In double precision: what is lost is a small difference from 1.
Albedos EnergyTables::at(const Row& row, double cosine) const {
    const auto [column, along] = interval_of(angle_coordinate(row.alpha, cosine), kAngles);
    const Entry* const low = &table_[std::size_t(row.first * kAngles + column)];
    const Entry* const high = low + kAngles;
    Numbers sum;
    for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] = (1.0 - row.above) * (1.0 - along) * low[0][i] + (1.0 - row.above) * along * low[1][i] +
                 row.above * (1.0 - along) * high[0][i] + row.above * along * high[1][i];
    Albedos a = albedos_of(sum);
    a.reflect_blend = absolute_blend(a, a.reflect_blend, dielectric_blend(cosine, ior_));
    return a;
}

Albedos EnergyTables::mean(double alpha) const {
    const auto [row, along] = interval_of(roughness_coordinate(alpha), kMeans);
    Numbers sum{};
    add(means_[row], 1.0 - along, sum);
    add(means_[row + 1], along, sum);
    return albedos_of(sum);
}

// Tables that are kept, or made.
static const EnergyTables& find_tables(float ior) {
    if (!(ior >= 1.0f && ior <= 10.0f))
        throw Error(ExitCode::BadData, "ior must lie between 1 and 10, got " + std::to_string(ior));
    static std::shared_mutex mutex;
    static std::map<float, std::unique_ptr<const EnergyTables>> kept;
    {
        const std::shared_lock lock(mutex);
        if (const auto found = kept.find(ior); found != kept.end())
            return *found->second;
    }
    // Made outside the lock: a thread that waits for its parallel loop may be given work that needs tables, too.
    auto made = std::make_unique<const EnergyTables>(ior);
    const std::unique_lock lock(mutex);
    return *kept.try_emplace(ior, std::move(made)).first->second;
}

// Every vertex of a path asks, most often for what its thread asked for last: no lock is taken then.
const EnergyTables& energy_tables(float ior) {
    thread_local const EnergyTables* last = nullptr;
    if (last == nullptr || static_cast<float>(last->ior()) != ior)
        last = &find_tables(ior);
    return *last;
}

}  // namespace brisance
