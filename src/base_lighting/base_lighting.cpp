#include "base_lighting/base_lighting.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base_lighting/batch_mean.h"
#include "core/parallel.h"

namespace brisance {

namespace {

constexpr Stream kTargets = stream_of("base lighting, targets"),
                 kTogether = stream_of("base lighting, samples together"),
                 kAlone = stream_of("base lighting, receivers alone");

constexpr std::size_t kRaysTogether = 16;
// Pixels on either side in the row that are asked whether something may be hidden.
constexpr std::uint32_t kPixelsAside = 4;

constexpr std::size_t kNeighbourhoodsAtOnce = 4;

// Of all light that would arrive without surfaces between: what is darker may err as if it were that bright.
constexpr float kDarkest = 0.05f;
constexpr float kTiny = 1e-30f;

Rgb arriving(const SurfaceReceiver& receiver, int light) {
    return light < 2 ? receiver.fire[light] : receiver.smoke[light - 2];
}

float all_arriving(const SurfaceReceiver& receiver) {
    return luminance(receiver.fire[0] + receiver.fire[1] + receiver.smoke[0] + receiver.smoke[1]);
}

void add(int light, const Rgb& scattered, BaseLight& out) {
    (light < 2 ? out.from_fire : out.from_smoke) += scattered;
}

bool may_look_together(std::span<const std::uint32_t> samples, std::span<const BasePoint> points) {
    return std::ranges::all_of(samples, [&](auto i) { return points[i].surface; });
}

}  // namespace

// Samples sorted by their receiver.
struct BaseLighting::SamplesOfReceivers {
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
    // Pixel of each receiver.
    std::vector<std::uint32_t> pixels(std::span<const BasePoint> points) const {
        std::vector<std::uint32_t> out;
        for (std::size_t r = 0; r + 1 < first.size(); ++r)
            out.push_back(points[of(r)[0]].pixel);
        return out;
    }
};

// A sample's base, as its viewer sees it.
class BaseLighting::Base {
public:
    // Keeps a reference to the surface.
    Base(const BasePoint& at, std::uint32_t sample)
        : sample_(sample),
          surface_(*at.surface),
          viewer_below_(glm::dot(surface_.geometric_normal, at.toward_viewer) < 0.0),
          lobe_(surface_.material, surface_.frame, Lobes::Base),
          viewed_(lobe_, at.toward_viewer) {}
    Base(const Base&) = delete;
    Base& operator=(const Base&) = delete;

    std::uint32_t sample() const { return sample_; }
    const SurfacePoint& surface() const { return surface_; }

    // The share of what a white Lambert surface reflects of light from there; none from below.
    Rgb relative_to_white(const vec3& light) const {
        const dvec3 toward_light = glm::normalize(dvec3(light) - surface_.position);
        const double cosine = glm::dot(surface_.frame.normal, toward_light),
                     height = glm::dot(surface_.geometric_normal, toward_light);
        const bool above = viewer_below_ ? height < 0.0 : height > 0.0;
        if (!above || !(cosine > 0.0))
            return Rgb(0.0f);
        return viewed_.evaluate(toward_light) * (std::numbers::pi_v<float> / float(cosine));
    }

private:
    std::uint32_t sample_;
    const SurfacePoint& surface_;
    bool viewer_below_;
    Bsdf lobe_;
    Bsdf::Viewed viewed_;
};

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

// What the receivers of a neighbourhood draw from, made when it is first asked for.
class BaseLighting::Fronts {
public:
    // Keeps references. `points`: that will be drawn, for each light.
    Fronts(const BaseLighting& lighting, const SurfaceReceiver& first, std::size_t points)
        : lighting_(lighting), first_(first), points_(points) {}

    const LightFront& of(int light) {
        if (!fronts_[light])
            fronts_[light].emplace(lighting_.ratios_[light]->around(
                {dvec3(first_.local), dvec3(first_.normal), LitPoint::Kind::Surface}, points_));
        return *fronts_[light];
    }
    // `at`: of the receiver that asks; the first one to do so decides.
    const WeightedTargets& targets(int light, const BasePoint& at) {
        if (!targets_[light]) {
            Rng rng(kTargets, at.pixel | lighting_.seed_, at.number * kLights + std::uint64_t(light));
            targets_[light] = draw_targets(*lighting_.ratios_[light], of(light), first_, rng);
        }
        return *targets_[light];
    }

private:
    const BaseLighting& lighting_;
    const SurfaceReceiver& first_;
    std::size_t points_;
    std::array<std::optional<LightFront>, kLights> fronts_;
    std::array<std::optional<WeightedTargets>, kLights> targets_;
};

// The pools of the receivers of a neighbourhood that look alone, of which `first` is the first.
class BaseLighting::Pools {
public:
    // Keeps references. `at`: a sample of it with a surface. `batches`, `most`: those of TargetPool.
    Pools(const BaseLighting& lighting, const SurfaceReceiver& first, const BasePoint& at, std::size_t batches,
          std::size_t most)
        : lighting_(lighting), first_(first), at_(at), batches_(batches), most_(most) {}

