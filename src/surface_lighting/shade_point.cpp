// What one sample finds at its point (surface_shader.h).
#include <limits>
#include <utility>

#include "pixel_sharing/share_light.h"
#include "surface_lighting/lobe_numbers.h"
#include "surface_lighting/shaded_point.h"

namespace brisance {

namespace {

using Apart = SharedBounce::Apart;

constexpr Stream kGloss = stream_of("surface_lighting/gloss");

}  // namespace

// Adds the medium's light that the grids of fire and smoke do not hold: lights in the smoke, and glossy reflection.
void SurfaceShader::reflect_scattered(const SurfaceSample& sample, ShadedPoint& at, Rng& rng, CellSum& light) const {
    const SurfacePoint& point = at.seen.point;
    const dvec3 toward_viewer = -at.seen.arriving;
    const int light_samples =
        input_.in_scattering && has_wide_lobes(point.material) ? input_.in_scattering->gloss_samples() : 0;
    std::optional<GlossyLobes> gloss;
    if (medium_shines() && has_specular(point.material))
        gloss.emplace(point, toward_viewer, light_samples);
    if (input_.in_scattering) {
        const bool shared = gloss && light_samples > 0;
        const Bsdf base(point.material, point.frame, Lobes::Base);
        if (shared || has_base(point.material))
            light.at(Cell::SM) += input_.in_scattering->at_surface(
                point, ReceiverLobes(base, shared ? &gloss->split : nullptr), toward_viewer, at.ray_rng);
    }
    if (!gloss)
        return;
    CellSum found;
    const dvec3 numbers = lobe_numbers(kGloss, sample, input_.samples, input_.seed, rng);
    const double closeness = gloss_.reflect(point, toward_viewer, *gloss, numbers, at.ray_rng, found);
    if (shares_gloss(at) || shows_others(at))
        at.closeness = closeness;
    if (shares_gloss(at)) {
        at.of_gloss[std::size_t(Apart::SV)] = std::exchange(found.at(Cell::SV), Rgb(0.0f));
        at.of_gloss[std::size_t(Apart::SM)] = std::exchange(found.at(Cell::SM), Rgb(0.0f));
    }
    light.add(found, Rgb(1.0f));
}

// Whether pixels share what rough lobes reflect, whoever sent it. Of narrow lobes they share what is sampled there, the
// light between surfaces: a pixel's own samples of the medium and of emitters are stratified, and know more than halves
// of them tell.
bool SurfaceShader::shares_gloss(const ShadedPoint& at) const {
    const SurfaceMaterial& m = at.seen.point.material;
    return input_.shared && input_.shared->tells(Apart::SV) && at.seen.mirrors == 0 && has_specular(m) &&
           m.transmission == 0.0f && has_wide_lobes(m) && !shows_others(at);
}

VirtualLights::Shading SurfaceShader::shading(ShadedPoint& at) const {
    return {samples_through_panes() ? VirtualLights::Panes::Sampled : VirtualLights::Panes::Followed,
            &smoke_of_paths_,
            walks_,
            &at.vertices,
            nullptr,
            nullptr,
            input_.bound ? &at.bound : nullptr,
            input_.unified != nullptr};
}

// What the sample itself shows; the rest is left to all pixels, where they share it.
Rgb SurfaceShader::from_virtual_lights(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng,
                                       ShadedPoint& at) const {
    const SurfacePoint& point = at.seen.point;
    const bool reflected = shows_others(at);  // by shade_reflected()
    if (!input_.shared || at.seen.mirrors > 0) {
        if (!reflected)
            return shade_vertex(sample, vertex, Lobes::All, shading(at), rng, at);
        const std::optional<PathVertex> base = base_of(at);
        return base ? shade_vertex(sample, *base, Lobes::Base, shading(at), rng, at) : Rgb(0.0f);
    }
    if (has_base(point.material)) {
        const Bsdf base(point.material, point.frame, Lobes::Base);
        if (const Rgb albedo = base.base_albedo(-at.seen.arriving); albedo != Rgb(0.0f))
            at.base = shared_sample(sample, base, Lobes::Base, {.colour = albedo, .lobe = 1.0f}, rng, at);
    }
    if (!has_specular(point.material))
        return Rgb(0.0f);
    const LightToShare of_gloss{.colour = colour_of_gloss(point.material),
                                .lobe = width_of_gloss(point.material.roughness),
                                .closeness = at.closeness,
                                .apart = at.of_gloss};
    if (reflected) {
        if (input_.shared->tells(Apart::SV) && point.material.transmission == 0.0f)
            at.gloss = share_light(sample, point, at.seen.arriving, input_.pixel_angle, of_gloss);
        return Rgb(0.0f);
    }
    const Bsdf others(point.material, point.frame, Lobes::Specular);
    if (point.material.transmission > 0.0f || !has_wide_lobes(point.material))
        return shade_vertex(sample, PathVertex(point, others, at.seen.arriving), Lobes::Specular, shading(at), rng, at);
    at.gloss = shared_sample(sample, others, Lobes::Specular, of_gloss, rng, at);
    return Rgb(0.0f);
}

// By some lobes of the sample's surface. What they choose of the lights is left to samples around, where they reuse it.
Rgb SurfaceShader::shade_vertex(const SurfaceSample& sample, const PathVertex& vertex, Lobes which,
                                VirtualLights::Shading how, Rng& rng, ShadedPoint& at) const {
    if (!input_.reuse || at.seen.mirrors > 0 || vertex.only_delta())
        return input_.virtual_lights->shade(vertex, rng, how);
    LightReuse::Sample chosen{.pixel = sample.pixel, .number = sample.number, .vertex = vertex, .reservoir = {}};
    chosen.lobes = which;
    chosen.material = surroundings_.scene().meshes[sample.hit.mesh].material;
    chosen.from_eye = glm::distance(vertex.position(), sample.ray.origin);
    chosen.share = sample.share;
    how.reservoir = &chosen.reservoir;
    const Rgb light = input_.virtual_lights->shade(vertex, rng, how);
    at.chosen.push_back(std::move(chosen));
    return light;
}

// Of some lobes of the sample's surface, with their light between surfaces. What the lobes met may be known already.
SharedBounce::Sample SurfaceShader::shared_sample(const SurfaceSample& sample, const Bsdf& lobes, Lobes which,
                                                  LightToShare found, Rng& rng, ShadedPoint& at) const {
    VirtualLights::Shading how = shading(at);
    double distance = std::numeric_limits<double>::infinity();
    how.distance = &distance;
    how.blur = input_.shared->angle(found.lobe);
    const Rgb own_residual = std::exchange(at.bound.residual, Rgb(0.0f));
    found.light = shade_vertex(sample, PathVertex(at.seen.point, lobes, at.seen.arriving), which, how, rng, at);
    if (!at.chosen.empty())
        at.chosen.back().colour = found.colour;
    found.apart[std::size_t(Apart::Residual)] = std::exchange(at.bound.residual, own_residual);
    if (!found.closeness)
        found.closeness = 1.0 / distance;
    return share_light(sample, at.seen.point, at.seen.arriving, input_.pixel_angle, found);
}

// Even light from infinity that the base reflects is left to all pixels, where they share it.
Rgb SurfaceShader::from_emitters(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng,
                                 ShadedPoint& at) const {
    if (input_.unified)
        return emitters_.by_ray(sample, vertex, rng).all();
    const SurfacePoint& point = at.seen.point;
    const Bsdf base(point.material, point.frame, Lobes::Base);
    const Rgb albedo = input_.shared_sky && at.seen.mirrors == 0 ? base.base_albedo(-at.seen.arriving) : Rgb(0.0f);
    const bool shares = shares_gloss(at);
    if (albedo == Rgb(0.0f) && !shares)
        return emitters_.at(sample, vertex, rng).all();
    Rgb own(0.0f);
    if (has_base(point.material)) {
        const LightOfEmitters::Seen of_base = emitters_.at(sample, PathVertex(point, base, at.seen.arriving), rng);
        own = of_base.other;
        if (albedo == Rgb(0.0f))
            own += of_base.even;
        else
            at.sky = share_light(
                sample, point, at.seen.arriving, input_.pixel_angle,
                {.colour = albedo, .light = of_base.even, .lobe = 1.0f, .closeness = 1.0 / of_base.distance});
    }
    if (!has_specular(point.material))
        return own;
    const Bsdf others(point.material, point.frame, Lobes::Specular);
    const Rgb of_others = emitters_.at(sample, PathVertex(point, others, at.seen.arriving), rng).all();
    if (!shares)
        return own + of_others;
    at.of_gloss[std::size_t(Apart::SA)] = of_others;
    return own;
}

std::optional<PathVertex> SurfaceShader::base_of(const ShadedPoint& at) const {
    const SurfacePoint& point = at.seen.point;
    if (!has_base(point.material))
        return std::nullopt;
    return PathVertex(point, Bsdf(point.material, point.frame, Lobes::Base), at.seen.arriving);
}

// By the fire's single lights. What the grid holds of the fire then serves panes alone.
Rgb SurfaceShader::base_from_fire(const SurfaceSample& sample, const ShadedPoint& at) const {
    const std::optional<PathVertex> vertex = base_of(at);
    if (!vertex)
        return Rgb(0.0f);
    Rng rng = input_.fire->surface_rng(sample.pixel, sample.number);
    return input_.fire->on_surface(*vertex, rng);
}

void SurfaceShader::add_unified(const SurfaceSample& sample, const PathVertex& vertex, const ShadedPoint& at,
                                CellSum& out) const {
    const std::optional<PathVertex> base = base_of(at);
    Rng rng = input_.unified->rng(sample.pixel, sample.number);
    const LightBySender light = input_.unified->at({vertex, base ? &*base : nullptr}, rng);
    out.at(Cell::SV) += light.fire;
    out.at(Cell::SS) += light.surfaces;
    out.at(Cell::SA) += light.emitters;
}

void SurfaceShader::add_base(const BaseLight& base, const ShadedPoint& at, CellSum& out) const {
    const Rgb fire = sampled_fire() ? Rgb(0.0f) : base.from_fire;  // else the single lights'
    if (at.seen.mirrors > 0) {
        out.at(Cell::SS) += at.seen.throughput * (fire + base.from_smoke + base.through_panes);
        return;
    }
    out.at(Cell::SV) += fire;
    out.at(Cell::SM) += base.from_smoke;
    out.at(Cell::SS) += base.through_panes;
}

// All but what the lighting grids bring to the base.
void SurfaceShader::shade_point(const SurfaceSample& sample, ShadedPoint& at, CellSum& out) const {
    const SurfacePoint& point = at.seen.point;
    Rng rng = rng_of(Stream::Surface, sample, input_.seed);
    if (input_.fire)
        out.at(Cell::SV) += base_from_fire(sample, at);
    reflect_scattered(sample, at, rng, out);
    const PathVertex vertex(point, at.seen.arriving);
    if (input_.unified)
        add_unified(sample, vertex, at, out);
    if (input_.needed.contains(Cell::SA))
        out.at(Cell::SA) += from_emitters(sample, vertex, rng, at);
    if (!input_.needed.contains(Cell::SS))
        return;
    if (input_.virtual_lights) {
        out.at(Cell::SS) += from_virtual_lights(sample, vertex, rng, at);
        return;
    }
    PathSum path{};
    input_.paths.trace_from_surface(point, at.seen.arriving, rng, path);
    out.at(Cell::SS) += path.cells.at(Cell::SS);
}

}  // namespace brisance
