// Light on its way through the medium, as particles laid it down around the medium's nodes: what of it scatters toward
// the eye is summed up at once, by the phase function as it is, however sharp; for all other directions every node
// keeps a few ways, drawn by their weight so that all that they stand for adds up (Duffield, Lund, Thorup, Priority
// Sampling for Estimation of Arbitrary Subset Sums, J. ACM 54(6), 2007).
//
// Unbiased up to the size of voxels. Sums and draws are the same in whatever order ways are laid down.
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
    static constexpr int kWays = 16;  // that a node keeps for other directions

    // Keeps a reference. `eye`: local [m]; `power`: of all particles [W].
    TrackLengthCache(const Medium& medium, const dvec3& eye, double power, bool other_directions);

    // A way up to `end` [m] of a particle of that power [W]. From any thread; `rng` is the particle's own.
    void add(const Ray& ray, double end, const Rgb& power, Rng& rng);
    // Once all ways are laid down, and before anyone asks.
    void finish();

    // In-scattered radiance [W/(m^2 sr)] at a place, counted in nodes: between the nodes around, toward the eye; or at
    // one of them, drawn by `xi`, in a direction (unit).
    Rgb toward_eye(const dvec3& place) const;
    Rgb toward(const vec3& direction, const dvec3& place, float xi) const;

    std::uint64_t bytes() const;

private:
    struct Way {
        float priority;
        vec3 direction;
        Rgb track;  // [W m]
        // Of two that are worth as much, whatever was laid down first.
        bool goes_before(const Way& other) const;
    };
    void keep(std::size_t list, const Way& way);
    float volume_around(std::int64_t node) const { return volume_[node] * medium_.voxel_volume; }

    const Medium& medium_;
    TrackLengths ways_;
    float mean_cosine_;
    std::vector<vec3> toward_eye_;  // per node, unit
    FixedSums sums_;                // [W m / sr]
    std::vector<Rgb> radiance_;     // toward the eye, times the volume around the node over a voxel's
    std::vector<float> volume_;     // around each node and in the medium's cells, over a voxel's
    // Per node with extinction a list of up to kWays + 1, by falling priority; none: nobody asks for other directions.
    std::vector<std::int32_t> list_of_;  // of each node, or -1
    std::vector<Way> kept_;
    std::vector<std::uint8_t> count_;  // of each list
    std::unique_ptr<std::atomic_flag[]> busy_;
};

}  // namespace brisance
