#include "pixel_sharing/share_light.h"

#include <cmath>

#include "pixel_sharing/shown_area.h"

namespace brisance {

namespace {

// Glossy lobes reflect at grazing angles what the colour of their metal does not hold: light is divided by no less.
constexpr float kLeastColour = 0.04f;

}  // namespace

// About twice the width of the slopes of microfacets. It stays below a base's, and rises with roughness throughout:
// pixels tell lobes by it.
float width_of_gloss(float roughness) {
    constexpr float kWidest = 0.7f;
    return kWidest * -std::expm1(-2.0f * roughness * roughness / kWidest);
}

Rgb colour_of_gloss(const SurfaceMaterial& m) {
    return glm::max(glm::mix(Rgb(1.0f), m.base_colour, m.metallic), Rgb(kLeastColour));
}

SharedBounce::Sample share_light(const SurfaceSample& sample, const SurfacePoint& point, const dvec3& arriving,
                                 double pixel_angle, const LightToShare& of) {
    const double from_eye = glm::distance(point.position, sample.ray.origin);
    SharedBounce::Sample out;
    out.pixel = sample.pixel;
    out.position = vec3(point.position);
    out.normal = vec3(point.frame.normal);
    out.pixel_size = float(pixel_angle * from_eye);
    out.area = shown_area(point, arriving, out.pixel_size);
    out.lobe = of.lobe;
    for (int c = 0; c < 3; ++c)
        if (of.colour[c] > 0.0f) {
            out.light[c] = of.light[c] / of.colour[c];
            for (std::size_t k = 0; k < SharedBounce::kAparts; ++k)
                out.apart[k][c] = of.apart[k][c] / of.colour[c];
        }
    out.weight = sample.share * of.colour;
    out.closeness = float(of.closeness.value_or(0.0));
    // Along a glossy surface the direction to the eye changes, too.
    if (of.lobe < 1.0f && out.closeness > 0.0f)
        out.closeness += float(1.0 / from_eye);
    return out;
}

CellSum shown_by_cell(const SharedBounce::Sample& sample) {
    using Apart = SharedBounce::Apart;
    CellSum out;
    out.at(Cell::SS) = sample.weight * sample.light;
    out.at(Cell::SV) = sample.weight * sample.of(Apart::SV);
    out.at(Cell::SM) = sample.weight * sample.of(Apart::SM);
    out.at(Cell::SA) = sample.weight * sample.of(Apart::SA);
    return out;
}

}  // namespace brisance
