#include "surface_lighting/surface_shader.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base_lighting/shared_receivers.h"
#include "core/cpu_clock.h"
#include "core/parallel.h"
#include "surface_lighting/lobe_numbers.h"
#include "surface_lighting/shown_area.h"

namespace brisance {

namespace {

constexpr std::size_t kSamplesAtOnce = 256;

// What a puddle shows of a window is followed to what the window shows. Beyond that, paths find it.
constexpr int kMostReflections = 2;

using Apart = SharedBounce::Apart;

constexpr Stream kGloss = stream_of("surface_lighting/gloss");

Rng rng_of(Stream stream, const SurfaceSample& sample, std::uint32_t seed) {
    return Rng(stream, sample.pixel | std::uint64_t(seed) << 32, sample.number);
}

bool has_base(const SurfaceMaterial& m) {
    return m.metallic < 1.0f && m.transmission < 1.0f && m.base_colour != Rgb(0.0f);
}

bool has_specular(const SurfaceMaterial& m) {
    return needs_energy_tables(m);
}

// Where smoke scatters sharply, what is known of its light toward the camera says little of other directions. Virtual
// lights in the smoke have noise of their own along every segment.
float share_of_walks(const SurfaceLightingInput& input) {
    if (input.in_scattering)
        return 1.0f;
    return glm::smoothstep(0.3f, 0.6f, std::abs(input.field.medium().mean_cosine));
}

// What the lobe reflects beside light between surfaces.
Rgb light_apart(const SharedBounce::Sample& s) {
    return s.of(Apart::SV) + s.of(Apart::SM) + s.of(Apart::SA);
}

// As the pixel shows it.
Rgb all_light(const SharedBounce::Sample& s) {
    return s.weight * (s.light + light_apart(s));
}

// Whoever compares choices of lights, or asks what their bound does, wants those lights at every lobe.
bool reflects_narrowly(const SurfaceLightingInput& input) {
    return input.virtual_lights && input.virtual_lights->extend_paths() && input.needed.contains(Cell::SS) &&
           !input.unified && !input.reuse && !input.bound && !input.compensation;
}

}  // namespace

SurfaceShader::SurfaceShader(const SurfaceLightingInput& input)
    : input_(input),
      surroundings_(*input.paths.direct().surroundings()),
      medium_(input.field, input.paths.direct(), input.parts, input.in_scattering, input.emitters_by_rays),
      emitters_(input.paths.direct(), input.samples, input.seed),
      panes_(surroundings_),
      gloss_(input.paths.direct(), medium_, samples_through_panes()),
      mirrors_(input.paths.direct(), medium_, input.needed.contains(Cell::SS), input.samples, samples_through_panes(),
               input.seed),
      planar_(input.paths.direct().field().medium()),
      smoke_of_paths_(medium_),
      reflects_(reflects_narrowly(input)),
      walks_(share_of_walks(input)) {}

// A point to shade and the state of its random numbers.
struct SurfaceShader::ShadedPoint {
    BehindMirrors seen;
    Rng ray_rng;  // for rays through the medium
    int vertices;
    float stands_for = 1.0f;                                                        // that of SurfaceRounds
    std::optional<SharedBounce::Sample> base = std::nullopt, gloss = std::nullopt,  // left to all pixels
        sky = std::nullopt;
    SharedBounce::Aparts of_gloss = {};              // left to them with the gloss, ...
    std::optional<double> closeness = std::nullopt;  // ... by what its ray met [1/m]
    std::vector<LightReuse::Sample> chosen = {};     // left to samples around
    BoundTally bound = {};                           // of what is not left to all pixels
};

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
    return BaseLighting(medium, *input_.medium_lighting, panes_, samples_through_panes(), input_.width,
                        input_.base_tolerance, input_.seed)
        .light(bases, receivers);
}

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
    if (shares_gloss(at)) {
        at.closeness = closeness;
        at.of_gloss[std::size_t(Apart::SV)] = std::exchange(found.at(Cell::SV), Rgb(0.0f));
        at.of_gloss[std::size_t(Apart::SM)] = std::exchange(found.at(Cell::SM), Rgb(0.0f));
    }
    light.add(found, Rgb(1.0f));
}

