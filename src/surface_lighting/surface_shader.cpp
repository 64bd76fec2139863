#include "surface_lighting/surface_shader.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base_lighting/shared_receivers.h"
#include "core/cpu_clock.h"
#include "core/parallel.h"
#include "pixel_sharing/shown_area.h"
#include "surface_lighting/shaded_point.h"

namespace brisance {

namespace {

constexpr std::size_t kSamplesAtOnce = 256;

// Of samples that are shaded once more: their points are large.
constexpr std::size_t kAgainAtOnce = 1 << 15;

constexpr int kPassesOfPixel = 48;  // above the passes of the picture, in SurfaceSample::number

// What a puddle shows of a window is followed to what the window shows. Beyond that, paths find it.
constexpr int kMostReflections = 2;

// Of what the samples of a pixel met.
struct MeanCloseness {
    float sum = 0.0f, met = 0.0f;
    void add(const std::optional<SharedBounce::Sample>& sample) {
        if (sample && sample->closeness > 0.0f) {
            sum += sample->closeness;
            met += 1.0f;
        }
    }
    float mean() const { return sum / std::max(met, 1.0f); }
};

// Where smoke scatters sharply, what is known of its light toward the camera says little of other directions. Virtual
// lights in the smoke have noise of their own along every segment.
float share_of_walks(const SurfaceLightingInput& input) {
    if (input.in_scattering)
        return 1.0f;
    return glm::smoothstep(0.3f, 0.6f, std::abs(input.field.medium().mean_cosine));
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

// Makes the points of some samples where they are missing, and adds what mirrors on the way show.
void SurfaceShader::prepare(const Samples& samples, const Some& some, Points& points, Light& light) const {
    const Some missing = points.add(some);
    parallel_for(
        missing.size(),
        [&](std::size_t k) {
            const std::size_t i = missing[k];
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
}

// What the bases of some points reflect of the medium's light, in their order.
std::vector<BaseLight> SurfaceShader::light_bases(const Samples& samples, const Some& some, const Points& points,
                                                  LightBases how) {
    if (some.empty() || !input_.medium_lighting || !input_.medium_lighting->lights_surfaces())
        return std::vector<BaseLight>(some.size());
    const Medium& medium = input_.paths.direct().field().medium();
    SharedReceivers receivers(medium);
    std::vector<BasePoint> bases;
    for (const std::size_t i : some) {
        const BehindMirrors& seen = points[i].seen;
        receivers.add(samples[i].pixel, vec3(seen.point.position), vec3(seen.point.frame.normal));
        const bool lit = !seen.lost && has_base(seen.point.material);
        bases.push_back({lit ? &seen.point : nullptr, -seen.arriving, samples[i].pixel, samples[i].number});
    }
    planar_.light(receivers.receivers(),
                  [&](std::vector<SurfaceReceiver>& at) { input_.medium_lighting->at_surfaces(at); });
    const BaseLighting lighting(medium, *input_.medium_lighting, panes_, samples_through_panes(), input_.width,
                                input_.base_tolerance, input_.seed);
    return (lighting.*how)(bases, receivers);
}

// Light of the medium on bases is known of all samples, or of a few that stand for the others of their pixel; so is
// what is sampled. Bases come second: they need not be better known than what is sampled there.
void SurfaceShader::shade(const Samples& samples, Light& light) {
    const std::vector<float> none(samples.size());
    Points points(samples.size());
    Light found(samples.size());  // but on bases
    const auto rounds = [&](const SurfaceRounds::Tolerance& tolerance, SurfaceRounds::ToldBy told_by) {
        return SurfaceRounds(samples, input_.width, std::size_t(input_.samples), tolerance, told_by);
    };
    SurfaceRounds bases = rounds(input_.tolerance_of_bases, SurfaceRounds::ToldBy::OwnToo),
                  others = rounds(input_.tolerance, SurfaceRounds::ToldBy::Others);
    SurfaceRounds::Found on_bases{none, none}, of_others{none, none};
    const auto light_some = [&](const Some& some, LightBases how) {
        prepare(samples, some, points, found);
        const std::vector<BaseLight> lit = light_bases(samples, some, points, how);
        for (std::size_t k = 0; k < some.size(); ++k) {
            const std::size_t i = some[k];
            if (!points[i].seen.lost)
                add_base(lit[k], points[i], light[i]);
            on_bases.noisy[i] = luminance(light[i]);
        }
    };
    const auto shade = [&](const Some& some) {
        prepare(samples, some, points, found);
        shade_some(samples, some, points, found);
        tell(samples, some, points, found, of_others);
    };
    // What one kind of light shows, as the other's rounds take it.
    const auto even = [&](const SurfaceRounds& rounds, const SurfaceRounds::Found& shown) {
        std::vector<float> out(samples.size());
        for (std::size_t i = 0; i < samples.size(); ++i)
            out[i] = rounds.stands_for(i) * (shown.noisy[i] + shown.shared[i]);
        return out;
    };
    light_some(bases.first(), &BaseLighting::light);
    shade(others.first());
    shade(others.second(even(bases, on_bases), of_others));
    const std::vector<float> seen_beside = even(others, of_others);
    // Samples that reuse what others chose are one to a ray.
    const std::vector<SurfaceRounds::Again> again =
        input_.reuse ? std::vector<SurfaceRounds::Again>() : others.further(even(bases, on_bases), of_others);
    light_some(bases.second(seen_beside, on_bases, &others), &BaseLighting::light_penumbrae);
    std::optional<GrainFinder> grains = add_up(samples, bases, others, points, found, light);
    hand_over(samples, points, light);
    for (std::size_t begin = 0; begin < again.size(); begin += kAgainAtOnce)
        shade_again(samples, std::span(again).subspan(begin, std::min(kAgainAtOnce, again.size() - begin)), others,
                    grains, light);
    variance_left_ += bases.variance_left() + others.variance_left();
}

// Further passes of some samples, all but what lights bases: other numbers, which the passes of a pixel divide among
// themselves as its rays do.
void SurfaceShader::shade_again(const Samples& samples, std::span<const SurfaceRounds::Again> again,
                                const SurfaceRounds& rounds, std::optional<GrainFinder>& grains, Light& light) {
    Samples more;
    for (const SurfaceRounds::Again& a : again) {
        more.push_back(samples[a.sample]);
        more.back().number += std::uint64_t(a.pass) << kPassesOfPixel;
    }
    Some all(more.size());
    std::iota(all.begin(), all.end(), std::size_t(0));
    Points points(more.size());
    Light found(more.size()), shown(more.size());
    prepare(more, all, points, found);
    shade_some(more, all, points, found);
    for (const std::size_t k : all) {
        points[k].stands_for = rounds.stands_for(again[k].sample);
        if (!take_grain(grains, again[k].sample, 0.0f, found[k], points[k]))
            shown[k].add(found[k], Rgb(points[k].stands_for));
        if (input_.lengths)
            input_.lengths->add(more[k].pixel, points[k].vertices);
    }
    hand_over(more, points, shown);
    for (const std::size_t k : all)
        light[again[k].sample].add(shown[k], Rgb(1.0f));
}

// What the rounds have found, as each sample stands for others: `light` on bases, and `found` besides, which is added
// unless it is a grain.
std::optional<GrainFinder> SurfaceShader::add_up(const Samples& samples, const SurfaceRounds& bases,
                                                 const SurfaceRounds& others, Points& points, const Light& found,
                                                 Light& light) const {
    std::vector<GrainFinder::Shown> shown(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (const float scale = bases.stands_for(i); scale != 1.0f)
            for (Rgb& cell : light[i])
                cell *= scale;
        shown[i].luminance = samples[i].share * luminance(light[i]);
        const float scale = others.stands_for(i);
        if (!(scale > 0.0f))
            continue;
        ShadedPoint& at = points[i];
        at.stands_for = scale;
        if (at.seen.mirrors == 0)
            shown[i].normal = vec3(at.seen.point.geometric_normal);
        shown[i].luminance +=
            others.passes(i) * scale * (samples[i].share * luminance(found[i]) + luminance(at.left_to_all()));
        if (input_.lengths)
            input_.lengths->add(samples[i].pixel, at.vertices);
    }
    std::optional<GrainFinder> grains;
    if (input_.grains)
        grains.emplace(samples, std::move(shown), input_.width, input_.shared, *input_.grains);
    for (std::size_t i = 0; i < samples.size(); ++i)
        if (others.stands_for(i) > 0.0f && !take_grain(grains, i, others.passes(i), found[i], points[i]))
            light[i].add(found[i], Rgb(others.stands_for(i)));
    return grains;
}

// Points that mirrors have lost show what lies there, without noise. `times`: that of GrainFinder::Sample.
bool SurfaceShader::take_grain(std::optional<GrainFinder>& grains, std::size_t sample, float times,
                               const CellSum& found, ShadedPoint& at) const {
    if (!grains || at.seen.lost)
        return false;
    return grains->take(
        {sample, found, {at.base ? &*at.base : nullptr, at.gloss ? &*at.gloss : nullptr}, at.stands_for, times});
}

// What shading found at some samples, of which all pixels share a part. What that leaves of its noise is told of the
// light that rough lobes reflect.
void SurfaceShader::tell(const Samples& samples, const Some& some, const Points& points, const Light& found,
                         SurfaceRounds::Found& known) const {
    for (std::size_t begin = 0, end = 0; begin < some.size(); begin = end) {
        MeanCloseness of_base, of_gloss;
        for (; end < some.size() && samples[some[end]].pixel == samples[some[begin]].pixel; ++end) {
            of_base.add(points[some[end]].base);
            of_gloss.add(points[some[end]].gloss);
        }
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t i = some[k];
            const ShadedPoint& at = points[i];
            const auto noise = [&](const SharedBounce::Sample& of, const Rgb& shown, const MeanCloseness& around) {
                return luminance(shown) / samples[i].share /
                       std::sqrt(input_.shared->pixels_sharing(of, around.mean()));
            };
            known.noisy[i] = luminance(found[i]);
            known.shared[i] += luminance(at.left_to_all()) / samples[i].share;
            if (at.base)
                known.noisy[i] += noise(*at.base, at.base->shown(), of_base);
            if (at.gloss)
                known.noisy[i] += noise(
                    *at.gloss, shows_others(at) ? at.gloss->shown() : at.gloss->weight * at.gloss->of_other_cells(),
                    of_gloss);
        }
    }
}

void SurfaceShader::shade_some(const Samples& samples, const Some& some, Points& points, Light& found) {
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
void SurfaceShader::shade_reflected(const Samples& samples, const Some& some, Points& points, Light& found) {
    Some by;  // samples that show others
    for (const std::size_t i : some)
        if (shows_others(points[i]))
            by.push_back(i);
    if (by.empty())
        return;
    std::vector<ShadedPoint> all(by.size());
    parallel_for(
        by.size(),
        [&](std::size_t k) {
            ShadedPoint& from = points[by[k]];
            all[k].seen = mirrors_.reflected(samples[by[k]], from.seen, from.ray_rng, found[by[k]]);
            all[k].ray_rng = from.ray_rng;
        },
        kSamplesAtOnce);
    Samples seen_by;
    std::vector<ShadedPoint> met;
    Some meets;  // those of `by` that do
    for (std::size_t k = 0; k < by.size(); ++k)
        if (!all[k].seen.lost) {
            seen_by.push_back(samples[by[k]]);
            met.push_back(std::move(all[k]));
            meets.push_back(by[k]);
        }
    if (meets.empty())
        return;
    Points there(std::move(met));
    Light light(meets.size());
    light_reflected(seen_by, there, light);
    for (std::size_t k = 0; k < meets.size(); ++k) {
        ShadedPoint& from = points[meets[k]];
        from.vertices += there[k].vertices;
        if (!from.gloss) {
            found[meets[k]].add(light[k], Rgb(1.0f));
            continue;
        }
        const dvec3& position = from.seen.point.position;
        if (!from.closeness)  // nothing but surfaces is around
            from.gloss->closeness = float(1.0 / glm::distance(position, there[k].seen.point.position) +
                                          1.0 / glm::distance(position, seen_by[k].ray.origin));
        from.gloss->light += light[k].at(Cell::SS) / colour_of_gloss(from.seen.point.material);  // all of it is SS
    }
}

// And what these show in turn.
void SurfaceShader::light_reflected(const Samples& by, Points& there, Light& found) {
    Some all(by.size());
    std::iota(all.begin(), all.end(), std::size_t(0));
    const std::vector<BaseLight> bases = light_bases(by, all, there, &BaseLighting::light_by_few_rays);
    for (const std::size_t k : all)
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
    out.light += at.left_to_all() / sample.share;
    if (has_base(point.material))
        out.albedo = Bsdf(point.material, point.frame, Lobes::Base).base_albedo(-at.seen.arriving);
    out.share = sample.share;
    return out;
}

// To all pixels, and to samples around first.
void SurfaceShader::hand_over(const Samples& samples, Points& points, Light& light) const {
    std::vector<LightReuse::Sample> chosen;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!points.has(i))
            continue;
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
            if (*s) {
                (*s)->weight *= at.stands_for;
                (*s)->rays = at.stands_for;
            }
        for (LightReuse::Sample& c : at.chosen) {
            c.share = share;
            c.shared.swap(c.lobes == Lobes::Base ? at.base : at.gloss);
            chosen.push_back(std::move(c));
        }
        for (const std::optional<SharedBounce::Sample>& s : {at.base, at.gloss})
            if (s && !input_.shared->add(*s)) {
                light[i].add(shown_by_cell(*s), Rgb(1.0f / samples[i].share));
                if (input_.bound)
                    input_.bound->add_residual(samples[i].pixel, s->of(SharedBounce::Apart::Residual) * s->weight);
            }
        if (at.sky && !input_.shared_sky->add(*at.sky))
            light[i].at(Cell::SA) += at.sky->light * at.sky->weight / samples[i].share;
    }
    if (input_.reuse)
        input_.reuse->add(std::move(chosen));
}

}  // namespace brisance
