#include "surface_fixture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace brisance::testing {

namespace {

constexpr double kPi = std::numbers::pi;

SurfaceMaterial made_of(float metallic, float transmission, float ior = 1.5f) {
    SurfaceMaterial m;
    m.metallic = metallic;
    m.transmission = transmission;
    m.ior = ior;
    return m;
}

// A sampling technique for directions and its density [1/sr], which is 0 on the side that it does not sample. wo is
// above.
struct Technique {
    std::function<dvec3(double u, double v)> draw;
    std::function<double(const dvec3& wi)> density;
};

Technique mirrored_facets(const Ggx& ggx, const dvec3& wo) {
    return {[=](double u, double v) {
                const dvec3 h = ggx.sample_visible(wo, u, v);
                return 2.0 * glm::dot(wo, h) * h - wo;
            },
            [=](const dvec3& wi) {
                const dvec3 h = glm::normalize(wo + wi);
                return wi.z > 0.0 ? ggx.visible_density(wo, h) / (4.0 * glm::dot(wo, h)) : 0.0;
            }};
}

Technique refracting_facets(const Ggx& ggx, const dvec3& wo, double eta) {
    return {[=](double u, double v) {
                const dvec3 h = ggx.sample_visible(wo, u, v);
                return glm::refract(-wo, h, 1.0 / eta);  // 0 beyond the critical angle
            },
            [=](const dvec3& wi) {
                dvec3 h = glm::normalize(wo + eta * wi);
                h = h.z < 0.0 ? -h : h;
                const double o = glm::dot(wo, h), i = glm::dot(wi, h);
                if (wi.z >= 0.0 || o <= 0.0 || i >= 0.0)
                    return 0.0;
                return ggx.visible_density(wo, h) * eta * eta * -i / ((o + eta * i) * (o + eta * i));
            }};
}

// Half of it around cosines of `width`, for 0 < width <= 1.
Technique along_surface(double width, double sign) {
    const double square = width * width, log = std::log1p(1.0 / square);
    return {[=](double u, double v) {
                const double cosine = std::min(1.0, width * std::sqrt(std::expm1(u * log)));
                const double sine = std::sqrt(1.0 - cosine * cosine);
                return dvec3(sine * std::cos(2.0 * kPi * v), sine * std::sin(2.0 * kPi * v), sign * cosine);
            },
            [=](const dvec3& wi) {
                const double cosine = std::max(0.0, sign * wi.z);
                return cosine / (kPi * (cosine * cosine + square) * log);
            }};
}

Technique lambert() {
    return {[](double u, double v) {
                const double r = std::sqrt(u);
                return dvec3(r * std::cos(2.0 * kPi * v), r * std::sin(2.0 * kPi * v), std::sqrt(1.0 - u));
            },
            [](const dvec3& wi) { return std::max(0.0, wi.z) / kPi; }};
}

}  // namespace

std::vector<NamedSurface> conserving_surfaces() {
    SurfaceMaterial blend = made_of(0.3f, 0.5f);
    SurfaceMaterial weak = made_of(0.0f, 1.0f);
    weak.specular = 0.3f;
    SurfaceMaterial sheet = made_of(0.0f, 1.0f), half_sheet = made_of(0.2f, 0.5f);
    sheet.thin = half_sheet.thin = true;
    return {{"conductor", made_of(1.0f, 0.0f)},
            {"coated diffuse", made_of(0.0f, 0.0f)},
            {"heavily coated diffuse", made_of(0.0f, 0.0f, 2.4f)},
            {"glass from outside", made_of(0.0f, 1.0f)},
            {"glass from inside", made_of(0.0f, 1.0f), -1.0},
            {"diamond from outside", made_of(0.0f, 1.0f, 2.4f)},
            {"diamond from inside", made_of(0.0f, 1.0f, 2.4f), -1.0},
            {"thin index from outside", made_of(0.0f, 1.0f, 1.05f)},
            {"thin index from inside", made_of(0.0f, 1.0f, 1.05f), -1.0},
            {"weakly reflecting glass from outside", weak},
            // Its Fresnel term jumps to 1 at the critical angle, which tables blur.
            {"weakly reflecting glass from inside", weak, -1.0, 2e-3},
            {"sheet", sheet},
            {"blend with a sheet", half_sheet},
            {"blend of all", blend}};
}

