#include "surface_lighting/light_reuse.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/cpu_clock.h"
#include "core/parallel.h"

namespace brisance {

namespace {

constexpr Stream kReuse = stream_of("surface_lighting/light_reuse");

constexpr std::size_t kReusesAtOnce = 64;

// Samples reuse nothing of others whose normal has less than this cosine to theirs, or whose distance from the eye
// differs by more than this part: 25 degrees and 10 %, as [1] has it.
constexpr double kReusedNormal = 0.906, kOtherDistance = 0.1;

bool alike(const LightReuse::Sample& a, const LightReuse::Sample& b) {
    return a.lobes == b.lobes && a.material == b.material &&
           glm::dot(a.vertex.lit().normal, b.vertex.lit().normal) > kReusedNormal &&
           std::abs(a.from_eye - b.from_eye) < kOtherDistance * a.from_eye;
}

}  // namespace

LightReuse::LightReuse(const ReservoirLights& lights, int width, int height, const Settings& settings,
                       SharedBounce* shared, BoundAccount* bound)
    : lights_(lights),
      width_(width),
      height_(height),
      settings_(settings),
      reach_(static_cast<int>(std::ceil(settings.radius))),
      shared_(shared),
      bound_(bound),
      rows_(std::size_t(height)),
      pixels_(std::size_t(width) * height, Rgb(0.0f)) {}

void LightReuse::add(std::vector<Sample> samples) {
    if (samples.empty())
        return;
    int last = 0;
    for (Sample& s : samples) {
        last = static_cast<int>(s.pixel / std::uint32_t(width_));
        rows_[last].samples.push_back(std::move(s));
    }
    light_rows(last + 1 - reach_);
}

std::vector<Rgb> LightReuse::take_pixels() {
    light_rows(height_);
    return std::move(pixels_);
}

// Rows before `end`, whose neighbours have been added.
void LightReuse::light_rows(int end) {
    if (end <= lit_)
        return;
    for (int y = std::max(0, lit_ - reach_); y < std::min(height_, end + reach_); ++y)
        count_samples(rows_[y]);
    std::vector<Sample*> samples;
    for (int y = lit_; y < end; ++y)
        for (Sample& s : rows_[y].samples)
            samples.push_back(&s);
    std::vector<Found> found(samples.size());
    parallel_for(
        samples.size(),
        [&](std::size_t i) {
            const AddedCpuTime time(bound_ ? &found[i].seconds : nullptr);
            found[i].light = light(*samples[i]);
        },
        kReusesAtOnce);
    for (std::size_t i = 0; i < samples.size(); ++i)
        show(*samples[i], found[i]);
    lit_ = end;
    for (int y = 0; y < lit_ - reach_; ++y)
        rows_[y] = {};
}

void LightReuse::count_samples(Row& row) const {
    row.first.assign(std::size_t(width_) + 1, 0);
    for (const Sample& s : row.samples)
        ++row.first[s.pixel % std::uint32_t(width_) + 1];
    for (int x = 0; x < width_; ++x)
        row.first[x + 1] += row.first[x];
}

// A sample like this one in a pixel around it, which may be its own. Null: the place drawn has none.
const LightReuse::Sample* LightReuse::choose_around(const Sample& sample, Rng& rng) const {
    const double distance = settings_.radius * std::sqrt(rng.next_double()),
                 angle = 2.0 * std::numbers::pi * rng.next_double(), u = rng.next_double();
    const int x = static_cast<int>(std::lround(sample.pixel % std::uint32_t(width_) + distance * std::cos(angle)));
    const int y = static_cast<int>(std::lround(sample.pixel / std::uint32_t(width_) + distance * std::sin(angle)));
    if (x < 0 || x >= width_ || y < 0 || y >= height_)
        return nullptr;
    const Row& row = rows_[y];
    const std::uint32_t first = row.first[x], count = row.first[x + 1] - first;
    for (std::uint32_t k = 0; k < count; ++k) {
        const Sample& other = row.samples[first + (static_cast<std::uint32_t>(u * count) + k) % count];
        if (&other != &sample && alike(sample, other))
            return &other;
    }
    return nullptr;
}

// The sample itself, and neighbours.
std::vector<const LightReuse::Sample*> LightReuse::set_of(const Sample& sample, Rng& rng) const {
    std::vector<const Sample*> set{&sample};
    for (int n = 0; n < settings_.neighbours; ++n)
        if (const Sample* other = choose_around(sample, rng);
            other && std::find(set.begin(), set.end(), other) == set.end())
            set.push_back(other);
    return set;
}

// The first of the set reuses what all chose. What is kept has 1 / t_x(y) for its weight.
void LightReuse::offer_unoccluded(const std::vector<const Sample*>& set, Reservoir<LightReservoir>& kept,
                                  Rng& rng) const {
    const Sample* const x = set.front();
    for (const Sample* from : set) {
        LightReservoir y = from->reservoir;
        const double here = !(y.weight > 0.0) ? 0.0 : from == x ? y.target : lights_.target(y, x->vertex);
        if (!(here > 0.0))
            continue;
        double all = 0.0;
        for (const Sample* other : set)
            all += other == from ? y.target : other == x ? here : lights_.target(y, other->vertex);
        const double w = y.target / all * here * y.weight;
        y.weight = 1.0 / here;
        kept.offer(y, w, rng);
    }
}

void LightReuse::offer_visible(const std::vector<const Sample*>& set, Reservoir<LightReservoir>& kept, Rng& rng) const {
    const Sample* const x = set.front();
    const auto neighbours = double(set.size() - 1);
    if (LightReservoir y = x->reservoir; y.weight > 0.0) {
        double share = 1.0;
        if (set.size() > 1) {
            const auto i = std::min(static_cast<std::size_t>(rng.next_double() * neighbours), set.size() - 2);
            const PathVertex& there = set[1 + i]->vertex;
            double a = lights_.target(y, there);
            if (a > 0.0 && !lights_.reaches(y, there))
                a = 0.0;
            const double b = y.target / neighbours;
            share = b / (a + b);
        }
        const double w = share * y.target * y.weight;
        y.weight = 1.0 / y.target;
        kept.offer(y, w, rng);
    }
    for (std::size_t i = 1; i < set.size(); ++i) {
        LightReservoir y = set[i]->reservoir;
        const double here = y.weight > 0.0 ? lights_.target(y, x->vertex) : 0.0;
        if (!(here > 0.0))
            continue;
        const double w = y.target / (y.target + here / neighbours) / neighbours * here * y.weight;
        y.weight = 1.0 / here;
        kept.offer(y, w, rng);
    }
}

BoundedLight LightReuse::light(const Sample& sample) const {
    Rng rng(kReuse, sample.pixel | std::uint64_t(settings_.seed) << 32,
            3 * sample.number + static_cast<std::uint64_t>(sample.lobes));
    const std::vector<const Sample*> set = set_of(sample, rng);
    Reservoir<LightReservoir> kept;
    if (settings_.visibility)
        offer_visible(set, kept, rng);
    else
        offer_unoccluded(set, kept, rng);
    if (!(kept.sum() > 0.0))
        return {};
    LightReservoir y = kept.kept();
    y.weight *= kept.sum();
    return lights_.from_reservoir(y, sample.vertex, rng);
}

void LightReuse::show(Sample& sample, const Found& found) {
    const Rgb& light = found.light.light;
    if (bound_) {
        BoundTally tally;
        tally.shown = luminance(light);
        tally.lost = found.light.lost;
        tally.light_seconds = found.seconds;
        bound_->add(sample.pixel, tally, Rgb(sample.share));
    }
    Rgb& pixel = pixels_[sample.pixel];
    if (!sample.shared) {
        pixel += sample.share * light;
        return;
    }
    SharedBounce::Sample& s = *sample.shared;
    for (int c = 0; c < 3; ++c)
        s.light[c] += sample.colour[c] > 0.0f ? light[c] / sample.colour[c] : 0.0f;
    if (shared_->add(s))
        return;
    pixel += s.light * s.weight;
    if (bound_)
        bound_->add_residual(sample.pixel, s.of(SharedBounce::Apart::Residual) * s.weight);
}

}  // namespace brisance
