// Deposits of particle tracks around the nodes of the medium (track-length estimator). The light that scatters toward
// the eye is summed directly with the exact phase function, however sharp. For all other directions every node keeps a
// few tracks, sampled by their weight so that they represent all of them without bias (Duffield, Lund, Thorup, Priority
// Sampling for Estimation of Arbitrary Subset Sums, J. ACM 54(6), 2007).
//
// Unbiased up to the size of voxels. Sums and samples do not depend on the order of the deposits.
#pragma once

#include <atomic>
#include <memory>
#include <vector>

#include "core/fixed_sums.h"
#include "core/rng.h"
#include "medium/lattice/track_lengths.h"

namespace brisance {

class TrackLengthCache {
public:
    static constexpr int kTracks = 16;  // kept by a node for other directions

    // Keeps a reference. `eye`: local [m]; `power`: of all particles [W]; `other_directions`: toward() will be called.
    TrackLengthCache(const Medium& medium, const dvec3& eye, double power, bool other_directions);

    // Deposits a track up to `end` [m] of a particle of that power [W]. Thread-safe; `rng` is the particle's own.
    void add(const Ray& ray, double end, const Rgb& power, Rng& rng);
    // To be called after all deposits and before any query. `filter_radius`: standard deviation of a Gaussian by which
    // the light toward the eye is filtered in three dimensions [voxels]; 0: it is not. The filter normalises by the
    // volume around the nodes, so that it keeps what is constant, and does not see walls.
    void finish(float filter_radius = 0.0f);

    // In-scattered radiance [W/(m^2 sr)] at a position in units of nodes. toward_eye() interpolates between the
    // surrounding nodes; toward() takes one of them, chosen by `xi`, for a direction (unit).
    Rgb toward_eye(const dvec3& position) const;
    Rgb toward(const vec3& direction, const dvec3& position, float xi) const;

    std::uint64_t bytes() const;

private:
    struct Track {
        float priority;
        vec3 direction;
        Rgb power_length;  // [W m]
        // Ties are broken independently of the order of the deposits.
        bool precedes(const Track& other) const;
    };
    void keep(std::size_t list, const Track& track);
    float volume_around(std::int64_t node) const { return volume_[node] * medium_.voxel_volume; }

    const Medium& medium_;
    TrackLengths track_lengths_;
    float mean_cosine_;
    std::vector<vec3> toward_eye_;        // per node, unit
    FixedSums sums_;                      // [W m / sr]
    std::vector<Rgb> radiance_;           // toward the eye, times the volume around the node in voxels
    std::vector<float> filtered_volume_;  // as `volume_`, where the light is filtered
    std::vector<float> volume_;           // around each node, within the medium's bricks, in voxels
    // Each node with extinction has a list of up to kTracks + 1 tracks by decreasing priority; no lists unless
    // `other_directions`.
    std::vector<std::int32_t> list_of_;  // of each node, or -1
    std::vector<Track> kept_;
    std::vector<std::uint8_t> count_;  // of each list
    // Of each list, what a track's priority must reach to be kept: most tracks end here, without a look at the list.
    std::unique_ptr<std::atomic<float>[]> least_priority_;
    std::unique_ptr<std::atomic_flag[]> busy_;
};

}  // namespace brisance
