#include "surface_lighting/surface_shader.h"

#include <cmath>
#include <limits>
#include <utility>

#include "base_lighting/shared_receivers.h"
#include "core/cpu_clock.h"
#include "core/parallel.h"
#include "surface_lighting/shown_area.h"

namespace brisance {

namespace {

constexpr std::size_t kSamplesAtOnce = 256;

Rng rng_of(Stream stream, const SurfaceSample& sample, std::uint32_t seed) {
    return Rng(stream, sample.pixel | std::uint64_t(seed) << 32, sample.number);
}

bool has_base(const SurfaceMaterial& m) {
    return m.metallic < 1.0f && m.transmission < 1.0f && m.base_colour != Rgb(0.0f);
}

bool has_specular(const SurfaceMaterial& m) {
    return needs_energy_tables(m);
}

// Half the angle [rad] in which a glossy lobe reflects is about twice the width of its microfacet slopes. It stays
// below a base's, and rises with roughness throughout: pixels tell lobes by it.
float width_of_gloss(float roughness) {
    constexpr float kWidest = 0.7f;
    return kWidest * -std::expm1(-2.0f * roughness * roughness / kWidest);
}

// Glossy lobes reflect at grazing angles what the colour of their metal does not hold: light is divided by no less.
constexpr float kLeastColour = 0.04f;

// Voxels of a segment of a path between surfaces are not cut: the path is one of many.
constexpr int kPartsForPaths = 1;

// Where smoke scatters sharply, what is known of its light toward the camera says little of other directions. Virtual
// lights in the smoke have noise of their own along every segment.
float share_of_walks(const SurfaceLightingInput& input) {
    if (input.in_scattering)
        return 1.0f;
    return glm::smoothstep(0.3f, 0.6f, std::abs(input.field.medium().mean_cosine));
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
      mirrors_(input.paths.direct(), medium_, input.needed.contains(Cell::SS), input.seed),
      planar_(input.paths.direct().field().medium()),
      smoke_of_paths_({input.field, input.paths.direct(), kPartsForPaths, nullptr, input.emitters_by_rays}),
      walks_(share_of_walks(input)) {}

// A point to shade and the state of its random numbers.
struct SurfaceShader::ShadedPoint {
    BehindMirrors seen;
    Rng ray_rng;  // for rays through the medium
    int vertices;
    std::optional<SharedBounce::Sample> base = std::nullopt, gloss = std::nullopt;  // left to all pixels
    std::vector<LightReuse::Sample> chosen = {};                                    // left to samples around
    BoundTally bound = {};                                                          // of what is not left to all pixels
};

// The samples of a pixel divide the emitters among themselves: a sequence of evenly spread choices runs through them
// (golden ratio), shifted at random from pixel to pixel. A sample makes several choices where a pixel has fewer samples
// than there are kinds of light to choose from.
Rgb SurfaceShader::from_chosen_emitters(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng) const {
    constexpr double kGolden = 0.6180339887498949;
    const auto samples = static_cast<std::uint64_t>(input_.samples);
    const std::uint64_t number = (sample.number >> 32) * samples + (sample.number & 0xffffffffu);
    const std::uint64_t choices = (surroundings_.emitters().choices() + samples - 1) / samples;
    Rng shift(stream_of("surface_lighting/emitters"), sample.pixel | std::uint64_t(input_.seed) << 32);
    const double start = shift.next_double() + std::fmod(double(number) * kGolden, 1.0);
    Rgb sum(0.0f);
    for (std::uint64_t k = 0; k < choices; ++k) {
        const double at = start + double(k) / double(choices);
        sum += input_.paths.direct().from_emitters(vertex, at - std::floor(at), rng);
    }
    return choices > 0 ? sum / float(choices) : sum;
}

Rgb SurfaceShader::from_emitters(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng) const {
    const DirectLight& direct = input_.paths.direct();
    Rgb sum(0.0f);
    if (!vertex.only_delta())
        sum += from_chosen_emitters(sample, vertex, rng);
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
                                 : rng_of(Stream::RayLightSurface, s, input_.seed);
            const SurfacePoint point = surface_point(surroundings_.scene(), s.hit, -s.ray.direction);
            shaded.seen = mirrors_.follow(s, point, shaded.ray_rng, light[i]);
            shaded.vertices = shaded.seen.mirrors;
        },
        kSamplesAtOnce);
    return points;
}

// What the bases of all points reflect of the medium's light.
std::vector<BaseLight> SurfaceShader::light_bases(const std::vector<SurfaceSample>& samples,
                                                  const std::vector<ShadedPoint>& points) {
    if (!input_.medium_lighting || !input_.medium_lighting->lights_surfaces())
        return std::vector<BaseLight>(samples.size());
    const Medium& medium = input_.paths.direct().field().medium();
    SharedReceivers receivers(medium);
    std::vector<BasePoint> bases;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const BehindMirrors& seen = points[i].seen;
        receivers.add(samples[i].pixel, vec3(seen.point.position), vec3(seen.point.frame.normal));
        const bool lit = !seen.lost && has_base(seen.point.material);
        bases.push_back({lit ? &seen.point : nullptr, -seen.arriving, samples[i].pixel, samples[i].number});
    }
    planar_.light(receivers.receivers(),
                  [&](std::vector<SurfaceReceiver>& at) { input_.medium_lighting->at_surfaces(at); });
    return BaseLighting(medium, *input_.medium_lighting, panes_, samples_through_panes(), input_.width, input_.seed)
        .light(bases, receivers);
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

// Samples one direction of those lobes and adds what the medium emits and scatters along it. Small flames are rarely
// met so: a line toward the fire finds its emission, too, and the balance heuristic weights both.
void SurfaceShader::reflect_medium(const SurfacePoint& point, const dvec3& toward_viewer, const GlossyLobes& lobes,
                                   Rng& rng, Rng& ray_rng, CellSum& light) const {
    const DirectLight& direct = input_.paths.direct();
    const PathVertex vertex(point, lobes.bsdf, -toward_viewer);
    const float lines = has_wide_lobes(point.material) ? direct.fire_lines_on_surface(vertex) : 0.0f;
    if (lines > 0.0f)
        light.at(Cell::SV) += direct.from_fire(vertex, lines, ray_rng);
    const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
    const std::optional<BsdfSample> drawn = lobes.bsdf.sample(toward_viewer, {x, y, z});
    if (!drawn || point.leaks(toward_viewer, drawn->wi))
        return;
    const float of_rays = drawn->delta ? 1.0f : float(lobes.split.of_rays(drawn->wi));
    Rgb weight = drawn->weight;
    RaySegment segment = direct.segment_along(point.leaving(drawn->wi));
    for (int panes = 0;; ++panes) {
        RaySum seen = medium_.look(segment.ray, segment.end, ray_rng);
        seen.cells.at(Cell::MM) *= of_rays;
        if (panes == 0 && !drawn->delta && seen.cells.at(Cell::V) != Rgb(0.0f))
            seen.cells.at(Cell::V) *= direct.weight_of_sample(lines, segment.ray, drawn->pdf);
        light.at(panes == 0 ? Cell::SV : Cell::SS) += weight * seen.cells.at(Cell::V);
        light.at(panes == 0 ? Cell::SM : Cell::SS) += weight * scattered_by_medium(seen.cells);
        if (!samples_through_panes() || !segment.point || seen.depth > kOpaqueDepth)
            return;
        weight *= std::exp(-seen.depth) * Panes::straight_on(*segment.point, segment.ray.direction);
        if (weight == Rgb(0.0f))
            return;
        segment = direct.segment_along(segment.point->leaving(segment.ray.direction));
    }
}

// Adds the medium's light that the grids of fire and smoke do not hold: lights in the smoke, and glossy reflection.
void SurfaceShader::reflect_scattered(const SurfacePoint& point, const dvec3& toward_viewer, Rng& rng, Rng& ray_rng,
                                      CellSum& light) const {
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
                point, ReceiverLobes(base, shared ? &gloss->split : nullptr), toward_viewer, ray_rng);
    }
    if (gloss)
        reflect_medium(point, toward_viewer, *gloss, rng, ray_rng, light);
}

