#include "surface_lighting/light_reuse.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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

bool same(const LightReservoir& a, const LightReservoir& b) {
    return a.light == b.light && a.numbers == b.numbers;
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
      done_(std::size_t(settings.rounds), 0),
      pixels_(std::size_t(width) * height, Rgb(0.0f)) {}

std::uint64_t LightReuse::bytes_of(int width, int height, int rays, int rows_at_once, const Settings& settings) {
    constexpr std::uint64_t kLobes = 2, kGrowth = 2;
    const int rows = (settings.rounds + 1) * static_cast<int>(std::ceil(settings.radius)) + rows_at_once;
    const std::uint64_t samples =
        std::uint64_t(width) * std::uint64_t(std::min(rows, height)) * std::uint64_t(rays) * kLobes;
    return std::uint64_t(width) * std::uint64_t(height) * sizeof(Rgb) +
           samples * kGrowth * (sizeof(Sample) + 2 * sizeof(Choice));
}

void LightReuse::add(std::vector<Sample> samples) {
    if (samples.empty())
        return;
    int last = 0;
    for (Sample& s : samples) {
        last = static_cast<int>(s.pixel / std::uint32_t(width_));
        rows_[last].samples.push_back(std::move(s));
    }
    advance(last + 1);
}

std::vector<Rgb> LightReuse::take_pixels() {
    advance(height_);
    return std::move(pixels_);
}

// Every round as far as the one before has come, the first as far as rows have been added. Rows that no sample can
// reach any more are forgotten.
void LightReuse::advance(int added) {
    int known = added;
    for (int round = 0; round < settings_.rounds; ++round) {
        const int begin = done_[round], end = known < height_ ? known - reach_ : height_;
        if (end <= begin)
            return;
        if (round == 0)
            prepare_rows(std::max(0, begin - reach_), std::min(height_, end + reach_));
        if (round + 1 < settings_.rounds)
            exchange_rows(round, begin, end);
        else
            light_rows(begin, end);
        done_[round] = known = end;
    }
    for (int y = 0; y < known - reach_; ++y)
        rows_[y] = {};
}

void LightReuse::prepare_rows(int begin, int end) {
    for (int y = begin; y < end; ++y) {
        Row& row = rows_[y];
        if (!row.first.empty())
            continue;
        row.first.assign(std::size_t(width_) + 1, 0);
        for (const Sample& s : row.samples) {
            ++row.first[s.pixel % std::uint32_t(width_) + 1];
            row.choices[0].push_back({s.reservoir});
        }
        for (int x = 0; x < width_; ++x)
            row.first[x + 1] += row.first[x];
    }
}

void LightReuse::exchange_rows(int round, int begin, int end) {
    for (int y = begin; y < end; ++y) {
        std::vector<Choice>& kept = rows_[y].choices[(round + 1) % 2];
        kept.resize(rows_[y].samples.size());
        parallel_for(
            kept.size(), [&](std::size_t i) { kept[i] = exchange(round, y, i); }, kReusesAtOnce);
    }
}

void LightReuse::light_rows(int begin, int end) {
    std::vector<std::pair<int, std::size_t>> samples;
    for (int y = begin; y < end; ++y)
        for (std::size_t i = 0; i < rows_[y].samples.size(); ++i)
            samples.emplace_back(y, i);
    std::vector<Found> found(samples.size());
    parallel_for(
        samples.size(),
        [&](std::size_t i) {
            const AddedCpuTime time(bound_ ? &found[i].seconds : nullptr);
            found[i].light = light(samples[i].first, samples[i].second);
        },
        kReusesAtOnce);
    for (std::size_t i = 0; i < samples.size(); ++i)
        show(rows_[samples[i].first].samples[samples[i].second], found[i]);
}

// A sample like this one in a pixel around it, which may be its own. None: the place drawn has none.
std::optional<LightReuse::Member> LightReuse::choose_around(int round, const Sample& sample, Rng& rng) const {
    const double distance = settings_.radius * std::sqrt(rng.next_double()),
                 angle = 2.0 * std::numbers::pi * rng.next_double(), u = rng.next_double();
    const int x = static_cast<int>(std::lround(sample.pixel % std::uint32_t(width_) + distance * std::cos(angle)));
    const int y = static_cast<int>(std::lround(sample.pixel / std::uint32_t(width_) + distance * std::sin(angle)));
    if (x < 0 || x >= width_ || y < 0 || y >= height_)
        return std::nullopt;
    const Row& row = rows_[y];
    const std::uint32_t first = row.first[x], count = row.first[x + 1] - first;
    for (std::uint32_t k = 0; k < count; ++k) {
        const std::size_t number = first + (static_cast<std::uint32_t>(u * count) + k) % count;
        const Sample& other = row.samples[number];
        if (&other != &sample && alike(sample, other))
            return Member{&other, &row.choices[round % 2][number]};
    }
    return std::nullopt;
}

// The sample itself, and neighbours.
LightReuse::Set LightReuse::set_of(int round, int y, std::size_t number, Rng& rng) const {
    const Sample& sample = rows_[y].samples[number];
    Set set{{&sample, &rows_[y].choices[round % 2][number]}};
    const auto is_known = [&](const Sample* s) {
        return std::any_of(set.begin(), set.end(), [&](const Member& m) { return m.sample == s; });
    };
    for (int n = 0; n < settings_.neighbours; ++n)
        if (const std::optional<Member> other = choose_around(round, sample, rng); other && !is_known(other->sample))
            set.push_back(*other);
    return set;
}

void LightReuse::offer_unoccluded(const Set& set, Reservoir<LightReservoir>& kept, Rng& rng) const {
    const Member& x = set.front();
    for (const Member& from : set) {
        LightReservoir y = from.choice->reservoir;
        const bool own = from.sample == x.sample;
        const double here = !(y.weight > 0.0) ? 0.0 : own ? y.target : lights_.target(y, x.sample->vertex);
        if (!(here > 0.0))
            continue;
        double all = 0.0;
        for (const Member& other : set)
            all += other.choice->count * (other.sample == from.sample ? y.target
                                          : other.sample == x.sample  ? here
                                                                      : lights_.target(y, other.sample->vertex));
        const double w = from.choice->count * y.target / all * here * y.weight;
        y.weight = 1.0 / here;
        y.target = here;
        kept.offer(y, w, rng);
    }
}

void LightReuse::offer_visible(const Set& set, Reservoir<LightReservoir>& kept, Rng& rng) const {
    const Member& x = set.front();
    const auto neighbours = double(set.size() - 1);
    if (LightReservoir y = x.choice->reservoir; y.weight > 0.0) {
        double share = 1.0;
        if (set.size() > 1) {
            const auto i = std::min(static_cast<std::size_t>(rng.next_double() * neighbours), set.size() - 2);
            const Member& other = set[1 + i];
            double a = other.choice->count * lights_.target(y, other.sample->vertex);
            if (a > 0.0 && !lights_.reaches(y, other.sample->vertex))
                a = 0.0;
            const double b = x.choice->count * y.target / neighbours;
            share = b / (a + b);
        }
        const double w = share * y.target * y.weight;
        y.weight = 1.0 / y.target;
        kept.offer(y, w, rng);
    }
    for (std::size_t i = 1; i < set.size(); ++i) {
        LightReservoir y = set[i].choice->reservoir;
        const double here = y.weight > 0.0 ? lights_.target(y, x.sample->vertex) : 0.0;
        if (!(here > 0.0))
            continue;
        const double a = set[i].choice->count * y.target, b = x.choice->count * here / neighbours;
        const double w = a / (a + b) / neighbours * here * y.weight;
        y.weight = 1.0 / here;
        y.target = here;
        kept.offer(y, w, rng);
    }
}

// Empty where nothing is left.
LightReservoir LightReuse::resample(const Set& set, Rng& rng) const {
    Reservoir<LightReservoir> kept;
    if (settings_.visibility)
        offer_visible(set, kept, rng);
    else
        offer_unoccluded(set, kept, rng);
    if (!(kept.sum() > 0.0))
        return {};
    LightReservoir y = kept.kept();
    y.weight *= kept.sum();
    return y;
}

// Numbers are named by round.
Rng LightReuse::rng_of(int round, const Sample& sample) const {
    return Rng(Stream(std::uint32_t(kReuse) + std::uint32_t(round)), sample.pixel | std::uint64_t(settings_.seed) << 32,
               3 * sample.number + static_cast<std::uint64_t>(sample.lobes));
}

// For the next round.
LightReuse::Choice LightReuse::exchange(int round, int y, std::size_t number) const {
    Rng rng = rng_of(round, rows_[y].samples[number]);
    const Set set = set_of(round, y, number, rng);
    Choice out{resample(set, rng), 0.0};
    for (const Member& m : set)
        out.count += m.choice->count;
    const Member& x = set.front();
    if (settings_.visibility && out.reservoir.weight > 0.0 && !same(out.reservoir, x.choice->reservoir) &&
        !lights_.reaches(out.reservoir, x.sample->vertex))
        out.reservoir.weight = 0.0;
    return out;
}

BoundedLight LightReuse::light(int y, std::size_t number) const {
    const Sample& sample = rows_[y].samples[number];
    const int round = settings_.rounds - 1;
    Rng rng = rng_of(round, sample);
    const LightReservoir kept = resample(set_of(round, y, number, rng), rng);
    return kept.weight > 0.0 ? lights_.from_reservoir(kept, sample.vertex, rng) : BoundedLight{};
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
