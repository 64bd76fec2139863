// Black bodies from 0 K to 1e5 K, and grids filled with the largest half float.
#include <fmt/format.h>

#include "stability/closed_forms.h"
#include "stability/scenes.h"

namespace brisance::stability {

namespace {

constexpr int kNodes = 16;
constexpr double kEdge = 0.1;
constexpr float kLargestHalf = 65504.0f;

// Opaque smoke at one temperature shows the luminance of its black body. Held against V(lambda) as tabulated; the
// renderer integrates an analytic fit to the observer.
Case black_body(double kelvin) {
    Case c;
    c.name = fmt::format("emission/{:g}K", kelvin);
    c.truth = kelvin < 500.0 ? "nothing visible: exactly 0" : "Planck's law under the CIE 1924 V(lambda)";
    c.scatters_twice = false;
    c.tolerance = {kelvin < 500.0 ? 0.0 : 0.015, kelvin < 500.0 ? 0.0 : 0.015, "analytic fit to the observer"};
    c.scene = [=] {
        media::Recipe r = absorbing_slab(kNodes, kEdge, 10.0);
        r.flame = nullptr;
        r.temperature = [=](const ivec3&) { return static_cast<float>(kelvin); };
        r.settings.fire.model = FireModel::Blackbody;
        r.settings.fire.temperature_kelvin = {0.0f, 1.0f};
        return scene_of(r, camera_on_slab(kNodes, kEdge), 16);
    };
    // The mean over pixels and channels, weighted as luminance is, so that colour does not matter.
    c.measure = [=](const Scene&, const RenderedFrame& frame, const Method&, const Render&) {
        const std::vector<float>& p = frame.image.layer("").pixels;
        double found = 0.0;
        for (std::size_t i = 0; i < p.size(); i += 4)
            found += luminance({p[i], p[i + 1], p[i + 2]}) / (p.size() / 4.0);
        const double truth = kelvin < 500.0 ? 0.0 : blackbody_luminance(kelvin);
        return Measured{truth > 0.0 ? std::abs(found / truth - 1.0) : found, 0.0};
    };
    c.quick = true;
    return c;
}

Case largest_half(bool direct) {
    Case c;
    c.name = direct ? "emission/half-maximum-direct" : "emission/half-maximum";
    c.truth = direct ? "emission / extinction" : "the grid's own value";
    c.scatters_twice = false;
    c.tolerance = {3e-5, 3e-5, "single precision; rays may end at a transmittance of 1e-5"};
    c.scene = [=] {
        media::Recipe r = absorbing_slab(kNodes, kEdge, kEdge);
        r.density = [](const ivec3& n) { return n.z >= 0 && n.z < kNodes ? kLargestHalf : 0.0f; };
        r.flame = direct ? r.density : [](const ivec3&) { return kLargestHalf; };
        r.settings.fire.convention = direct ? EmissionConvention::Direct : EmissionConvention::TimesAbsorption;
        return scene_of(r, camera_on_slab(kNodes, kEdge), 16);
    };
    c.measure = every_pixel_is(Rgb(direct ? 1.0f : kLargestHalf));
    return c;
}

Case largest_half_scattering() {
    Case c;
    c.name = "emission/half-maximum-scattering";
    c.truth = "sqrt(1 - albedo) H(1)";
    c.tolerance = {0.03, 0.005, "as depth/scattering"};
    c.scene = [] {
        media::Recipe r = absorbing_slab(kNodes, kEdge, kEdge);
        r.density = [](const ivec3& n) { return n.z >= 0 && n.z < kNodes ? kLargestHalf : 0.0f; };
        r.flame = [](const ivec3&) { return kLargestHalf; };
        r.settings.smoke.albedo = Rgb(0.8f);
        return scene_of(r, camera_on_slab(kNodes, kEdge), 512);
    };
    c.measure = [](const Scene& scene, const RenderedFrame& frame, const Method& method, const Render& render) {
        const Rgb truth(static_cast<float>(kLargestHalf * isothermal_half_space(0.8, 1.0)));
        return every_pixel_is(truth)(scene, frame, method, render);
    };
    return c;
}

}  // namespace

std::vector<Case> emission_cases() {
    return {black_body(0.0),     black_body(100.0),  black_body(2045.0),       black_body(1e5),
            largest_half(false), largest_half(true), largest_half_scattering()};
}

}  // namespace brisance::stability
