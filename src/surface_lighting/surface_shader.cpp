#include "surface_lighting/surface_shader.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "surface_lighting/shared_receivers.h"

namespace brisance {

namespace {

constexpr std::size_t kSamplesAtOnce = 256;

bool has_base(const SurfaceMaterial& m) {
    return m.metallic < 1.0f && m.transmission < 1.0f && m.base_colour != Rgb(0.0f);
}

bool has_specular(const SurfaceMaterial& m) {
    return needs_energy_tables(m);
}

// Whether the lobes other than the base are not deltas.
bool has_wide_lobes(const SurfaceMaterial& m) {
    return has_specular(m) && double(m.roughness) * m.roughness >= kSmoothAlpha;
}

}  // namespace

SurfaceShader::SurfaceShader(const SurfaceLightingInput& input)
    : input_(input),
      surroundings_(*input.paths.direct().surroundings()),
      medium_(input.field, input.paths.direct(), input.parts, input.in_scattering, input.emitters_by_rays),
      panes_(surroundings_),
      mirrors_(input.paths.direct(), medium_, input.needed.contains(Cell::SS)) {}

// A point to shade and the state of its random numbers.
struct SurfaceShader::ShadedPoint {
    BehindMirrors seen;
    Rng ray_rng;  // for rays through the medium
    int vertices;
};

Rgb SurfaceShader::from_emitters(const PathVertex& vertex, Rng& rng) const {
    const DirectLight& direct = input_.paths.direct();
    Rgb sum(0.0f);
    if (!vertex.only_delta())
        sum += direct.from_emitters(vertex, rng);
    const std::optional<PathVertex::Sample> turn = vertex.sample(rng);
    if (!turn)
        return sum;
    const RaySegment segment = direct.segment_along(vertex.leaving(turn->wi));
    const Rgb seen = direct.at_end(segment, turn->pdf, turn->delta, &vertex);
    if (seen != Rgb(0.0f))
        sum += turn->weight * seen * float(direct.lines().transmittance(segment.ray, segment.end, rng));
    return sum;
}

std::vector<SurfaceShader::ShadedPoint> SurfaceShader::shaded_points(const std::vector<SurfaceSample>& samples,
                                                                     std::vector<CellSum>& light) const {
    std::vector<ShadedPoint> points(samples.size(), ShadedPoint{{}, Rng(Stream::RayLightSurface, 0), 0});
    parallel_for(
        samples.size(),
        [&](std::size_t i) {
            const SurfaceSample& s = samples[i];
            ShadedPoint& shaded = points[i];
            shaded.ray_rng = input_.in_scattering
                                 ? input_.in_scattering->rng(Stream::RayLightSurface, s.pixel, s.number)
                                 : Rng(Stream::RayLightSurface, s.pixel, s.number);
            const SurfacePoint point = surface_point(surroundings_.scene(), s.hit, -s.ray.direction);
            shaded.seen = mirrors_.follow(s, point, shaded.ray_rng, light[i]);
            shaded.vertices = shaded.seen.mirrors;
        },
        kSamplesAtOnce);
    return points;
}

// Light that the base reflects of what other surfaces do not occlude, relative to what a white Lambert surface would
// reflect of all of it.
SurfaceShader::SeenPart SurfaceShader::seen_part(const VisibilityRatio* light, const SurfacePoint& point,
                                                 const dvec3& toward_viewer, Rng& rng) const {
    std::array<VisibilityRatio::Draw, VisibilityRatio::kDraws> draws;
    const LitPoint lit{point.position, point.frame.normal, LitPoint::Kind::Surface};
    if (!light || !light->draw(lit, rng, draws))
        return {};
    const Bsdf base(point.material, point.frame, Lobes::Base);
    SeenPart seen;
    float white = 0.0f;
    for (const VisibilityRatio::Draw& d : draws) {
        if (!(d.weight > 0.0f))
            continue;
        white += d.weight / std::numbers::pi_v<float>;
        const dvec3 direction(d.direction);
        const bool above =
            glm::dot(point.geometric_normal, direction) * glm::dot(point.geometric_normal, toward_viewer) > 0.0;
        if (!above)
            continue;
        const float cosine = glm::dot(vec3(point.frame.normal), d.direction);
        const dvec3 from = point.start_toward(dvec3(d.point));
        const dvec3 offset = dvec3(d.point) - from;
        const double distance = glm::length(offset);
        const Panes::Passage passage = panes_.along({from, offset / distance}, distance);
        if (!passage.blocked)
            (passage.panes > 0 ? seen.through_panes : seen.clear) +=
                base.evaluate(toward_viewer, direction) * (d.weight / cosine) * passage.weight;
    }
    if (!(white > 0.0f))
        return {};
    return {seen.clear / white, seen.through_panes / white};
}

// All lobes but the base, and how rays and lights share them.
struct SurfaceShader::GlossyLobes {
    Bsdf bsdf;
    GlossSplit split;
    GlossyLobes(const SurfacePoint& point, const dvec3& toward_viewer, int light_samples)
        : bsdf(point.material, point.frame, Lobes::Specular), split(point, bsdf, toward_viewer, light_samples) {}
    GlossyLobes(const GlossyLobes&) = delete;
    GlossyLobes& operator=(const GlossyLobes&) = delete;
};

// Samples one direction of those lobes and adds what the medium emits and scatters along it.
void SurfaceShader::reflect_medium(const SurfacePoint& point, const dvec3& toward_viewer, const GlossyLobes& lobes,
                                   Rng& rng, Rng& ray_rng, CellSum& light) const {
    const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
    const std::optional<BsdfSample> drawn = lobes.bsdf.sample(toward_viewer, {x, y, z});
    if (!drawn || point.leaks(toward_viewer, drawn->wi))
        return;
    const float of_rays = drawn->delta ? 1.0f : float(lobes.split.of_rays(drawn->wi));
    Rgb weight = drawn->weight;
    RaySegment segment = input_.paths.direct().segment_along(point.leaving(drawn->wi));
    for (int panes = 0;; ++panes) {
        RaySum seen = medium_.look(segment.ray, segment.end, ray_rng);
        seen.cells.at(Cell::MM) *= of_rays;
        light.at(panes == 0 ? Cell::SV : Cell::SS) += weight * seen.cells.at(Cell::V);
        light.at(panes == 0 ? Cell::SM : Cell::SS) += weight * scattered_by_medium(seen.cells);
        if (!samples_through_panes() || !segment.point || seen.depth > kOpaqueDepth)
            return;
        weight *= std::exp(-seen.depth) * Panes::straight_on(*segment.point, segment.ray.direction);
        if (weight == Rgb(0.0f))
            return;
        segment = input_.paths.direct().segment_along(segment.point->leaving(segment.ray.direction));
    }
}

// Adds the medium's light that the grids of fire and smoke do not hold: lights in the smoke, and glossy reflection.
void SurfaceShader::reflect_scattered(const SurfacePoint& point, const dvec3& toward_viewer, Rng& rng, Rng& ray_rng,
                                      CellSum& light) const {
    const int light_samples =
        input_.in_scattering && has_wide_lobes(point.material) ? input_.in_scattering->gloss_samples() : 0;
    std::optional<GlossyLobes> gloss;
    if (input_.medium_lighting && has_specular(point.material))
        gloss.emplace(point, toward_viewer, light_samples);
    if (input_.in_scattering) {
        const bool shared = gloss && light_samples > 0;
        const Bsdf base(point.material, point.frame, Lobes::Base);
        if (shared || has_base(point.material))
            light.at(Cell::SM) += input_.in_scattering->at_surface(
                point, ReceiverLobes(base, shared ? &gloss->split : nullptr), toward_viewer, ray_rng);
    }
    if (gloss)
        reflect_medium(point, toward_viewer, *gloss, rng, ray_rng, light);
}

void SurfaceShader::shade_point(const SurfaceSample& sample, const SurfaceReceiver& receiver, ShadedPoint& at,
                                CellSum& out) const {
    const SurfacePoint& point = at.seen.point;
    const dvec3 toward_viewer = -at.seen.arriving;
    Rng rng(Stream::Surface, sample.pixel, sample.number);
    if (input_.medium_lighting && has_base(point.material)) {
        const auto add = [&](Cell cell, const std::array<Rgb, 2>& arriving, const VisibilityRatios& ratios) {
            for (int part = 0; part < 2; ++part) {
                const SeenPart seen = seen_part(ratios[part], point, toward_viewer, rng);
                out.at(cell) += arriving[part] * seen.clear;
                if (samples_through_panes())
                    out.at(Cell::SS) += arriving[part] * seen.through_panes;
            }
        };
        add(Cell::SV, receiver.fire, input_.medium_lighting->fire_visibility());
        add(Cell::SM, receiver.smoke, input_.medium_lighting->smoke_visibility());
    }
    reflect_scattered(point, toward_viewer, rng, at.ray_rng, out);
    const PathVertex vertex(point, at.seen.arriving);
    if (input_.needed.contains(Cell::SA))
        out.at(Cell::SA) += from_emitters(vertex, rng);
    if (!input_.needed.contains(Cell::SS))
        return;
    if (input_.virtual_lights) {
        out.at(Cell::SS) += input_.virtual_lights->shade(
            vertex, rng, &at.vertices,
            samples_through_panes() ? VirtualLights::Panes::Sampled : VirtualLights::Panes::Followed);
        return;
    }
    PathSum path{};
    input_.paths.trace_from_surface(point, at.seen.arriving, rng, path);
    out.at(Cell::SS) += path.cells.at(Cell::SS);
}

void SurfaceShader::shade(const std::vector<SurfaceSample>& samples, std::vector<CellSum>& light) const {
    std::vector<ShadedPoint> points = shaded_points(samples, light);
    SharedReceivers receivers(input_.paths.direct().field().medium());
    for (std::size_t i = 0; i < samples.size(); ++i)
        receivers.add(samples[i].pixel, vec3(points[i].seen.point.position), vec3(points[i].seen.point.frame.normal));
    if (input_.medium_lighting)
        input_.medium_lighting->at_surfaces(receivers.receivers());
    parallel_for(
        samples.size(),
        [&](std::size_t i) {
            const BehindMirrors& seen = points[i].seen;
            if (seen.lost)
                return;
            if (seen.mirrors == 0) {
                shade_point(samples[i], receivers.of_sample(i), points[i], light[i]);
                return;
            }
            CellSum there;
            shade_point(samples[i], receivers.of_sample(i), points[i], there);
            for (const Rgb& cell : there)
                light[i].at(Cell::SS) += seen.throughput * cell;
        },
        kSamplesAtOnce);
    for (std::size_t i = 0; input_.lengths && i < samples.size(); ++i)
        input_.lengths->add(samples[i].pixel, points[i].vertices);
}

}  // namespace brisance
