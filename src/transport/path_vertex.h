// A place where a path turns: in the smoke, by the phase function, or on a surface, by its BSDF.
#pragma once

#include <optional>

#include "core/rng.h"
#include "emitters/light_tree.h"
#include "geometry/surface_point.h"

namespace brisance {

class PathVertex {
public:
    // Of smoke. `arriving`: unit, the direction of the path's travel toward here.
    PathVertex(const dvec3& position, const dvec3& arriving, float mean_cosine);
    PathVertex(const SurfacePoint& point, const dvec3& arriving);
    // Of these of its lobes.
    PathVertex(const SurfacePoint& point, const Bsdf& bsdf, const dvec3& arriving);

    bool on_surface() const { return surface_.has_value(); }
    const dvec3& position() const { return lit_.position; }
    const LitPoint& lit() const { return lit_; }
    const dvec3& arriving() const { return arriving_; }
    // Nothing can be asked of it but sample().
    bool only_delta() const { return only_delta_; }

    // A ray that starts here, clear of the surface.
    Ray leaving(const dvec3& direction) const;
    // The same toward a place, and the distance to it.
    Ray toward(const dvec3& place, double& distance) const;

    // Phase function, or BSDF times cosine, and the density that sample() draws by [1/sr]; without delta lobes.
    struct Value {
        Rgb value{0.0f};
        double pdf = 0.0;
    };
    Value at(const dvec3& wi) const;

    struct Sample {
        dvec3 wi;
        Rgb weight{1.0f};  // value over pdf
        double pdf = 0.0;
        bool delta = false;
    };
    std::optional<Sample> sample(Rng& rng) const;
    // The same for a particle, which carries power along `arriving` and on: the adjoint, with the factor that shading
    // normals ask for (Veach, Robust Monte Carlo Methods, 1997, section 5.3).
    std::optional<Sample> sample_particle(Rng& rng) const;

private:
    LitPoint lit_;
    dvec3 arriving_;
    float mean_cosine_ = 0.0f;
    bool only_delta_ = false;
    // Together, so that smoke, which asks for neither, does not pay for them.
    struct OnSurface {
        SurfacePoint point;
        Bsdf bsdf;
    };
    std::optional<OnSurface> surface_;
};

// A direction drawn in proportion to the Henyey-Greenstein phase function about `forward`.
dvec3 sample_henyey_greenstein(const dvec3& forward, float mean_cosine, Rng& rng);

}  // namespace brisance
