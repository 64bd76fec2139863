#include "virtual_lights/flux/photon_splitting.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "transport/particle_walk.h"
#include "virtual_lights/octahedral_map.h"

namespace brisance {

namespace {

constexpr std::size_t kBlock = 1024;
// Particles that tell how many photons lights need, and the fewest that are traced for them.
constexpr std::size_t kPilot = 16384;
// With one, Veach's door ajar has half more variance than with four.
constexpr double kArrivalsPerSample = 4.0;
// The greatest ratio of shading to geometric cosine that a photon's power is multiplied by (Veach 1997, section 5.3):
// without a bound one photon at a grazing angle may outshine all others. It is biased, and loses light wherever the
// ratio is greater: 53 % where the shading normal leans by 45 degrees toward a sun 5 degrees above the surface.
constexpr double kMostCosineRatio = 4.0;

bool finite(const Rgb& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

// Particles by number.
class PhotonPaths {
public:
    PhotonPaths(const DirectLight& scene, const BoundingBall& ball, std::size_t total, Stream stream,
                std::uint32_t seed)
        : scene_(scene), particles_(scene, ball, total), stream_(stream), seed_(seed) {}

    // Calls meet(segment, power) wherever the particle meets a surface.
    template <class Meet>
    void trace(std::uint64_t index, PhotonReport& report, const Meet& meet) const {
        Rng rng(stream_, index, seed_);
        report.from_fire += particles_.from_fire(index);
        ++report.photons;
        const std::optional<EmittedParticle> particle = particles_.emit(index, rng);
        if (!particle)
            return;
        const Rgb power = particle->power;
        if (!finite(power) || !(largest(power) > 0.0f)) {
            report.not_finite += !finite(power);
            return;
        }
        report.emitted += luminance(power);
        walk_particle(scene_, *particle, index, {}, rng, [&](const ParticleFlight& flight) {
            if (flight.landing())
                meet(flight.segment, flight.power);
            else if (flight.escapes())
                report.escaped += luminance(flight.power);
            return true;
        });
    }

private:
    const DirectLight& scene_;
    Particles particles_;
    Stream stream_;
    std::uint32_t seed_;
};

int material_of(const DirectLight& scene, const RaySegment& segment) {
    return scene.surroundings()->scene().meshes[segment.hit->mesh].material;
}

// Photons arrive in proportion to the geometric cosine; surfaces scatter in proportion to the shading cosine.
float brightness_by_shading(const SurfacePoint& point, const dvec3& toward_source) {
    const double shading = std::abs(glm::dot(point.frame.normal, toward_source));
    const double geometric = std::abs(glm::dot(point.geometric_normal, toward_source));
    return static_cast<float>(std::min(shading / std::max(geometric, 1e-9), kMostCosineRatio));
}

void share_out(const DirectLight& scene, const RaySegment& segment, const Rgb& power, const PartitionOfUnity& partition,
               LightAccounts& accounts, SpotAccounts* spots, PhotonReport& report) {
    const SurfacePoint& point = *segment.point;
    if (!holds_light(point.material))
        return;
    const LightShares shares = partition.shares(point.position, lit_normal(point), material_of(scene, segment));
    report.arrivals += shares.count > 0;
    (shares.count > 0 ? report.shared : report.unshared) += luminance(power);
    const dvec3 toward_source = -segment.ray.direction;
    const float brighter = brightness_by_shading(point, toward_source);
    for (int i = 0; i < shares.count; ++i) {
        const Rgb received = power * (shares.weight[i] * brighter);
        accounts.add(shares.light[i], toward_source, shares.weight[i], received);
        if (spots)
            spots->add(shares.light[i], point.position, received);
    }
}

void add(PhotonReport& to, const PhotonReport& r) {
    to.photons += r.photons;
    to.from_fire += r.from_fire;
    to.arrivals += r.arrivals;
    to.not_finite += r.not_finite;
    to.emitted += r.emitted;
    to.shared += r.shared;
    to.unshared += r.unshared;
    to.escaped += r.escaped;
}

}  // namespace

LightAccounts::LightAccounts(std::span<const VirtualLight> lights, int profile_resolution, double power)
    : lights_(lights),
      resolution_(profile_resolution),
      sums_(0, power),
      photons_(lights.size()),
      squares_(lights.size()) {
    std::size_t records = 0;
    for (const VirtualLight& light : lights) {
        first_.push_back(records);
        records += light.profile < 0 ? 1 : static_cast<std::size_t>(resolution_) * resolution_;
    }
    sums_ = FixedSums(records, power);
}

void LightAccounts::add(std::size_t light, const dvec3& toward_source, double weight, const Rgb& power) {
    const auto count = [](std::uint64_t& sum, double value) {
        std::atomic_ref<std::uint64_t>(sum).fetch_add(std::uint64_t(std::llround(value * kPhoton)),
                                                      std::memory_order_relaxed);
    };
    count(photons_[light], weight);
    count(squares_[light], weight * weight);
    std::size_t record = first_[light];
    if (lights_[light].profile >= 0)
        record += texel_of(lights_[light].frame.local_from_world(toward_source), resolution_);
    sums_.add(record, dvec3(power));
}

Rgb LightAccounts::read(std::size_t record) const {
    return Rgb(sums_.read(record));
}

Deposit deposit_of(const DirectLight& scene, const RaySegment& flight, const Rgb& power) {
    const dvec3 toward_source = -flight.ray.direction;
    return {*flight.hit, vec3(flight.point->position), vec3(toward_source), material_of(scene, flight),
            power * brightness_by_shading(*flight.point, toward_source)};
}

PhotonArrivals photon_arrivals(const DirectLight& scene, std::size_t paths, Stream stream, std::uint32_t seed) {
    const PhotonPaths all(scene, ball_around(scene), paths, stream, seed);
    std::vector<PhotonArrivals> parts((paths + kBlock - 1) / kBlock);
    parallel_blocks(paths, kBlock, [&](std::size_t begin, std::size_t end) {
        auto& [arrivals, report] = parts[begin / kBlock];
        for (std::size_t i = begin; i < end; ++i)
            all.trace(i, report,
                      [&, &arrivals = arrivals, &report = report](const RaySegment& segment, const Rgb& power) {
                          if (!holds_light(segment.point->material))
                              return;
                          report.shared += luminance(power);
                          arrivals.push_back(deposit_of(scene, segment, power));
                      });
    });
    PhotonArrivals out;
    for (const PhotonArrivals& part : parts) {
        out.arrivals.insert(out.arrivals.end(), part.arrivals.begin(), part.arrivals.end());
        add(out.report, part.report);
    }
    return out;
}

std::size_t photons_needed(const DirectLight& scene, const BoundingBall& ball, const PartitionOfUnity& partition,
                           const VirtualLightSettings& settings, std::size_t count, double samples) {
    if (settings.photons != kAutomaticPhotons)
        return static_cast<std::size_t>(settings.photons);
    // Of another seed than the photons that lights keep.
    const PhotonPaths paths(scene, ball, kPilot, Stream::Photon, ~settings.seed);
    std::vector<std::uint64_t> parts(kPilot / kBlock);
    parallel_blocks(kPilot, kBlock, [&](std::size_t begin, std::size_t end) {
        PhotonReport report;
        for (std::size_t i = begin; i < end; ++i)
            paths.trace(i, report, [&](const RaySegment& segment, const Rgb&) {
                const SurfacePoint& point = *segment.point;
                if (holds_light(point.material) &&
                    partition.shares(point.position, lit_normal(point), material_of(scene, segment)).count > 0)
                    ++parts[begin / kBlock];
            });
    });
    const std::uint64_t arrivals = std::accumulate(parts.begin(), parts.end(), std::uint64_t(0));
    const double each = 4.0 / (kLightsOfFootprint * settings.picture_error * settings.picture_error);
    const double lights = double(count);
    const double wanted =
        std::min(each * lights, std::max(kArrivalsPerSample * samples, kLeastPhotons * lights));  // to arrive
    const double needed = wanted * double(kPilot) / double(std::max<std::uint64_t>(arrivals, 1));
    return static_cast<std::size_t>(std::clamp(needed, double(kPilot), double(most_automatic_photons(samples))));
}

PhotonReport trace_photons(const DirectLight& scene, const BoundingBall& ball, const PartitionOfUnity& partition,
                           std::size_t total, std::uint32_t seed, LightAccounts& accounts, SpotAccounts* spots) {
    const PhotonPaths paths(scene, ball, total, Stream::Photon, seed);
    std::vector<PhotonReport> parts((total + kBlock - 1) / kBlock);
    parallel_blocks(total, kBlock, [&](std::size_t begin, std::size_t end) {
        PhotonReport& report = parts[begin / kBlock];
        for (std::size_t i = begin; i < end; ++i)
            paths.trace(i, report, [&](const RaySegment& segment, const Rgb& power) {
                share_out(scene, segment, power, partition, accounts, spots, report);
            });
    });
    PhotonReport report;
    for (const PhotonReport& part : parts)
        add(report, part);
    return report;
}

}  // namespace brisance