// Whether pixels share what rough lobes reflect, whoever sent it.
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
    if (!has_specular(point.material) || reflected)
        return Rgb(0.0f);
    const Bsdf others(point.material, point.frame, Lobes::Specular);
    if (point.material.transmission > 0.0f || !has_wide_lobes(point.material))
        return shade_vertex(sample, PathVertex(point, others, at.seen.arriving), Lobes::Specular, shading(at), rng, at);
    LightToShare of_gloss{.colour = colour_of_gloss(point.material),
                          .lobe = width_of_gloss(point.material.roughness),
                          .closeness = at.closeness,
                          .apart = at.of_gloss};
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

void SurfaceShader::shade(const std::vector<SurfaceSample>& samples, std::vector<CellSum>& light) {
    std::vector<ShadedPoint> points = shaded_points(samples, light);
    const std::vector<BaseLight> bases = light_bases(samples, points);
    std::vector<float> even(samples.size());
    SurfaceRounds::Found known{std::vector<float>(samples.size()), std::vector<float>(samples.size())};
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!points[i].seen.lost)
            add_base(bases[i], points[i], light[i]);
        even[i] = luminance(light[i]);
    }
    std::vector<CellSum> found(samples.size());
    const auto shade = [&](const std::vector<std::size_t>& some) {
        shade_some(samples, some, points, found);
        tell(samples, some, points, found, known);
    };
    SurfaceRounds rounds(samples, input_.width, std::size_t(input_.samples), input_.tolerance);
    shade(rounds.first());
    shade(rounds.second(even, known));
    for (std::size_t i = 0; i < samples.size(); ++i) {
        points[i].stands_for = rounds.stands_for(i);
        light[i].add(found[i], Rgb(points[i].stands_for));
    }
    for (std::size_t i = 0; input_.lengths && i < samples.size(); ++i)
        if (points[i].stands_for > 0.0f)
            input_.lengths->add(samples[i].pixel, points[i].vertices);
    hand_over(samples, points, light);
}

// What shading found at some samples, of which all pixels share a part. What that leaves of its noise is told of the
// light that rough lobes reflect.
void SurfaceShader::tell(const std::vector<SurfaceSample>& samples, const std::vector<std::size_t>& some,
                         const std::vector<ShadedPoint>& points, const std::vector<CellSum>& found,
                         SurfaceRounds::Found& known) const {
    for (std::size_t begin = 0, end = 0; begin < some.size(); begin = end) {
        float closeness = 0.0f, met = 0.0f;
        for (; end < some.size() && samples[some[end]].pixel == samples[some[begin]].pixel; ++end)
            if (const auto& gloss = points[some[end]].gloss; gloss && gloss->closeness > 0.0f) {
                closeness += gloss->closeness;
                met += 1.0f;
            }
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = some[k];
            known.noisy[i] = luminance(found[i]);
            for (const auto* s : {&points[i].base, &points[i].gloss, &points[i].sky})
                if (*s)
                    known.shared[i] += luminance(all_light(**s)) / samples[i].share;
            if (const auto& gloss = points[i].gloss)
                known.noisy[i] += luminance(gloss->weight * light_apart(*gloss)) / samples[i].share /
                                  std::sqrt(input_.shared->pixels_sharing(*gloss, closeness / std::max(met, 1.0f)));
        }
    }
}

void SurfaceShader::shade_some(const std::vector<SurfaceSample>& samples, const std::vector<std::size_t>& some,
                               std::vector<ShadedPoint>& points, std::vector<CellSum>& found) {
    parallel_for(
        some.size(),
        [&](std::size_t k) {
            if (!points[some[k]].seen.lost)
                shade_sample(samples[some[k]], points[some[k]], found[some[k]]);
        },
        kSamplesAtOnce);
    if (reflects_)
        shade_reflected(samples, some, points, found);
}

// Whether what the point's lobes show of other surfaces is found by shade_reflected().
bool SurfaceShader::shows_others(const ShadedPoint& at) const {
    return reflects_ && at.seen.mirrors < kMostReflections && !at.seen.lost && has_narrow_lobes(at.seen.point.material);
}