    TargetPool& of(int light) {
        if (!pools_[light])
            pools_[light].emplace(*lighting_.ratios_[light], first_, reaches(), batches_, most_,
                                  std::pair(at_.pixel | lighting_.seed_, at_.number * kLights + std::uint64_t(light)));
        return *pools_[light];
    }

private:
    TargetPool::Reaches reaches() const {
        return [&](const vec3& point) { return !lighting_.passage(*at_.surface, point).blocked; };
    }

    const BaseLighting& lighting_;
    const SurfaceReceiver& first_;
    const BasePoint& at_;
    std::size_t batches_, most_;
    std::array<std::optional<TargetPool>, kLights> pools_;
};

BaseLighting::BaseLighting(const Medium& medium, const MediumLighting& lighting, const Panes& panes, bool through_panes,
                           int width, float tolerance, std::uint32_t seed)
    : medium_(medium),
      panes_(panes),
      through_panes_(through_panes),
      width_(static_cast<std::uint32_t>(width)),
      tolerance_(tolerance),
      seed_(std::uint64_t(seed) << 32) {
    const VisibilityRatios fire = lighting.fire_visibility(), smoke = lighting.smoke_visibility();
    ratios_ = {fire[0], fire[1], smoke[0], smoke[1]};
}

Panes::Passage BaseLighting::passage(const SurfacePoint& surface, const vec3& light) const {
    const dvec3 from = surface.start_toward(dvec3(light)), offset = dvec3(light) - from;
    const double distance = glm::length(offset);
    return panes_.along({from, offset / distance}, distance);
}

BaseLighting::Seen BaseLighting::see_together(int light, const SurfaceReceiver& receiver,
                                              const WeightedTargets& targets, const Bases& bases, Rng& rng,
                                              std::span<BaseLight> out) const {
    if (targets.empty())
        return Seen::NoLight;
    const Rgb there = arriving(receiver, light);
    const std::size_t rays = (kRaysTogether + bases.size() - 1) / bases.size(), all = rays * bases.size();
    const float shift = rng.next();
    std::size_t arrived = 0;
    for (std::size_t i = 0; i < all; ++i) {
        const Base& base = bases[i / rays];
        const vec3& from = targets.at((float(i) + shift) / float(all));
        const Panes::Passage way = passage(base.surface(), from);
        const Rgb share = base.relative_to_white(from);
        if (way.panes > 0 || share == Rgb(0.0f))
            return Seen::Part;
        if (way.blocked)
            continue;
        ++arrived;
        add(light, there * share / float(rays), out[base.sample()]);
    }
    return arrived == all ? Seen::All : (arrived == 0 ? Seen::Nothing : Seen::Part);
}

BaseLighting::Together BaseLighting::light_together(const SurfaceReceiver& receiver, Fronts& around,
                                                    std::span<const std::uint32_t> samples,
                                                    std::span<const BasePoint> points, std::span<BaseLight> out) const {
    Together found{{}, points[samples[0]].pixel, false};
    if (!may_look_together(samples, points))
        return found;
    found.tried = true;
    Bases bases;  // made for the first light that arrives
    Rng rng(kTogether, found.pixel | seed_, points[samples[0]].number);
    for (int light = 0; light < kLights; ++light) {
        if (!ratios_[light] || arriving(receiver, light) == Rgb(0.0f))
            continue;
        for (std::size_t k = bases.size(); k < samples.size(); ++k)
            bases.emplace_back(points[samples[k]], samples[k]);
        found.seen[light] = see_together(light, receiver, around.targets(light, points[samples[0]]), bases, rng, out);
    }
    return found;
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

// What arrives past other surfaces at the samples of a receiver, each along its own part of the rays.
void BaseLighting::measure(int light, const SurfaceReceiver& receiver, TargetPool& pool, std::size_t most_batches,
                           const Bases& bases, Rng& rng, std::span<BaseLight> out) const {
    const LitPoint lit{dvec3(receiver.local), dvec3(receiver.normal), LitPoint::Kind::Surface};
    const std::size_t n = bases.size();
    std::vector<Shares> seen(n);
    std::array<VisibilityRatio::Draw, VisibilityRatio::kDraws> draws;
    const float darkest = kDarkest * all_arriving(receiver) / std::max(luminance(arriving(receiver, light)), kTiny);
    BatchMean known;
    float all = 0.0f;
    const float start = rng.next();
    // Where samples get unequally many draws, chance decides which get more.
    const std::size_t first = most_batches < n ? static_cast<std::size_t>(rng.next() * float(n)) : 0;
    for (std::size_t b = 0; b < std::min(n, most_batches); ++b) {
        ratios_[light]->weigh(lit, pool.batch(start, b), draws);
        float of_batch = 0.0f, seen_of_batch = 0.0f;
        for (std::size_t k = 0; k < draws.size(); ++k) {
            const VisibilityRatio::Draw& d = draws[k];
            if (!(d.weight > 0.0f))
                continue;
            of_batch += d.weight;
            const std::size_t to = (first + b + k) % n;  // every sample gets draws of all strata
            const Base& base = bases[to];
            const Rgb share = base.relative_to_white(d.point);
            if (share == Rgb(0.0f))
                continue;
            const Panes::Passage way = passage(base.surface(), d.point);
            if (way.blocked)
                continue;
            const Rgb passes = share * d.weight * way.weight;
            (way.panes > 0 ? seen[to].through_panes : seen[to].clear) += passes;
            seen_of_batch += luminance(passes);
        }
        all += of_batch;
        known.add(of_batch > 0.0f ? seen_of_batch / of_batch : 0.0f);
        const bool even = (b + 1) * draws.size() % n == 0;  // samples got equally many draws
        if (even && known.within(tolerance_, darkest))
            break;
    }
    if (!(all > 0.0f))
        return;
    const Rgb there = arriving(receiver, light) * (float(n) / all);
    for (std::size_t k = 0; k < n; ++k) {
        add(light, there * seen[k].clear, out[bases[k].sample()]);
        if (through_panes_)
            out[bases[k].sample()].through_panes += there * seen[k].through_panes;
    }
}

void BaseLighting::light_alone(const SurfaceReceiver& receiver, Pools& around, std::size_t most_batches,
                               std::span<const std::uint32_t> samples, std::span<const BasePoint> points,
                               std::span<BaseLight> out) const {
    Bases bases;
    for (const std::uint32_t i : samples) {
        out[i] = {};
        if (points[i].surface)
            bases.emplace_back(points[i], i);
    }
    if (bases.empty())
        return;
    const BasePoint& first = points[bases.front().sample()];
    Rng rng(kAlone, first.pixel | seed_, first.number);
    for (int light = 0; light < kLights; ++light)
        if (ratios_[light] && !ratios_[light]->empty() && arriving(receiver, light) != Rgb(0.0f))
            measure(light, receiver, around.of(light), most_batches, bases, rng, out);
}

void BaseLighting::light_alone(std::span<const std::uint32_t> which, std::size_t most_batches,
                               const SharedReceivers& receivers, const SamplesOfReceivers& samples,
                               std::span<const BasePoint> points, std::span<BaseLight> out) const {
    std::size_t batches = 0, most = 0;
    std::optional<std::pair<std::uint32_t, std::uint32_t>> first;  // receiver, and a sample of it
    for (const std::uint32_t r : which) {
        const std::size_t own = std::min(samples.of(r).size(), most_batches);
        batches += own;
        most = std::max(most, own);
        for (const std::uint32_t i : samples.of(r))
            if (!first && points[i].surface)
                first.emplace(r, i);
    }
    if (!first)
        return;
    Pools around(*this, receivers[first->first], points[first->second], batches, most);
    for (const std::uint32_t r : which)
        light_alone(receivers[r], around, most_batches, samples.of(r), points, out);
}

std::vector<BaseLight> BaseLighting::light(std::span<const BasePoint> points, const SharedReceivers& receivers) const {
    std::vector<BaseLight> out(points.size());
    const SamplesOfReceivers samples(receivers);
    const Neighbourhoods neighbourhoods(medium_, receivers, samples.pixels(points), width_);
    std::vector<Together> together(receivers.count());
    parallel_for(
        neighbourhoods.count(),
        [&](std::size_t n) {
            const std::span<const std::uint32_t> members = neighbourhoods.receivers_of(n);
            Fronts around(*this, receivers[members.front()], kTargetsDrawn);
            for (const std::uint32_t r : members)
                together[r] = light_together(receivers[r], around, samples.of(r), points, out);
        },
        kNeighbourhoodsAtOnce);
    parallel_for(
        neighbourhoods.count(),
        [&](std::size_t n) {
            std::vector<std::uint32_t> unsettled;
            for (const std::uint32_t r : neighbourhoods.receivers_of(n))
                if (!settled(together, r))
                    unsettled.push_back(r);
            light_alone(unsettled, points.size(), receivers, samples, points, out);
        },
        kNeighbourhoodsAtOnce);
    return out;
}

std::vector<BaseLight> BaseLighting::light_alone(std::span<const BasePoint> points, const SharedReceivers& receivers,
                                                 std::size_t most_batches) const {
    std::vector<BaseLight> out(points.size());
    const SamplesOfReceivers samples(receivers);
    const Neighbourhoods neighbourhoods(medium_, receivers, samples.pixels(points), width_);
    parallel_for(
        neighbourhoods.count(),
        [&](std::size_t n) {
            light_alone(neighbourhoods.receivers_of(n), most_batches, receivers, samples, points, out);
        },
        kNeighbourhoodsAtOnce);
    return out;
}

}  // namespace brisance
