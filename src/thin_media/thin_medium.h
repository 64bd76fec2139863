// Haze: thin smoke around dense smoke.
//
// A burst may keep all but a hundredth of its light. What haze around it scatters is that hundredth, which the lights
// and shadow maps made for the smoke itself know badly (exterior_hierarchy.h): without this, haze was five times too
// dark. So nodes of haze ask the lights that serve receivers outside. Between haze and smoke proper the two are mixed,
// and haze fades in with its share of the medium, so that neither space nor time has a seam.
//
// These lights are many, and so may be haze's nodes; but where all is haze for some voxels around, light changes
// slowly: such bricks ask at 27 points and interpolate. Neighbours share the points of their common face. What they
// scatter themselves has lights of its own (thin_medium_lights.h), and shadow rays cross them in long steps
// (homogeneous_bricks.h).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "gathering/gather.h"
#include "gathering/point_depths.h"
#include "medium/lattice/homogeneous_bricks.h"

namespace brisance {

class ThinMedium {
public:
    ThinMedium() = default;  // there is none
    // Among the nodes `needed`. `eye`: the camera's place where scattered light has a direction, local [m].
    ThinMedium(const Medium& medium, const PointDepths& depths, const std::vector<std::uint8_t>& needed,
               const std::optional<vec3>& eye);

    bool empty() const { return weight_.empty(); }
    std::size_t node_count() const;   // that are haze, wholly or in part
    std::size_t point_count() const;  // that ask
    // Of thin nodes the mean transmittance to the outside (gathering/escape_probability.h), below 0 for others.
    const std::vector<float>& open() const { return open_; }

    // In which, and around which, nothing is smoke proper.
    const std::vector<std::uint32_t>& even_bricks() const { return even_; }
    const HomogeneousBricks& homogeneous_bricks() const {
        return homogeneous_bricks_;
    }  // the same, but not for the camera's sake

    // What arrives at nodes of haze from lights that serve receivers outside; as gather_at_nodes(), unsharpened.
    // `bottom`: bottom_level() of the field; `of_haze`: the lights of even bricks where they stand apart, or null.
    Gathered gather(const LightField& field, const GridLevel& bottom, const LightField* of_haze,
                    const LatticeRequest& request, std::vector<LevelCost>& costs, Progress& progress) const;
    // Puts it in the place of `all` by weight; both planar over the nodes.
    void mix(const Gathered& of_haze, Gathered& all) const;
    const std::vector<std::uint8_t>& nodes() const { return nodes_; }

private:
    void find_even_bricks(const Medium& medium, const std::vector<float>& thin);
    void look_outside(const Medium& medium, const PointDepths& depths, const std::vector<float>& thin);

    std::optional<vec3> eye_;
    std::vector<float> weight_;  // per node: 1 in haze, 0 in the smoke proper
    std::vector<float> open_;
    std::vector<std::uint8_t> nodes_;   // with a weight above zero
    std::vector<std::uint8_t> single_;  // those among them that ask themselves
    std::vector<std::uint32_t> even_;   // bricks that ask at a few points
    HomogeneousBricks homogeneous_bricks_;
};

}  // namespace brisance
