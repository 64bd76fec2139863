// Photon splitting: particles from the fire and the emitters, whose power is divided among the virtual lights that
// cover the point where they meet a surface.
#pragma once

#include <span>
#include <vector>

#include "core/fixed_sums.h"
#include "transport/particles.h"
#include "virtual_lights/flux/flux_spots.h"
#include "virtual_lights/flux/partition_of_unity.h"
#include "virtual_lights/placement/deposit.h"
#include "virtual_lights/settings.h"

namespace brisance {

// Powers are luminance [W].
struct PhotonReport {
    std::uint64_t photons = 0, from_fire = 0;
    std::uint64_t arrivals = 0;    // at surface that lights cover
    std::uint64_t not_finite = 0;  // left out
    double emitted = 0.0;          // by the particles that were drawn
    // Incident on surfaces that hold light, at every arrival: given to lights, and where none covers the surface. The
    // latter is not lost with path extension, as paths continue there.
    double shared = 0.0, unshared = 0.0;
    double escaped = 0.0;
    double unshared_fraction() const { return unshared > 0.0 ? unshared / (shared + unshared) : 0.0; }
};

// The power that each light received [W], and by how many photons. Sums are integers, the same in any order.
class LightAccounts {
public:
    // A map of directions (octahedral_map.h) for every light with a profile. `power`: of everything emitted, [W].
    LightAccounts(std::span<const VirtualLight> lights, int profile_resolution, double power);

    // From any thread: a photon's share `weight` and its power times that. `toward_source`: unit.
    void add(std::size_t light, const dvec3& toward_source, double weight, const Rgb& power);

    // The whole of a light that has no map, and one texel of a map.
    Rgb whole(std::size_t light) const { return read(first_[light]); }
    Rgb texel(std::size_t light, std::size_t texel) const { return read(first_[light] + texel); }
    // Photons that arrived at a light; one that lights share counts for each by its weight.
    double photons(std::size_t light) const { return double(photons_[light]) / kPhoton; }
    // The weight of one of them: the mean, each counted by its weight. 0 without any.
    double mean_weight(std::size_t light) const {
        return photons_[light] > 0 ? double(squares_[light]) / double(photons_[light]) : 0.0;
    }
    std::uint64_t bytes() const {
        return sums_.bytes() + first_.size() * sizeof(std::size_t) + 2 * photons_.size() * sizeof(std::uint64_t);
    }

private:
    Rgb read(std::size_t record) const;

    std::span<const VirtualLight> lights_;
    int resolution_;
    std::vector<std::size_t> first_;  // record of a light
    FixedSums sums_;                  // of all records [W]
    static constexpr double kPhoton = 0x1p20;
    std::vector<std::uint64_t> photons_, squares_;  // of weights, in steps of 1 / kPhoton
};

// What a particle leaves at the end of its flight, which is a surface. `power`: of the particle [W].
Deposit deposit_of(const DirectLight& scene, const RaySegment& flight, const Rgb& power);

// Deposits, with their power, where the particles of `paths` light paths meet surfaces that hold light. The paths share
// all emitted power among them.
struct PhotonArrivals {
    std::vector<Deposit> arrivals;
    PhotonReport report;
};
PhotonArrivals photon_arrivals(const DirectLight& scene, std::size_t paths, Stream stream, std::uint32_t seed);

// What settings.photons says; automatic: as many as make the noise that photons leave in the light of a ray's
// footprint half of settings.picture_error. A footprint holds at least kLightsOfFootprint lights: with N photons for
// each light of `count`, on average, that noise is 1 / sqrt(N kLightsOfFootprint). A pilot tells how many photons
// arrive. No more than four need arrive for each sample, whose noise hides that of photons, but for kLeastPhotons
// for each light: enough where smoke alone is lit by them, each part of it by many. No more are traced than
// most_automatic_photons().
inline constexpr double kLightsOfFootprint = 40.0, kLeastPhotons = 8.0;
std::size_t photons_needed(const DirectLight& scene, const BoundingBall& ball, const PartitionOfUnity& partition,
                           const VirtualLightSettings& settings, std::size_t count, double samples);

// Traces `total` particles and adds what arrives to the accounts of the lights that cover each hit. `spots`: null, or
// gets where it arrives.
PhotonReport trace_photons(const DirectLight& scene, const BoundingBall& ball, const PartitionOfUnity& partition,
                           std::size_t total, std::uint32_t seed, LightAccounts& accounts, SpotAccounts* spots);

}  // namespace brisance