std::vector<NamedSurface> coloured_surfaces() {
    std::vector<NamedSurface> all;
    for (const double side : {1.0, -1.0})
        for (const float metallic : {0.0f, 0.4f, 1.0f})
            for (const float transmission : {0.0f, 0.6f, 1.0f})
                for (const float ior : {1.0f, 1.5f, 2.4f}) {
                    SurfaceMaterial m = made_of(metallic, transmission, ior);
                    m.base_colour = Rgb(0.9f, 0.5f, 0.0f);
                    m.specular = 0.7f;
                    m.specular_colour = Rgb(0.2f, 1.0f, 3.0f);
                    const std::string name = "metallic " + std::to_string(metallic) + ", transmission " +
                                             std::to_string(transmission) + ", ior " + std::to_string(ior);
                    all.push_back({name, m, side});
                    if (transmission == 0.0f || side < 0.0)
                        continue;
                    m.thin = true;
                    all.push_back({name + ", thin", m, side});
                }
    return all;
}

dvec3 direction(double cosine, double azimuth) {
    const double sine = std::sqrt((1.0 - cosine) * (1.0 + cosine));
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

double alpha_of(const SurfaceMaterial& material) {
    return std::max(double(material.roughness) * material.roughness, kSmoothAlpha);
}

Rgb integrate_sphere(const SurfaceMaterial& material, const dvec3& wo, const std::function<Rgb(const dvec3&)>& f,
                     int points) {
    const bool inside = wo.z < 0.0;
    const dvec3 above(wo.x, wo.y, std::abs(wo.z));
    const Ggx ggx{alpha_of(material)};
    std::vector<Technique> techniques{mirrored_facets(ggx, above), along_surface(ggx.alpha, 1.0),
                                      along_surface(ggx.alpha, -1.0), lambert()};
    if (material.ior >= kMatchedIor)
        techniques.push_back(refracting_facets(ggx, above, inside ? 1.0 / material.ior : material.ior));
    int count = 1, step = 1;
    while (count < points)
        step = std::exchange(count, count + step);
    dvec3 sum(0.0);
    for (const Technique& technique : techniques)
        for (int i = 0; i < count; ++i) {
            // Finer towards the tail at v = 1 of visible normals.
            const double y = (i + 0.5) / count, v = 1.0 - y * y * y;
            const dvec3 wi = technique.draw(double(std::int64_t(i) * step % count) / count, v);
            double density = 0.0;
            if (technique.density(wi) > 0.0)
                for (const Technique& other : techniques)
                    density += other.density(wi);
            if (density > 0.0)
                sum += dvec3(f(inside ? dvec3(wi.x, wi.y, -wi.z) : wi)) * (3.0 * y * y / (density * count));
        }
    return Rgb(sum);
}

std::vector<BsdfSample> delta_lobes(const Bsdf& bsdf, const dvec3& wo, Transport transport) {
    std::vector<BsdfSample> lobes;
    for (int i = 0; i < 1000; ++i) {
        const auto s = bsdf.sample(wo, dvec3((i + 0.5) / 1000.0, 0.5, 0.5), transport);
        if (s && s->delta && std::none_of(lobes.begin(), lobes.end(), [&](const BsdfSample& known) {
                return glm::dot(known.wi, s->wi) > 1.0 - 1e-9;
            }))
            lobes.push_back(*s);
    }
    return lobes;
}

Rgb directional_albedo(const SurfaceMaterial& material, const dvec3& wo) {
    const Bsdf bsdf(material, ShadingFrame{});
    Rgb sum =
        integrate_sphere(material, wo, [&](const dvec3& wi) { return bsdf.evaluate(wo, wi, Transport::Importance); });
    for (const BsdfSample& lobe : delta_lobes(bsdf, wo))
        sum += lobe.weight * static_cast<float>(lobe.pdf);
    return sum;
}

}  // namespace brisance::testing