// The surfaces that narrow lobes show are lit together, as those are that camera rays hit.
void SurfaceShader::shade_reflected(const std::vector<SurfaceSample>& samples, const std::vector<std::size_t>& some,
                                    std::vector<ShadedPoint>& points, std::vector<CellSum>& found) {
    std::vector<std::size_t> by;  // samples that show others
    for (const std::size_t i : some)
        if (shows_others(points[i]))
            by.push_back(i);
    if (by.empty())
        return;
    std::vector<SurfaceSample> seen_by(by.size());
    std::vector<ShadedPoint> there(by.size(), ShadedPoint{{}, Rng(Stream::RayLightSurface, 0), 0});
    std::vector<CellSum> light(by.size());
    parallel_for(
        by.size(),
        [&](std::size_t k) {
            ShadedPoint& from = points[by[k]];
            seen_by[k] = samples[by[k]];
            there[k].seen = mirrors_.reflected(seen_by[k], from.seen, from.ray_rng, light[k]);
            there[k].ray_rng = from.ray_rng;
        },
        kSamplesAtOnce);
    light_reflected(seen_by, there, light);
    for (std::size_t k = 0; k < by.size(); ++k) {
        found[by[k]].add(light[k], Rgb(1.0f));
        points[by[k]].vertices += there[k].vertices;
    }
}

// And what these show in turn.
void SurfaceShader::light_reflected(const std::vector<SurfaceSample>& by, std::vector<ShadedPoint>& there,
                                    std::vector<CellSum>& found) {
    const std::vector<BaseLight> bases = light_bases(by, there);
    std::vector<std::size_t> all(by.size());
    std::iota(all.begin(), all.end(), std::size_t(0));
    for (const std::size_t k : all)
        if (!there[k].seen.lost)
            add_base(bases[k], there[k], found[k]);
    shade_some(by, all, there, found);
}

// Behind mirrors all of it is light between surfaces.
void SurfaceShader::shade_sample(const SurfaceSample& sample, ShadedPoint& at, CellSum& light) const {
    if (at.seen.mirrors == 0) {
        shade_point(sample, at, light);
        return;
    }
    CellSum there;
    shade_point(sample, at, there);
    for (const Rgb& cell : there)
        light.at(Cell::SS) += at.seen.throughput * cell;
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
    for (const std::optional<SharedBounce::Sample>& s : {at.base, at.gloss, at.sky})
        if (s)
            out.light += all_light(*s) / sample.share;
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
        const float share = samples[i].share * at.stands_for;
        if (!(share > 0.0f))
            continue;
        if (input_.compensation && !at.seen.lost && at.seen.mirrors == 0) {
            const AddedCpuTime time(input_.bound ? &input_.bound->costs().compensation_seconds : nullptr);
            input_.compensation->add(compensated_sample(samples[i], at, light[i]));
        }
        if (input_.bound)
            input_.bound->add(samples[i].pixel, at.bound, share * at.seen.throughput);
        for (std::optional<SharedBounce::Sample>* s : {&at.base, &at.gloss, &at.sky})
            if (*s)
                (*s)->weight *= at.stands_for;
        for (LightReuse::Sample& c : at.chosen) {
            c.share = share;
            c.shared.swap(c.lobes == Lobes::Base ? at.base : at.gloss);
            chosen.push_back(std::move(c));
        }
        for (const std::optional<SharedBounce::Sample>& s : {at.base, at.gloss})
            if (s && !input_.shared->add(*s)) {
                const Rgb shown = s->weight / samples[i].share;
                light[i].at(Cell::SS) += s->light * shown;
                light[i].at(Cell::SV) += s->of(Apart::SV) * shown;
                light[i].at(Cell::SM) += s->of(Apart::SM) * shown;
                light[i].at(Cell::SA) += s->of(Apart::SA) * shown;
                if (input_.bound)
                    input_.bound->add_residual(samples[i].pixel, s->of(Apart::Residual) * s->weight);
            }
        if (at.sky && !input_.shared_sky->add(*at.sky))
            light[i].at(Cell::SA) += at.sky->light * at.sky->weight / samples[i].share;
    }
    if (input_.reuse)
        input_.reuse->add(std::move(chosen));
}

}  // namespace brisance
