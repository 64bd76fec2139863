// What light on ever coarser lattices is expected to add to the error of the picture (lighting_level.h).
#pragma once

#include <deque>
#include <map>
#include <optional>

#include "medium/coarse_medium.h"
#include "medium/lattice/occluders.h"
#include "medium_lighting/input.h"
#include "medium_lighting/levels/lamps_in_smoke.h"

namespace brisance {

// Relative error of light gathered on voxels of this optical depth, as a collision meets it.
float error_of_voxels(float depth);

// What the errors need of the medium is looked for when it is asked for, and once.
class LatticeErrors {
public:
    // Keeps references. `surfaces`: null: none reaches into the medium.
    explicit LatticeErrors(const Medium& medium, const Occluders* surfaces = nullptr,
                           const Surroundings* surroundings = nullptr);

    // For how much errors beside walls and lamps count.
    void count_narrow_errors(float times) { narrow_errors_count_ = times; }

    // Relative, of the picture, on voxels 2^level wide; and with the light of their detail.
    float of_first_without_detail(int level);
    float of_first(int level);
    float of_smoke(int level);

    int widest_of_first() const;
    float widest_of_smoke() const;

private:
    float narrow(int level);
    float of_detail(int level);
    float of_lamps(int level) const;
    float of_walls(int level);
    float of_small_fire(int level);
    float depth_of_smoke() const;
    // Luminance of the emission per node, and its means on coarser lattices. What it returns stays where it is.
    const Averages& fire(int level);
    double fire_power();
    float unresolved_emission(int level);
    float lacking_at(int level);

    const Medium& medium_;
    const Occluders* surfaces_;
    LampsInSmoke lamps_;
    float narrow_errors_count_ = 1.0f;
    float depth_;  // of a voxel
    std::optional<float> albedo_;
    std::optional<float> fire_radius_;  // in voxels
    std::deque<Averages> fire_;         // by level, as far as it was asked for
    std::map<int, float> unresolved_;
    std::map<int, float> beyond_;  // surfaces
};

}  // namespace brisance
