// What a kind of virtual light is to a gatherer. Abilities are concepts: a gatherer exists for the kinds that have what
// it needs, and for no others (technique.cpp).
#pragma once

#include <concepts>

#include "transport/path_vertex.h"
#include "virtual_lights/bounded_light.h"
#include "virtual_lights/light_set.h"

namespace brisance {

// A direction from a path vertex toward a light, and the light that would be scattered if nothing stood between.
struct Connection {
    std::size_t light = 0;
    dvec3 direction{0.0};
    PathVertex::Value scattered;  // by the vertex, from that direction
    Rgb radiance{0.0f};           // of the light, as Kind::radiance()
};

// Lights are given by their index in the set.
template <class Kind>
concept VirtualLightKind = requires(const Kind& kind, LightSet& set, std::size_t light, const PathVertex& vertex,
                                    const dvec3& direction, const glm::dvec2& numbers, const Connection& connection,
                                    double factor, Rng& rng) {
    // Sets what the kind decides of the lights: their radius.
    Kind::fit(set);
    Kind(set);
    // A unit direction toward the light.
    { kind.sample(light, vertex, rng) } -> std::same_as<dvec3>;
    // The one that sample() makes of two random numbers in [0, 1).
    { kind.direction(light, vertex, numbers) } -> std::same_as<dvec3>;
    // Of a direction that leads to the light [1/sr]; 1 for a kind that has only one direction.
    { kind.pdf(light, vertex, direction) } -> std::same_as<double>;
    // What the light sends to the vertex, without occlusion [W/(m^2 sr)]; of a kind with one direction the irradiance
    // across it [W/m^2].
    { kind.radiance(light, vertex, direction) } -> std::same_as<Rgb>;
    // The connection's scattered light with occlusion, times a factor, and what a bound takes of it.
    { kind.connect(connection, vertex, float(factor), rng) } -> std::convertible_to<BoundedLight>;
    // Whether surfaces let any of it through.
    { kind.reaches(connection, vertex) } -> std::same_as<bool>;
    // An estimate of what the vertex scatters of the whole light, over the probability of having chosen that; likewise.
    { kind.estimate(light, factor, vertex, rng) } -> std::convertible_to<BoundedLight>;
};

// A ray can hit lights of this kind: BSDF sampling and multiple importance sampling work, and paths can be extended.
template <class Kind>
concept Hittable = VirtualLightKind<Kind> &&
    requires(const Kind& kind, const CoveredHit& hit, int share, const Connection& connection, const PathVertex& vertex,
             Rng& rng, void (*visit)(const CoveredHit&, double)) {
    // Calls visit(hit, share of a path that ends there) if a ray along the connection meets surface that its light
    // covers, and others may.
    { kind.meet(connection, vertex, visit) } -> std::same_as<void>;
    // Of one of the lights that cover the hit [W/(m^2 sr)].
    { kind.radiance_at(hit, share) } -> std::same_as<Rgb>;
    // connect() with the factor 1.
    { kind.incident(connection, vertex, rng) } -> std::same_as<Rgb>;
};
inline constexpr const char* kHittable = "a kind of light that rays can hit";

// Some of the light is lost to a bound, and paths can find it (bounded_geometry.h).
template <class Kind>
concept Bounded = VirtualLightKind<Kind> && Kind::kHasBound;

// What a kind of light is to be built of.
template <class Flux>
concept LightFlux = requires(const Flux& flux, LightSet& set, const VirtualLight& light, const dvec3& toward) {
    Flux(set);
    { flux.intensity(light, toward) } -> std::same_as<Rgb>;  // [W/sr]
};

// Flux that is spread over surface, where a ray can find it.
template <class Flux>
concept SurfaceFlux = LightFlux<Flux> && requires(const Flux& flux, const VirtualLight& light, const dvec3& toward) {
    { flux.surface_light(light, toward) } -> std::same_as<Rgb>;
};
inline constexpr const char* kSurfaceFlux = "flux that covers surface";

// Flux that came from one direction, so that directions can be sampled by the light's own BSDF.
template <class Flux>
concept LobedFlux = LightFlux<Flux> && requires(const Flux& flux, const VirtualLight& light) {
    { flux.lobes(light) } -> std::same_as<std::optional<Bsdf>>;
};

}  // namespace brisance
