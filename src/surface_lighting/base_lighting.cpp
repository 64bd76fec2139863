#include "surface_lighting/base_lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr Stream kTargets = stream_of("base lighting, targets"),
                 kTogether = stream_of("base lighting, samples together"),
                 kAlone = stream_of("base lighting, samples alone");

constexpr std::size_t kRaysTogether = 16;
// Pixels on either side in the row that are asked whether something may be hidden.
constexpr std::uint32_t kPixelsAside = 4;

constexpr std::size_t kReceiversAtOnce = 32, kNeighbourhoodsAtOnce = 4;

// Samples sorted by their receiver.
struct SamplesOfReceivers {
    std::vector<std::uint32_t> first, samples;  // `first` has one more than there are receivers, as an end

    explicit SamplesOfReceivers(const SharedReceivers& receivers) : first(receivers.count() + 1, 0) {
        const std::vector<std::uint32_t>& of = receivers.receiver_of();
        for (const std::uint32_t r : of)
            ++first[r + 1];
        for (std::size_t r = 1; r < first.size(); ++r)
            first[r] += first[r - 1];
        samples.resize(of.size());
        std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
        for (std::uint32_t i = 0; i < of.size(); ++i)
            samples[next[of[i]]++] = i;
    }
    std::span<const std::uint32_t> of(std::size_t receiver) const {
        return std::span(samples).subspan(first[receiver], first[receiver + 1] - first[receiver]);
    }
};

Rgb arriving(const SurfaceReceiver& receiver, int light) {
    return light < 2 ? receiver.fire[light] : receiver.smoke[light - 2];
}

void add(int light, const Rgb& scattered, BaseLight& out) {
    (light < 2 ? out.from_fire : out.from_smoke) += scattered;
}

// The base's share of what a white Lambert surface reflects of light from there; none from below.
Rgb relative_to_white(const Bsdf& base, const SurfacePoint& at, const dvec3& toward_viewer, const dvec3& toward_light) {
    const double cosine = glm::dot(at.frame.normal, toward_light);
    const bool above = glm::dot(at.geometric_normal, toward_light) * glm::dot(at.geometric_normal, toward_viewer) > 0.0;
    if (!above || !(cosine > 0.0))
        return Rgb(0.0f);
    return base.evaluate(toward_viewer, toward_light) * (std::numbers::pi_v<float> / float(cosine));
}

bool may_look_together(std::span<const std::uint32_t> samples, std::span<const BasePoint> points) {
    return std::ranges::all_of(samples, [&](auto i) { return points[i].surface; });
}

}  // namespace

// What the samples of a receiver found together.
struct BaseLighting::Together {
    std::array<Seen, kLights> seen{};
    std::uint32_t pixel = 0;
    bool tried = false;

    // Whether both see all of each light, or both nothing of it.
    bool agrees(const Together& other) const {
        for (int light = 0; light < kLights; ++light) {
            const Seen own = seen[light], there = other.seen[light];
            if (own != Seen::NoLight && there != Seen::NoLight && (own != there || own == Seen::Part))
                return false;
        }
        return true;
    }
};

BaseLighting::BaseLighting(const Medium& medium, const MediumLighting& lighting, const Panes& panes,
                           bool through_panes, int width)
    : medium_(medium), panes_(panes), through_panes_(through_panes), width_(static_cast<std::uint32_t>(width)) {
    const VisibilityRatios fire = lighting.fire_visibility(), smoke = lighting.smoke_visibility();
    ratios_ = {fire[0], fire[1], smoke[0], smoke[1]};
}

Panes::Passage BaseLighting::passage(const SurfacePoint& surface, const vec3& light) const {
    const dvec3 from = surface.start_toward(dvec3(light)), offset = dvec3(light) - from;
    const double distance = glm::length(offset);
    return panes_.along({from, offset / distance}, distance);
}

BaseLighting::Seen BaseLighting::see_together(int light, const SurfaceReceiver& receiver,
                                              const WeightedTargets& targets, std::span<const std::uint32_t> samples,
                                              std::span<const BasePoint> points, Rng& rng,
                                              std::span<BaseLight> out) const {
    const Rgb there = arriving(receiver, light);
    if (targets.empty() || there == Rgb(0.0f))
        return Seen::NoLight;
    const std::size_t rays = (kRaysTogether + samples.size() - 1) / samples.size(), all = rays * samples.size();
    const float shift = rng.next();
    std::size_t arrived = 0;
    for (std::size_t i = 0; i < all; ++i) {
        const std::uint32_t sample = samples[i / rays];
        const BasePoint& p = points[sample];
        const vec3& from = targets.at((float(i) + shift) / float(all));
        const Panes::Passage way = passage(*p.surface, from);
        const Rgb share = relative_to_white(Bsdf(p.surface->material, p.surface->frame, Lobes::Base), *p.surface,
                                            p.toward_viewer, glm::normalize(dvec3(from) - p.surface->position));
        if (way.panes > 0 || share == Rgb(0.0f))
            return Seen::Part;
        if (way.blocked)
            continue;
        ++arrived;
        add(light, there * share / float(rays), out[sample]);
    }
    return arrived == all ? Seen::All : (arrived == 0 ? Seen::Nothing : Seen::Part);
}

