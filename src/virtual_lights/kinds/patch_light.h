// Patches of surface: lights are interpolated over the surface that they cover, and a ray toward one is decided by what
// it meets there, so that nothing is seen through walls.
#pragma once

#include <functional>
#include <numbers>

#include "virtual_lights/kinds/kind.h"
#include "virtual_lights/kinds/sphere_sampling.h"

namespace brisance {

// Calls visit(hit, share of a path that ends there) where the connection's ray meets surface that its light covers, and
// others may, and where paths end in part at least.
using VisitPatch = std::function<void(const CoveredHit& hit, double terminated)>;
void meet_patch(const LightSet& set, const Connection& connection, const PathVertex& vertex, const VisitPatch& visit);

// The part of one light in what the vertex scatters from that direction, if a ray toward the light's sphere meets
// surface that it covers.
Rgb incident_from_patch(const LightSet& set, const Connection& connection, const PathVertex& vertex, Rng& rng);

// Whether that is more than nothing, smoke aside.
bool patch_is_met(const LightSet& set, const Connection& connection, const PathVertex& vertex);

struct PatchKind {
    static constexpr const char* kNeeds = kSurfaceFlux;

    template <SurfaceFlux Flux>
    class Of {
    public:
        static void fit(LightSet&) {}

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

        // Of a Lambert surface as if it were white: its colour is that of the point where a ray meets it.
        Rgb radiance(std::size_t index, const PathVertex&, const dvec3& direction) const {
            const VirtualLight& light = set_.lights[index];
            const Rgb sent = flux_.surface_light(light, -direction);
            return light.profile < 0 ? sent / std::numbers::pi_v<float> : sent;
        }

        Rgb radiance_at(const CoveredHit& hit, int share) const { return set_.reflected(hit, share); }

        void meet(const Connection& connection, const PathVertex& vertex, const VisitPatch& visit) const {
            meet_patch(set_, connection, vertex, visit);
        }

        Rgb incident(const Connection& connection, const PathVertex& vertex, Rng& rng) const {
            return incident_from_patch(set_, connection, vertex, rng);
        }

        Rgb connect(const Connection& connection, const PathVertex& vertex, float factor, Rng& rng) const {
            return factor * incident(connection, vertex, rng);
        }

        bool reaches(const Connection& connection, const PathVertex& vertex) const {
            return patch_is_met(set_, connection, vertex);
        }

        Rgb estimate(std::size_t light, double probability, const PathVertex& vertex, Rng& rng) const {
            Connection connection{light, sample(light, vertex, rng), {}, {}};
            connection.scattered = vertex.at(connection.direction);
            if (connection.scattered.value == Rgb(0.0f))
                return Rgb(0.0f);
            const double density = probability * pdf(light, vertex, connection.direction);
            if (!(density > 0.0))
                return Rgb(0.0f);
            return incident(connection, vertex, rng) / float(density);
        }

    private:
        const LightSet& set_;
        Flux flux_;
    };
};

}  // namespace brisance
