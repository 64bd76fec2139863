#include "medium_lighting/stages/virtual_lights_as_points.h"

#include <algorithm>
#include <numbers>

#include "medium/sh.h"
#include "medium_lighting/surface_occluders.h"

namespace brisance {

namespace {

// Lambert's cosine lobe of flux 1 has the intensity cos / pi: per coefficient of degrees 1 and 2, times the harmonic of
// the normal (Ramamoorthi and Hanrahan, An Efficient Representation for Irradiance Environment Maps, 2001).
constexpr float kDegree1 = 2.0f / 3.0f, kDegree2 = 0.25f;

// Normal of that plane.
constexpr vec3 kAside(0.517f, 0.382f, 0.766f);

void add_point(const dvec3& position, const vec3& normal, const Rgb& flux, PointLights& out) {
    if (!(luminance(flux) > 0.0f))
        return;
    out.position.emplace_back(position);
    out.intensity.push_back(flux / (4.0f * std::numbers::pi_v<float>));
    out.normal.push_back(normal);
    const auto basis = sh_basis(normal);
    for (int m = 0; m < kShMoments; ++m)
        for (int c = 0; c < 3; ++c)
            out.directional.push_back(flux[c] * (m < 3 ? kDegree1 : kDegree2) * basis[m]);
}

}  // namespace

PointsOfSides points_of_virtual_lights(const VirtualLights& lights, float share, float spacing) {
    const double clear = clear_of_surfaces(spacing);
    PointsOfSides sides;
    for (std::size_t i = 0; i < lights.lights().size(); ++i) {
        const VirtualLight& light = lights.lights()[i];
        const Rgb flux = share * light.base_flux;
        const double above = std::max({kAboveSurface * light.radius, light.clearance, clear});
        PointLights& out = sides[glm::dot(vec3(light.frame.normal), kAside) < 0.0f];
        const std::span<const FluxSpot> spots = lights.spots().of(i);
        if (spots.empty())
            add_point(light.position + above * light.frame.normal, vec3(light.frame.normal), flux, out);
        for (const FluxSpot& spot : spots)
            add_point(position_of(spot, light) + above * light.frame.normal, vec3(light.frame.normal), spot.part * flux,
                      out);
    }
    return sides;
}

}  // namespace brisance
