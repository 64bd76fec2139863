#include "surfaces/energy_tables.h"

#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <numbers>
#include <shared_mutex>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "surfaces/fresnel.h"
#include "surfaces/ggx.h"

namespace brisance {

namespace {

// Points of the quadrature: the critical angle asks for many.
constexpr int kPoints = 610, kPointsOfInterface = 4181;

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

double mean_blend_of(double ior) {
    double sum = 0.0;
    for (const auto& [x, weight] : gauss_legendre(64))
        sum += weight * 2.0 * x * dielectric_blend(x, ior);
    return sum;
}

// Of one facet that leaves unmasked, without Fresnel terms. `c`: of wo to the facet.
double reflected_share(const Ggx& ggx, const dvec3& wo, const dvec3& h, double c) {
    const double up = 2.0 * c * h.z - wo.z;
    return up > 0.0 ? ggx.correlated_masking_per_cosines(wo.z, up) * up / ggx.masking_per_cosine(wo.z) : 0.0;
}

void add_facet(const Ggx& ggx, const dvec3& wo, const dvec3& h, double ior, double weight, Albedos& sum) {
    const double c = glm::dot(wo, h), reflected = weight * reflected_share(ggx, wo, h, c);
    sum.reflect += reflected;
    sum.reflect_blend += reflected * dielectric_blend(c, ior);
}

void add_facet(const Ggx& ggx, const dvec3& wo, const dvec3& h, double ior, double weight, InterfaceAlbedos& sum) {
    const double c = glm::dot(wo, h), reflected = reflected_share(ggx, wo, h, c);
    for (int side = 0; side < 2; ++side) {
        const double eta = side == 0 ? ior : 1.0 / ior;
        const std::optional<double> far = refracted_cosine(c, eta);
        if (!far) {
            sum.first[side] += weight * reflected;
            continue;
        }
        const double down = -((c / eta - *far) * h.z - wo.z / eta);
        const double refracted = down > 0.0 ? ggx.masking(down) : 0.0;
        sum.first[side] += weight * refracted;
        sum.second[side] += weight * (reflected - refracted);
        sum.third[side] += weight * (reflected - refracted) * dielectric_blend(c, eta);
    }
}

// A Fibonacci lattice is even along every line, as the kinks of Fresnel terms and the horizon require.
template <class Sum>
void integrate(double ior, double alpha, double cosine, int least, Sum& sum) {
    int points = 1, step = 1;
    while (points < least)
        step = std::exchange(points, points + step);
    const Ggx ggx{alpha};
    const dvec3 wo(std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.0, cosine);
    for (int i = 0; i < points; ++i) {
        // GGX's tail lies within alpha^2 of v = 1, hence the power.
        const double y = (i + 0.5) / points, v = 1.0 - y * y * y, share = 3.0 * y * y / points;
        const dvec3 h = ggx.sample_visible(wo, double(std::int64_t(i) * step % points) / points, v);
        add_facet(ggx, wo, h, ior, share, sum);
    }
}

// The table holds reflect_blend relative to the blend at the angle itself, because smooth interfaces have just that.
// The offset keeps the ratio finite at normal incidence.
constexpr double kOffset = 0.1;

double relative_blend(const Albedos& a, double blend) {
    return (a.reflect_blend + kOffset * a.reflect) / (blend + kOffset);
}

double absolute_blend(double reflect, double relative, double blend) {
    return relative * (blend + kOffset) - kOffset * reflect;
}

std::array<double, 6> numbers_of(const InterfaceAlbedos& a) {
    return {a.first[0], a.first[1], a.second[0], a.second[1], a.third[0], a.third[1]};
}

InterfaceAlbedos albedos_of(const std::array<double, 6>& n) {
    return {{n[0], n[1]}, {n[2], n[3]}, {n[4], n[5]}};
}

}  // namespace

Albedos integrate_albedos(double ior, double alpha, double cosine, int points) {
    Albedos sum{0.0, 0.0};
    integrate(ior, alpha, cosine, points, sum);
    return sum;
}

InterfaceAlbedos integrate_interface_albedos(double ior, double alpha, double cosine, int points) {
    InterfaceAlbedos sum{{0.0, 0.0}, {0.0, 0.0}, {0.0, 0.0}};
    integrate(ior, alpha, cosine, points, sum);
    return sum;
}

EnergyTables::EnergyTables(double ior)
    : ior_(ior),
      mean_blend_(mean_blend_of(ior)),
      table_([&](double alpha, double cosine) {
          const Albedos a = integrate_albedos(ior, alpha, cosine, kPoints);
          return std::array<double, 2>{a.reflect, relative_blend(a, dielectric_blend(cosine, ior))};
      }),
      means_([&](const AlbedoRow& row, double cosine) {
          const Albedos a = at(row, cosine);
          return std::array<double, 2>{a.reflect, a.reflect_blend};
      }) {}

Albedos EnergyTables::at(const AlbedoRow& row, double cosine) const {
    const auto [reflect, relative] = table_.at(row, cosine);
    return {reflect, absolute_blend(reflect, relative, dielectric_blend(cosine, ior_))};
}

Albedos EnergyTables::mean(double alpha) const {
    const auto [reflect, reflect_blend] = means_.of(alpha);
    return {reflect, reflect_blend};
}

InterfaceTables::InterfaceTables(double ior)
    : ior_(ior),
      table_([&](double alpha, double cosine) {
          return numbers_of(integrate_interface_albedos(ior, alpha, cosine, kPointsOfInterface));
      }),
      means_([&](const AlbedoRow& row, double cosine) { return table_.at(row, cosine); }) {}

InterfaceAlbedos InterfaceTables::at(const AlbedoRow& row, double cosine) const {
    return albedos_of(table_.at(row, cosine));
}

InterfaceAlbedos InterfaceTables::mean(double alpha) const {
    return albedos_of(means_.of(alpha));
}

namespace {

// Tables that are kept, or made.
template <class Tables>
const Tables& find_tables(float ior) {
    if (!(ior >= 1.0f && ior <= 10.0f))
        throw Error(ExitCode::BadData, "ior must lie between 1 and 10, got " + std::to_string(ior));
    static std::shared_mutex mutex;
    static std::map<float, std::unique_ptr<const Tables>> kept;
    {
        const std::shared_lock lock(mutex);
        if (const auto found = kept.find(ior); found != kept.end())
            return *found->second;
    }
    // Made outside the lock: a thread that waits for its parallel loop may be given work that needs tables, too.
    auto made = std::make_unique<const Tables>(ior);
    const std::unique_lock lock(mutex);
    return *kept.try_emplace(ior, std::move(made)).first->second;
}

// Every vertex of a path asks, most often for what its thread asked for last: no lock is taken then.
template <class Tables>
const Tables& tables_of(float ior) {
    thread_local const Tables* last = nullptr;
    if (last == nullptr || static_cast<float>(last->ior()) != ior)
        last = &find_tables<Tables>(ior);
    return *last;
}

}  // namespace

const EnergyTables& energy_tables(float ior) {
    return tables_of<EnergyTables>(ior);
}

const InterfaceTables& interface_tables(float ior) {
    return tables_of<InterfaceTables>(ior);
}

}  // namespace brisance