BaseLighting::Together BaseLighting::light_together(const SurfaceReceiver& receiver, const Targets& targets,
                                                    std::span<const std::uint32_t> samples,
                                                    std::span<const BasePoint> points, std::span<BaseLight> out) const {
    Together found{{}, points[samples[0]].pixel, false};
    if (!may_look_together(samples, points))
        return found;
    Rng rng(kTogether, found.pixel, points[samples[0]].number);
    for (int light = 0; light < kLights; ++light)
        found.seen[light] = see_together(light, receiver, targets[light], samples, points, rng, out);
    found.tried = true;
    return found;
}

// For the neighbourhood of a receiver that looks at them together.
BaseLighting::Targets BaseLighting::targets_at(const SurfaceReceiver& receiver, const BasePoint& first) const {
    Targets targets;
    Rng rng(kTargets, first.pixel, first.number);
    for (int light = 0; light < kLights; ++light)
        if (ratios_[light])
            targets[light] = draw_targets(*ratios_[light], receiver, rng);
    return targets;
}

// Whether nothing is hidden in part here or beside, in the row of pixels.
bool BaseLighting::settled(std::span<const Together> all, std::size_t r) const {
    const auto beside = [&](std::size_t other) {
        const std::uint32_t a = all[r].pixel, b = all[other].pixel;
        return a / width_ == b / width_ && (a > b ? a - b : b - a) <= kPixelsAside;
    };
    bool sure = all[r].tried && all[r].agrees(all[r]);
    for (std::size_t other = r; sure && other-- > 0 && beside(other);)
        sure = all[r].agrees(all[other]);
    for (std::size_t other = r + 1; sure && other < all.size() && beside(other); ++other)
        sure = all[r].agrees(all[other]);
    return sure;
}

BaseLighting::Shares BaseLighting::measured(const VisibilityRatio& ratio, const BasePoint& p, Rng& rng) const {
    std::array<VisibilityRatio::Draw, VisibilityRatio::kDraws> draws;
    const LitPoint lit{p.surface->position, p.surface->frame.normal, LitPoint::Kind::Surface};
    if (!ratio.draw(lit, rng, draws))
        return {};
    const Bsdf base(p.surface->material, p.surface->frame, Lobes::Base);
    Shares seen;
    float all = 0.0f;
    for (const VisibilityRatio::Draw& d : draws) {
        if (!(d.weight > 0.0f))
            continue;
        all += d.weight;
        const Rgb share = relative_to_white(base, *p.surface, p.toward_viewer, dvec3(d.direction));
        if (share == Rgb(0.0f))
            continue;
        const Panes::Passage way = passage(*p.surface, d.point);
        if (!way.blocked)
            (way.panes > 0 ? seen.through_panes : seen.clear) += share * d.weight * way.weight;
    }
    if (!(all > 0.0f))
        return {};
    return {seen.clear / all, seen.through_panes / all};
}

BaseLight BaseLighting::light_alone(const BasePoint& point, const SurfaceReceiver& receiver) const {
    BaseLight out;
    if (!point.surface)
        return out;
    Rng rng(kAlone, point.pixel, point.number);
    for (int light = 0; light < kLights; ++light) {
        const Rgb there = arriving(receiver, light);
        if (!ratios_[light] || there == Rgb(0.0f))
            continue;
        const Shares seen = measured(*ratios_[light], point, rng);
        add(light, there * seen.clear, out);
        if (through_panes_)
            out.through_panes += there * seen.through_panes;
    }
    return out;
}

std::vector<BaseLight> BaseLighting::light(std::span<const BasePoint> points, const SharedReceivers& receivers) const {
    std::vector<BaseLight> out(points.size());
    const SamplesOfReceivers samples(receivers);
    std::vector<std::uint32_t> pixel_of;
    for (std::size_t r = 0; r < receivers.count(); ++r)
        pixel_of.push_back(points[samples.of(r)[0]].pixel);
    const Neighbourhoods neighbourhoods(medium_, receivers, pixel_of, width_);
    std::vector<Together> together(receivers.count());
    parallel_for(
        neighbourhoods.count(),
        [&](std::size_t n) {
            const std::uint32_t first = neighbourhoods.first(n);
            Targets targets;
            bool drawn = false;
            for (std::uint32_t r = first; r < receivers.count() && neighbourhoods.of(r) == n; ++r) {
                if (!drawn && may_look_together(samples.of(r), points)) {
                    targets = targets_at(receivers[r], points[samples.of(r)[0]]);
                    drawn = true;
                }
                together[r] = light_together(receivers[r], targets, samples.of(r), points, out);
            }
        },
        kNeighbourhoodsAtOnce);
    parallel_for(
        together.size(),
        [&](std::size_t r) {
            if (settled(together, r))
                return;
            for (const std::uint32_t i : samples.of(r))
                out[i] = light_alone(points[i], receivers[r]);
        },
        kReceiversAtOnce);
    return out;
}

}  // namespace brisance
