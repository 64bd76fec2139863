// Virtual spherical lights: the power of a light leaves a sphere around it, uniformly over its cross-section, and is
// visible where its centre is.
//
// M. Hasan, J. Krivanek, B. Walter, K. Bala, Virtual Spherical Lights for Many-Light Rendering of Glossy Scenes, ACM
// Transactions on Graphics 28(5), 2009.
#pragma once

#include <numbers>

#include "virtual_lights/kinds/kind.h"
#include "virtual_lights/kinds/shadow_ray.h"
#include "virtual_lights/kinds/sphere_sampling.h"

namespace brisance {

// How many of the directions toward one sphere each technique samples: the sphere's cone, the BSDF of the vertex (BRDF
// 1 of the paper) and that of the light (BRDF 2). Combined, half of them or more are of the cone; the balance heuristic
// weights all.
struct SphereTechniques {
    int cone = 0, vertex = 0, light = 0;

    // `lobed_light`: the light's BSDF has lobes other than Lambert's.
    SphereTechniques(SphereSampling sampling, int samples, bool lobed_light);
};

// Directions that leave a light by its own BSDF; by Lambert's lobe, where the flux came from many directions.
class LightLobe {
public:
    // Keeps a reference.
    LightLobe(const VirtualLight& light, std::optional<Bsdf> bsdf) : light_(light), bsdf_(std::move(bsdf)) {}

    bool has_lobes() const { return bsdf_.has_value(); }
    double pdf(const dvec3& leaving) const;  // [1/sr]
    std::optional<dvec3> sample(Rng& rng) const;

private:
    const VirtualLight& light_;
    std::optional<Bsdf> bsdf_;
};

// The radius of each light is its distance to the neighbour of number settings.sphere_neighbours, times
// settings.sphere_scale.
void widen_to_neighbours(LightSet& set);

struct SphereKind {
    static constexpr const char* kNeeds = "any flux";

    template <LightFlux Flux>
    class Of {
    public:
        static void fit(LightSet& set) { widen_to_neighbours(set); }

        explicit Of(const LightSet& set) : set_(set), flux_(set) {}

        dvec3 sample(std::size_t light, const PathVertex& vertex, Rng& rng) const {
            return sample_toward(set_.lights[light], vertex.lit(), rng);
        }

        dvec3 direction(std::size_t light, const PathVertex& vertex, const glm::dvec2& numbers) const {
            return direction_toward(set_.lights[light], vertex.lit(), numbers);
        }

        double pdf(std::size_t light, const PathVertex& vertex, const dvec3& direction) const {
            return pdf_toward(set_.lights[light], vertex.lit(), direction);
        }

        Rgb radiance(std::size_t index, const PathVertex&, const dvec3& direction) const {
            const VirtualLight& light = set_.lights[index];
            return flux_.intensity(light, -direction) / float(std::numbers::pi * light.radius * light.radius);
        }

        Rgb connect(const Connection& c, const PathVertex& vertex, float factor, Rng& rng) const {
            return connect_by_shadow_ray(set_.scene(), vertex, set_.lights[c.light], c, factor, rng);
        }

        bool reaches(const Connection& c, const PathVertex& vertex) const {
            return shadow_ray(set_.scene(), vertex, set_.lights[c.light]).clear;
        }

        Rgb estimate(std::size_t index, double probability, const PathVertex& vertex, Rng& rng) const {
            const VirtualLight& light = set_.lights[index];
            const ShadowRay shadow = shadow_ray(set_.scene(), vertex, light);
            if (!shadow.clear)
                return Rgb(0.0f);
            const Rgb sum = sum_of_directions(light, vertex, rng);
            const double transmittance = set_.scene().lines().transmittance(shadow.ray, shadow.distance, rng);
            return sum * float(transmittance / (std::numbers::pi * light.radius * light.radius * probability));
        }

    private:
        LightLobe lobe_of(const VirtualLight& light) const {
            if constexpr (LobedFlux<Flux>)
                return {light, flux_.lobes(light)};
            else
                return {light, std::nullopt};
        }

        // Scattered intensity of the light over the density of the directions [W/m^2 times area, per sr].
        Rgb sum_of_directions(const VirtualLight& light, const PathVertex& vertex, Rng& rng) const {
            const VirtualLightSettings& s = set_.settings();
            const LightLobe lobe = lobe_of(light);
            const SphereTechniques draws(s.sphere_sampling, s.sphere_samples, lobe.has_lobes());
            Rgb sum(0.0f);
            const auto add = [&](const dvec3& direction) {
                const PathVertex::Value scattered = vertex.at(direction);
                const Rgb through = scattered.value * flux_.intensity(light, -direction);
                if (through == Rgb(0.0f))
                    return;
                double density = draws.vertex * scattered.pdf;
                if (draws.cone > 0)
                    density += draws.cone * pdf_toward(light, vertex.lit(), direction);
                if (draws.light > 0)
                    density += draws.light * lobe.pdf(-direction);
                sum += through / float(density);
            };
            for (int i = 0; i < draws.cone; ++i)
                add(sample_toward(light, vertex.lit(), rng));
            for (int i = 0; i < draws.vertex; ++i)
                if (const std::optional<PathVertex::Sample> s = vertex.sample(rng);
                    s && !s->delta && leads_into(light, vertex.lit(), s->wi))
                    add(s->wi);
            for (int i = 0; i < draws.light; ++i)
                if (const std::optional<dvec3> leaving = lobe.sample(rng);
                    leaving && leads_into(light, vertex.lit(), -*leaving))
                    add(-*leaving);
            return sum;
        }

        const LightSet& set_;
        Flux flux_;
    };
};

}  // namespace brisance
