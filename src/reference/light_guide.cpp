#include "reference/light_guide.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.h"
#include "transport/particle_walk.h"

namespace brisance {

namespace {

constexpr Stream kStream = stream_of("light guide");
constexpr std::uint64_t kParticles = 1 << 15;
constexpr std::size_t kBlock = 256;
// A cell's own particles count as much as its surroundings when it has this many.
constexpr double kPrior = 4.0;
// Every cell has this share of the mean radiance, whatever its particles say.
constexpr double kFloor = 0.02;
constexpr float kLeastShare = 0.1f, kMostShare = 0.8f;

// Sums that do not depend on the order of their terms.
using Fixed = std::atomic<std::int64_t>;

}  // namespace

// Sums up what particles do, in fixed point.
class LightGuide::Learner {
    static constexpr int kSums = 18;

public:
    Learner(LightGuide& guide, const DirectLight& scene, double power)
        : guide_(guide),
          scene_(scene),
          cells_(scene.field().bricks().brick_count() * kCubes * kSums),
          shares_(guide.shares_.size() * 2),
          per_power_(4096.0 / power),
          per_track_(per_power_ / std::cbrt(std::abs(glm::determinant(guide.local_from_index_)))) {}

    void learn(const ParticleFlight& flight) {
        const double power = luminance(flight.power);
        const Ray& ray = flight.ray();
        const double end = flight.collision ? flight.collision->distance : flight.segment.end;
        const double track = power * per_track_;
        const bool fire = flight.before == 0 && from_fire_(flight);
        const Sender sender = flight.before > 0 ? (flight.from_medium ? Sender::M : Sender::S) : fire ? Sender::V : Sender::A;
        const Rgb colour = flight.power * float(per_track_);
        walk_bricks(guide_.field_->bricks(), guide_.field_->enter(ray, end), [&](const VoxelSegment& brick) {
            return walk_cubes<kCube>(brick, [&](const VoxelSegment& s) {
                Fixed* cell = &cells_[cell_of(s.brick, s.cube) * kSums];
                const double length = track * (s.end - s.begin);
                add(cell[0], length);
                for (int a = 0; a < 3; ++a)
                    add(cell[1 + a], length * ray.direction[a]);
                add(cell[4], 1.0);
                for (int c = 0; c < 3; ++c)
                    add(cell[6 + 3 * int(sender) + c], colour[c] * (s.end - s.begin));
                return true;
            });
        });
        const bool by_smoke = flight.from_medium || fire;
        if (by_smoke && !flight.collision)
            if (const std::ptrdiff_t cell = guide_.cell_at(ray.origin); cell >= 0)
                add(cells_[cell * kSums + 5], power * per_power_);
        if (flight.landing() && (by_smoke || flight.before > 0))
            add(shares_[guide_.share_at(flight.landing()->position) * 2 + by_smoke], power * per_power_);
    }

    double track(std::size_t cell) const { return cells_[cell * kSums] / per_track_; }
    dvec3 flow(std::size_t cell) const {
        const Fixed* sums = &cells_[cell * kSums + 1];
        return dvec3(sums[0].load(), sums[1].load(), sums[2].load()) / per_track_;
    }
    Rgb by_sender(std::size_t cell, int sender) const {
        const Fixed* sums = &cells_[cell * kSums + 6 + 3 * sender];
        return Rgb(dvec3(sums[0].load(), sums[1].load(), sums[2].load()) / per_track_);
    }
    double crossings(std::size_t cell) const { return double(cells_[cell * kSums + 4]); }
    double escaped(std::size_t cell) const { return double(cells_[cell * kSums + 5]); }
    double landed(std::size_t share, bool by_smoke) const { return double(shares_[share * 2 + by_smoke]); }

    std::uint64_t fire_particles = 0;

private:
    bool from_fire_(const ParticleFlight& flight) const { return flight.particle < fire_particles; }
    static void add(Fixed& to, double value) {
        constexpr double kMost = double(std::int64_t{1} << 44);
        to.fetch_add(std::llround(std::clamp(value, -kMost, kMost)), std::memory_order_relaxed);
    }

