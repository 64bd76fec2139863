// Thin media: thin smoke around dense smoke.
//
// A burst may keep all but a hundredth of its light. A thin medium around it scatters that hundredth, which the lights
// and shadow maps made for the dense smoke represent badly (exterior_hierarchy.h): with them, thin media were five
// times too dark. Nodes that see opaque smoke from afar (unresolved_lights.h) therefore gather from the lights made for
// exterior receivers. Both solutions are blended between such nodes and dense smoke, and the effect fades in with the
// share of such nodes in what the camera sees (seen_share.h), so that there is no seam in space or time.
//
// These lights are many, and so may be the nodes of thin media. Where everything within some voxels is thin, light
// changes slowly: such bricks gather at 27 points and interpolate. Neighbours share the points of their common face.
// The light that these bricks scatter has lights of its own (thin_medium_lights.h), and shadow rays cross them in long
// steps (homogeneous_bricks.h).
#pragma once

#include <cstdint>
#include <vector>

#include "gathering/gather.h"
#include "medium/lattice/homogeneous_bricks.h"
#include "optical_depths/point_depths.h"
#include "thin_media/smoke_in_brick.h"

namespace brisance {

// What lights the smoke: anything that may leave haze in the dark, such as fire behind dense smoke, or a sky that no
// surfaces hide, with suns or without.
enum class LitBy { Fire, Skies };

class ThinMedium {
public:
    ThinMedium() = default;  // no thin medium
    // The camera: its position, local [m], and whether light is scattered toward it by direction.
    struct Viewer {
        vec3 eye{0.0f};
        bool directional = false;
    };
    // Classifies the nodes `needed`. `error`: that the picture may have, relative. Nodes that could change the picture
    // by less than half of it are not treated; the treatment fades in up to twice that. `surfaces`: that part light;
    // null: none do. Under skies haze has most of its light from there, and needs this less.
    ThinMedium(const Medium& medium, const PointDepths& depths, const std::vector<std::uint8_t>& needed,
               const Viewer& viewer, float error, const Occluders* surfaces = nullptr, LitBy lit_by = LitBy::Fire);

    bool empty() const { return weight_.empty(); }
    std::size_t node_count() const;   // nodes that are thin, wholly or in part
    std::size_t point_count() const;  // points that gather
    // Mean transmittance from thin nodes to the outside (gathering/escape_probability.h); below 0 for other nodes.
    const std::vector<float>& open() const { return open_; }

    // Bricks that are thin and have only such around them, do not glow, are far from the camera, and are not parted by
    // surfaces.
    const std::vector<std::uint32_t>& even_bricks() const { return even_; }
    // The same bricks, whatever the distance from the camera and from surfaces.
    const HomogeneousBricks& homogeneous_bricks() const { return homogeneous_bricks_; }

    // Light that arrives at thin nodes from the lights for exterior receivers; as gather_at_nodes(), unsharpened.
    // `bottom`: bottom_level() of the field; `of_thin`: the lights of even bricks if they are separate, else null.
    Gathered gather(const LightField& field, const GridLevel& bottom, const LightField* of_thin,
                    const LatticeRequest& request, std::vector<LevelCost>& costs, Progress& progress) const;
    // Blends `of_thin` into `all` by weight; both planar over the nodes.
    void mix(const Gathered& of_thin, Gathered& all) const;
    const std::vector<std::uint8_t>& nodes() const { return nodes_; }
    // Per node: the part of other light that mix() leaves; empty where there is no thin medium.
    std::vector<float> rest() const;

private:
    void find_even_bricks(const Medium& medium, const std::vector<float>& thin, const Occluders* surfaces);
    void look_outside(const Medium& medium, const PointDepths& depths, const std::vector<float>& thin);

    Viewer viewer_;
    std::vector<float> weight_;  // per node: 1 in thin, 0 in dense smoke
    std::vector<float> open_;
    std::vector<std::uint8_t> nodes_;    // with a weight above zero
    std::vector<std::uint8_t> single_;   // those among them that gather themselves
    std::vector<std::uint32_t> even_;    // bricks that gather at a few points
    std::vector<BrickPart> even_smoke_;  // of each of them: where these points lie
    HomogeneousBricks homogeneous_bricks_;
};

}  // namespace brisance
