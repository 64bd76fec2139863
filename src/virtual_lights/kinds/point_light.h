// Virtual point lights: the power of a light at its centre, with a bound on the geometry term.
//
// Lights that reflect by the Lambert base of their material alone make no streaks, and lose what the material's other
// lobes reflect (M. Hasan et al., Virtual Spherical Lights for Many-Light Rendering of Glossy Scenes, 2009, section 3).
#pragma once

#include <algorithm>
#include <numbers>

#include "virtual_lights/kinds/bounded_geometry.h"
#include "virtual_lights/kinds/kind.h"
#include "virtual_lights/kinds/shadow_ray.h"

namespace brisance {

struct PointKind {
    static constexpr const char* kNeeds = "any flux";

    template <LightFlux Flux>
    class Of {
    public:
        static constexpr bool kHasBound = true;

        static void fit(LightSet& set) {
            for (VirtualLight& light : set.lights)
                light.radius = 0.0;
        }

        explicit Of(const LightSet& set) : set_(set), flux_(set) {}

        dvec3 sample(std::size_t light, const PathVertex& vertex, Rng&) const {
            return direction(light, vertex, glm::dvec2(0.0));
        }

        dvec3 direction(std::size_t light, const PathVertex& vertex, const glm::dvec2&) const {
            return glm::normalize(set_.lights[light].position - vertex.position());
        }

        double pdf(std::size_t, const PathVertex&, const dvec3&) const { return 1.0; }

        // The vertex's cosine belongs to its BSDF.
        Rgb radiance(std::size_t light, const PathVertex& vertex, const dvec3& direction) const {
            const Sent whole = sent(light, vertex, direction);
            if (!bounds_contributions() || whole.radiance == Rgb(0.0f))
                return whole.radiance;
            return whole.radiance * float(kept(whole.radiance * vertex.at(direction).value));
        }

        BoundedLight connect(const Connection& c, const PathVertex& vertex, float factor, Rng& rng) const {
            double kept_in_all = geometry(c.light, vertex, c.direction).kept;
            if (bounds_contributions())
                kept_in_all *= kept(sent(c.light, vertex, c.direction).radiance * c.scattered.value);
            return bounded_to(kept_in_all,
                              connect_by_shadow_ray(set_.scene(), vertex, set_.lights[c.light], c, factor, rng));
        }

        bool reaches(const Connection& c, const PathVertex& vertex) const {
            return shadow_ray(set_.scene(), vertex, set_.lights[c.light]).clear;
        }

        BoundedLight estimate(std::size_t index, double probability, const PathVertex& vertex, Rng& rng) const {
            const dvec3 direction = sample(index, vertex, rng);
            const auto [reflected, of_geometry] = sent(index, vertex, direction);
            Rgb scattered = reflected == Rgb(0.0f) ? Rgb(0.0f) : reflected * vertex.at(direction).value;
            if (scattered == Rgb(0.0f))
                return {};
            const ShadowRay shadow = shadow_ray(set_.scene(), vertex, set_.lights[index]);
            if (!shadow.clear)
                return {};
            const double of_all = kept(scattered);
            scattered *= float(of_all);
            return bounded_to(
                of_geometry * of_all,
                scattered * float(set_.scene().lines().transmittance(shadow.ray, shadow.distance, rng) / probability));
        }

    private:
        struct Geometry {
            double square = 0.0;  // of the distance [m^2]; 0: the light sends nothing there
            double kept = 1.0;    // by the bound
        };
        struct Sent {
            Rgb radiance{0.0f};  // with the bound on geometry alone
            double kept = 1.0;   // by that
        };

        bool bounds_contributions() const { return set_.settings().contribution_bound != kUnbounded; }
        double kept(const Rgb& added) const { return kept_of_contribution(set_.settings(), added); }

        Geometry geometry(std::size_t index, const PathVertex& vertex, const dvec3& direction) const {
            const VirtualLight& light = set_.lights[index];
            const dvec3 offset = light.position - vertex.position();
            const double square = glm::dot(offset, offset), cosine = -glm::dot(light.frame.normal, direction);
            if (!(cosine > 0.0) || !(square > 0.0))
                return {};
            return {square, kept_by_bound(set_.settings(), vertex.lit(), direction, cosine, square)};
        }

        Sent sent(std::size_t index, const PathVertex& vertex, const dvec3& direction) const {
            const Geometry g = geometry(index, vertex, direction);
            if (!(g.square > 0.0))
                return {};
            return {flux_.intensity(set_.lights[index], -direction) * float(g.kept / g.square), g.kept};
        }

        const LightSet& set_;
        Flux flux_;
    };
};

// The flux of the Lambert base alone.
class BaseFlux {
public:
    explicit BaseFlux(const LightSet&) {}

    // Along unit `toward` [W/sr].
    Rgb intensity(const VirtualLight& light, const dvec3& toward) const {
        const double cosine = std::max(0.0, glm::dot(light.frame.normal, toward));
        return light.base_flux * float(cosine / std::numbers::pi);
    }
};

struct DiffusePointKind {
    static constexpr const char* kNeeds = "any flux";

    template <LightFlux Flux>
    using Of = PointKind::Of<BaseFlux>;
};

}  // namespace brisance