    LightGuide& guide_;
    const DirectLight& scene_;
    std::vector<Fixed> cells_;
    std::vector<Fixed> shares_;
    double per_power_, per_track_;
};

LightGuide::LightGuide(const DirectLight& scene) : field_(&scene.field()) {
    const Medium& medium = field_->medium();
    if (field_->bricks().empty())
        return;
    local_from_index_ = dmat3(medium.world_from_index);
    index_from_local_ = glm::inverse(local_from_index_);
    origin_ = local_from_index_ *
              dvec3(field_->bricks().min_brick() * BrickLattice::kSize - medium.reference_node);
    const BoundingBall ball = ball_around(scene);
    const double power = emitted_power(scene, ball);
    if (!(power > 0.0) || !std::isfinite(power))
        return;
    shares_low_ = ball.centre - ball.radius;
    shares_size_ = 2.0 * ball.radius / kSharesPerSide;
    shares_.assign(scene.surroundings() ? kSharesPerSide * kSharesPerSide * kSharesPerSide : 1, 0.5f);
    const Particles particles(scene, ball, kParticles);
    Learner learner(*this, scene, power / kParticles);
    while (learner.fire_particles < kParticles && particles.from_fire(learner.fire_particles))
        ++learner.fire_particles;
    parallel_blocks(kParticles, kBlock, [&](std::size_t begin, std::size_t end) {
        FlightReport ignored;
        for (std::size_t i = begin; i < end; ++i) {
            Rng rng(kStream, i);
            const std::optional<EmittedParticle> particle = particles.emit(i, rng);
            if (counts(particle, ignored))
                walk_particle(scene, *particle, i, {}, rng, [&](const ParticleFlight& flight) {
                    learner.learn(flight);
                    return true;
                });
        }
    });
    const std::size_t bricks = field_->bricks().brick_count();
    const double cube_volume = std::abs(glm::determinant(local_from_index_)) * kCube * kCube * kCube;
    const double per_radiance = 1.0 / (4.0 * 3.14159265358979 * cube_volume);
    double all = 0.0;
    for (std::size_t c = 0; c < bricks * kCubes; ++c)
        all += learner.track(c);
    if (!(all > 0.0))
        return;
    const double mean = all / double(bricks * kCubes);
    cells_.resize(bricks * kCubes);
    std::vector<double> glow(bricks * kCubes);
    double sum = 0.0, seen = 0.0, weight = 0.0;
    for (std::size_t b = 0; b < bricks; ++b) {
        double track = 0.0, crossings = 0.0, escaped = 0.0;
        dvec3 flow(0.0);
        for (int k = 0; k < kCubes; ++k) {
            const std::size_t c = b * kCubes + k;
            track += learner.track(c), crossings += learner.crossings(c), escaped += learner.escaped(c);
            flow += learner.flow(c);
        }
        const double n = crossings / kCubes;
        const double brick_track = (track / kCubes * n + mean * kPrior) / (n + kPrior);
        const dvec3 brick_flow = flow / double(kCubes) * (n / (n + kPrior));
        for (int k = 0; k < kCubes; ++k) {
            const std::size_t c = b * kCubes + k;
            const double m = learner.crossings(c);
            const double t = (learner.track(c) * m + brick_track * kPrior) / (m + kPrior);
            const dvec3 f = (learner.flow(c) * m + brick_flow * kPrior) / (m + kPrior);
            cells_[c].radiance = float((t + kFloor * mean) * per_radiance);
            cells_[c].flow = vec3(f / (t + kFloor * mean));
            glow[c] = 0.75 * learner.escaped(c) + 0.25 * escaped / kCubes;
            sum += glow[c];
            seen += learner.escaped(c) * cells_[c].radiance, weight += learner.escaped(c);
        }
    }
    by_sender_.resize(cells_.size());
    scattered_.cells.resize(cells_.size());
    for (std::size_t b = 0; b < bricks; ++b) {
        std::array<Rgb, 4> brick{};
        for (int k = 0; k < kCubes; ++k) {
            const std::size_t c = b * kCubes + k;
            const Rgb albedo = field_->albedo(b, 4.0f * vec3(k >> 2, k >> 1 & 1, k & 1) + 2.0f);
            for (int s = 0; s < 4; ++s)
                brick[s] += (by_sender_[c][s] = albedo * learner.by_sender(c, s) * float(per_radiance * learner.crossings(c) / (learner.crossings(c) + 2.0))) / float(kCubes);
        }
        for (int k = 0; k < kCubes; ++k) {
            const std::size_t c = b * kCubes + k;
            if (field_->homogeneous(b))
                by_sender_[c] = brick;
            for (int s = 0; s < 4; ++s)
                scattered_.cells[c] += by_sender_[c][s];
        }
    }
    seen_radiance_ = float(weight > 0.0 ? seen / weight : mean * per_radiance);
    double passed = 0.0;
    if (sum > 0.0)
        for (const double g : glow) {
            density_.push_back(g / sum / cube_volume);
            cumulative_.push_back((passed += g) / sum);
        }
    for (std::size_t s = 0; s < shares_.size() && shares_.size() > 1; ++s) {
        const double by_smoke = learner.landed(s, true), other = learner.landed(s, false), unit = 4096.0 * 4.0;
        shares_[s] = std::clamp(float((by_smoke + unit) / (by_smoke + other + 2.0 * unit)), kLeastShare, kMostShare);
    }
}

std::ptrdiff_t LightGuide::cell_at(const dvec3& position) const {
    const dvec3 nodes = index_from_local_ * (position - origin_);
    const dvec3 brick = glm::floor(nodes / double(BrickLattice::kSize));
    const dvec3 bound(field_->bricks().brick_extent());
    for (int a = 0; a < 3; ++a)
        if (!(brick[a] >= 0.0 && brick[a] < bound[a]))
            return -1;
    const int b = field_->bricks().find(field_->bricks().min_brick() + ivec3(brick));
    if (b < 0)
        return -1;
    const ivec3 cube = glm::clamp(ivec3((nodes - brick * double(BrickLattice::kSize)) / double(kCube)), ivec3(0),
                                  ivec3(1));
    return std::ptrdiff_t(cell_of(b, cube));
}

const LightGuide::Cell* LightGuide::at(const dvec3& position) const {
    const std::ptrdiff_t cell = cells_.empty() ? -1 : cell_at(position);
    return cell < 0 ? nullptr : &cells_[cell];
}

std::size_t LightGuide::share_at(const dvec3& position) const {
    if (shares_.size() == 1)
        return 0;
    const ivec3 c = glm::clamp(ivec3((position - shares_low_) / shares_size_), ivec3(0), ivec3(kSharesPerSide - 1));
    return (std::size_t(c.x) * kSharesPerSide + c.y) * kSharesPerSide + c.z;
}

float LightGuide::glow_share(const dvec3& position) const {
    return has_glow() ? shares_[share_at(position)] : 0.0f;
}

dvec3 LightGuide::sample_glow(const dvec3& from, Rng& rng) const {
    for (;;) {
        const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), rng.next_double());
        const std::size_t i = std::min<std::size_t>(found - cumulative_.begin(), cumulative_.size() - 1);
        const int cube = static_cast<int>(i % kCubes);
        const double x = rng.next_double(), y = rng.next_double(), z = rng.next_double();
        const dvec3 in_brick = double(kCube) * (dvec3(cube >> 2, cube >> 1 & 1, cube & 1) + dvec3(x, y, z));
        const dvec3 first(field_->bricks().first_node(i / kCubes) -
                          field_->bricks().min_brick() * BrickLattice::kSize);
        const dvec3 offset = origin_ + local_from_index_ * (first + in_brick) - from;
        const double distance = glm::length(offset);
        if (distance > 0.0)
            return offset / distance;
    }
}

double LightGuide::pdf_glow(const Ray& ray) const {
    double sum = 0.0;
    walk_bricks(field_->bricks(), field_->enter(ray), [&](const VoxelSegment& brick) {
        return walk_cubes<kCube>(brick, [&](const VoxelSegment& s) {
            const double b = s.begin, e = s.end;
            sum += density_[cell_of(s.brick, s.cube)] * (e - b) * (e * e + e * b + b * b) / 3.0;
            return true;
        });
    });
    return sum;
}

std::uint64_t LightGuide::bytes() const {
    return cells_.size() * sizeof(Cell) + (density_.size() + cumulative_.size()) * sizeof(double) +
           shares_.size() * sizeof(float);
}

}  // namespace brisance