VirtualLights::Shading SurfaceShader::shading(ShadedPoint& at) const {
    return {samples_through_panes() ? VirtualLights::Panes::Sampled : VirtualLights::Panes::Followed,
            &smoke_of_paths_,
            walks_,
            &at.vertices,
            nullptr,
            nullptr,
            input_.bound ? &at.bound : nullptr};
}

// What the sample itself shows; the rest is left to all pixels, where they share it.
Rgb SurfaceShader::from_virtual_lights(const SurfaceSample& sample, const PathVertex& vertex, Rng& rng,
                                       ShadedPoint& at) const {
    const SurfacePoint& point = at.seen.point;
    if (!input_.shared || at.seen.mirrors > 0)
        return shade_vertex(sample, vertex, Lobes::All, shading(at), rng, at);
    if (has_base(point.material)) {
        const Bsdf base(point.material, point.frame, Lobes::Base);
        if (const Rgb albedo = base.base_albedo(-at.seen.arriving); albedo != Rgb(0.0f))
            at.base = shared_sample(sample, base, Lobes::Base, albedo, 1.0f, rng, at);
    }
    if (!has_specular(point.material))
        return Rgb(0.0f);
    const Bsdf others(point.material, point.frame, Lobes::Specular);
    if (point.material.transmission > 0.0f || !has_wide_lobes(point.material))
        return shade_vertex(sample, PathVertex(point, others, at.seen.arriving), Lobes::Specular, shading(at), rng, at);
    const Rgb colour =
        glm::max(glm::mix(Rgb(1.0f), point.material.base_colour, point.material.metallic), Rgb(kLeastColour));
    at.gloss =
        shared_sample(sample, others, Lobes::Specular, colour, width_of_gloss(point.material.roughness), rng, at);
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

// Of some lobes of the sample's surface. `colour`: of them; `lobe`: their width.
SharedBounce::Sample SurfaceShader::shared_sample(const SurfaceSample& sample, const Bsdf& lobes, Lobes which,
                                                  const Rgb& colour, float lobe, Rng& rng, ShadedPoint& at) const {
    const SurfacePoint& point = at.seen.point;
    VirtualLights::Shading how = shading(at);
    double distance = std::numeric_limits<double>::infinity();
    how.distance = &distance;
    const Rgb own_residual = std::exchange(at.bound.residual, Rgb(0.0f));
    const Rgb light = shade_vertex(sample, PathVertex(point, lobes, at.seen.arriving), which, how, rng, at);
    if (!at.chosen.empty())
        at.chosen.back().colour = colour;
    const double from_eye = glm::distance(point.position, sample.ray.origin);
    SharedBounce::Sample out;
    out.pixel = sample.pixel;
    out.position = vec3(point.position);
    out.normal = vec3(point.frame.normal);
    out.pixel_size = float(input_.pixel_angle * from_eye);
    out.area = shown_area(point, at.seen.arriving, out.pixel_size);
    out.lobe = lobe;
    const Rgb residual = std::exchange(at.bound.residual, own_residual);
    for (int c = 0; c < 3; ++c)
        if (colour[c] > 0.0f) {
            out.light[c] = light[c] / colour[c];
            out.residual[c] = residual[c] / colour[c];
        }
    out.weight = sample.share * colour;
    out.closeness = float(1.0 / distance);
    // Along a glossy surface the direction to the eye changes, too.
    if (lobe < 1.0f && out.closeness > 0.0f)
        out.closeness += float(1.0 / from_eye);
    return out;
}

// By the fire's single lights. What the grid holds of the fire then serves panes alone.
Rgb SurfaceShader::base_from_fire(const SurfaceSample& sample, const ShadedPoint& at) const {
    const SurfacePoint& point = at.seen.point;
    if (!has_base(point.material))
        return Rgb(0.0f);
    const PathVertex vertex(point, Bsdf(point.material, point.frame, Lobes::Base), at.seen.arriving);
    Rng rng = input_.fire->surface_rng(sample.pixel, sample.number);
    return input_.fire->on_surface(vertex, rng);
}

void SurfaceShader::shade_point(const SurfaceSample& sample, const BaseLight& base, ShadedPoint& at,
                                CellSum& out) const {
    const SurfacePoint& point = at.seen.point;
    const dvec3 toward_viewer = -at.seen.arriving;
    Rng rng = rng_of(Stream::Surface, sample, input_.seed);
    out.at(Cell::SV) += input_.fire ? base_from_fire(sample, at) : base.from_fire;
    out.at(Cell::SM) += base.from_smoke;
    out.at(Cell::SS) += base.through_panes;
    reflect_scattered(point, toward_viewer, rng, at.ray_rng, out);
    const PathVertex vertex(point, at.seen.arriving);
    if (input_.needed.contains(Cell::SA))
        out.at(Cell::SA) += from_emitters(sample, vertex, rng);
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

void SurfaceShader::shade(const std::vector<SurfaceSample>& samples, std::vector<CellSum>& light) {
    std::vector<ShadedPoint> points = shaded_points(samples, light);
    const std::vector<BaseLight> bases = light_bases(samples, points);
    parallel_for(
        samples.size(),
        [&](std::size_t i) {
            const BehindMirrors& seen = points[i].seen;
            if (seen.lost)
                return;
            if (seen.mirrors == 0) {
                shade_point(samples[i], bases[i], points[i], light[i]);
                return;
            }
            CellSum there;
            shade_point(samples[i], bases[i], points[i], there);
            for (const Rgb& cell : there)
                light[i].at(Cell::SS) += seen.throughput * cell;
        },
        kSamplesAtOnce);
    for (std::size_t i = 0; input_.lengths && i < samples.size(); ++i)
        input_.lengths->add(samples[i].pixel, points[i].vertices);
    hand_over(samples, points, light);
}

// With the light of one sample itself where all pixels share: its mean is that of theirs.
ScreenSpaceCompensation::Sample SurfaceShader::compensated_sample(const SurfaceSample& sample, const ShadedPoint& at,
                                                                  const CellSum& light) const {
    const SurfacePoint& point = at.seen.point;
    ScreenSpaceCompensation::Sample out;
    out.pixel = sample.pixel;
    out.position = vec3(point.position);
    out.normal = vec3(point.frame.normal);
    const double from_eye = glm::distance(point.position, sample.ray.origin);
    out.area = shown_area(point, at.seen.arriving, input_.pixel_angle * from_eye);
    for (const Rgb& cell : light)
        out.light += cell;
    for (const std::optional<SharedBounce::Sample>& s : {at.base, at.gloss})
        if (s)
            out.light += s->light * s->weight / sample.share;
    if (has_base(point.material))
        out.albedo = Bsdf(point.material, point.frame, Lobes::Base).base_albedo(-at.seen.arriving);
    out.share = sample.share;
    return out;
}

// To all pixels, and to samples around first.
void SurfaceShader::hand_over(const std::vector<SurfaceSample>& samples, std::vector<ShadedPoint>& points,
                              std::vector<CellSum>& light) const {
    std::vector<LightReuse::Sample> chosen;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        ShadedPoint& at = points[i];
        if (!(samples[i].share > 0.0f))
            continue;
        if (input_.compensation && !at.seen.lost && at.seen.mirrors == 0) {
            const AddedCpuTime time(input_.bound ? &input_.bound->costs().compensation_seconds : nullptr);
            input_.compensation->add(compensated_sample(samples[i], at, light[i]));
        }
        if (input_.bound)
            input_.bound->add(samples[i].pixel, at.bound, samples[i].share * at.seen.throughput);
        for (LightReuse::Sample& c : at.chosen) {
            c.shared.swap(c.lobes == Lobes::Base ? at.base : at.gloss);
            chosen.push_back(std::move(c));
        }
        for (const std::optional<SharedBounce::Sample>& s : {at.base, at.gloss})
            if (s && !input_.shared->add(*s)) {
                light[i].at(Cell::SS) += s->light * s->weight / samples[i].share;
                if (input_.bound)
                    input_.bound->add_residual(samples[i].pixel, s->residual * s->weight);
            }
    }
    if (input_.reuse)
        input_.reuse->add(std::move(chosen));
}

}  // namespace brisance
