// The lattice on which a medium is lit, and the data shared by all stages of the lighting: the nodes that receive
// light, the quantities needed there, optical depths, thin media, and occluding surfaces.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "gathering/gather.h"
#include "lighting_grid/footprint.h"
#include "medium_lighting/input.h"
#include "medium_lighting/levels/coarse_lighting.h"
#include "medium_lighting/levels/lighting_level.h"
#include "medium_lighting/levels/lit_levels.h"
#include "optical_depths/point_depths.h"
#include "thin_media/thin_medium.h"

namespace brisance {

// Per node: whether the camera or the smoke can look up light there, at the corners of voxels with extinction.
std::vector<std::uint8_t> nodes_beside_extinction(const Medium& medium);

// Where light at the nodes has come from.
enum class LightOrigin {
    Fire,     // the medium's emission
    Outside,  // surfaces and emitters
    Smoke     // scattered by the medium
};

class LitLattice {
public:
    // Keeps what the input refers to. `level`: light lives on the lattice 2^level coarser than the medium's, in a
    // medium of mean extinction (levels/coarse_lighting.h).
    LitLattice(const MediumLightingInput& input, int level);
    LitLattice(const LitLattice&) = delete;
    LitLattice& operator=(const LitLattice&) = delete;

    const MediumLightingInput& input() const { return input_; }  // its settings count levels from this lattice
    int level() const { return level_; }
    const Medium& medium() const { return coarse_ ? *coarse_ : input_.medium; }  // on the lattice of the light
    const ExtinctionPyramid& pyramid() const { return pyramid_; }
    const PointDepths& depths_of_parts() const { return depths_of_parts_; }  // of rays from surfaces to voxels
    const ThinMedium& thin_medium() const { return thin_medium_; }
    const Occluders* surfaces() const { return surfaces_.get(); }        // null: none
    const std::vector<std::uint8_t>& needed() const { return needed_; }  // per node: whether light is needed there
    std::size_t node_count() const { return needed_.size(); }
    // Of the light that the picture shows, relative; 0: no node is interpolated. `share`: of that light, what this
    // lattice has.
    float interpolation_error(float share) const { return interpolation_.of(share); }
    // Coarser lattices to gather on first where nodes are interpolated, from level 1 on. Made by the first call; not
    // for several threads.
    const std::vector<LitLevel>& coarser_levels() const;

    // Of a flight after which light scatters on, with the moments that needs, and of the last one before the camera.
    LatticeRequest request() const;
    LatticeRequest last_request() const;
    // No light, with the planes of request().
    Gathered dark() const;

    // Whether lights are kept for receivers outside of dense smoke: nodes of thin media, or those `on_surfaces`.
    bool lights_exterior(bool on_surfaces) const { return on_surfaces || !thin_medium_.empty(); }

    // The fire's lights, per node [W/sr]; their sum is that of the input medium's.
    std::vector<Rgb> fire_lights() const;

    // How likely light of each node with an intensity is to leave the medium (gathering/escape_probability.h).
    // Remembered for other lights at the same nodes; not for several threads.
    NodeWeights escape_likelihood_of(const std::vector<Rgb>& intensity) const;

    // Albedo times the radiance that scatters toward the camera, per node of the input medium [W/(m^2 sr)]. Light that
    // has not scattered has the light of detail (levels/light_of_detail.h) of the lattice twice as fine added.
    std::vector<Rgb> source_function(const Gathered& gathered, LightOrigin origin) const;

private:
    // From this lattice to the nodes of the input medium.
    std::vector<Rgb> at_medium_nodes(const std::vector<Rgb>& radiance, const Gathered& gathered,
                                     LightOrigin origin) const;

    // From nodes of `to`, the medium on a finer lattice, to those of this one or of one between, 2^level coarser; null:
    // there are no surfaces between them.
    const CornersSeen* corners_seen(const Medium& to, int level) const;

    const Medium& finer() const;  // the medium on the lattice twice as fine, where this one is coarser

    MediumLightingInput input_;
    int level_;
    std::unique_ptr<Medium> coarse_;         // null: the input medium itself
    mutable std::unique_ptr<Medium> finer_;  // made by the first call of finer()
    std::unique_ptr<Occluders> surfaces_;
    mutable std::map<std::pair<const Medium*, int>, CornersSeen> corners_seen_;  // made when asked for
    ExtinctionPyramid pyramid_;
    std::vector<std::uint8_t> needed_;
    PointDepths depths_;  // of rays out of the smoke
    PointDepths depths_of_parts_;
    mutable NodeWeights likelihood_;  // of nodes that were asked for
    ThinMedium thin_medium_;
    ToleratedInterpolation interpolation_;
    mutable std::vector<LitLevel> coarser_levels_;
};

}  // namespace brisance
