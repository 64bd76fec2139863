// Level 0 of the hierarchy on the lattice itself: every node is lit by the nodes within 2 alpha h_0, with exact
// shadows.
//
// Receivers and lights are nodes of one lattice, so their separation takes a few hundred values and everything but the
// extinction is known in advance. For each separation o:
//  - The optical depth between node x and node x + o is a fixed linear combination of the extinction at nearby nodes
//    (separation_depth.h).
//  - The kernel is the singular 1/d^2 itself. It leaves out the node's own light, which the self term adds:
//      kappa(s) = (1/V) integral exp(-s r) / r^2 dV - sum over o != 0 of exp(-s |o|) / |o|^2,
//    This correction makes the punctured lattice sum exact for smooth light in a homogeneous medium, and makes such a
//    medium absorb exactly what it emits, from sigma h = 0 to infinity. Nothing is clamped. Light that changes across
//    the node arrives with a flux of its own, -kappa_1 grad I, for which the sum leaves out
//      kappa_1(s) = (1/3V) integral exp(-s r) / r dV - (1/3) sum over o != 0 of exp(-s |o|) / |o|;
//    This flux matters for phase functions that are not isotropic.
//  - Surfaces may come between nodes (lines_of_sight.h). Light then changes across a node by what the nodes beside it
//    have that it sees.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "medium/lattice/brick_lattice.h"
#include "medium/lattice/occluders.h"
#include "receivers/receivers.h"

namespace brisance {

class NearField {
public:
    // `local_from_index` spans the lattice [m per node]; lights fade out over [radius, 2 radius] [m].
    NearField(const mat3& local_from_index, float radius, bool shadows);

    struct Input {
        const BrickLattice* lattice;
        const std::vector<float>* extinction;   // per node [1/m]
        const std::vector<Rgb>* intensity;      // per node [W/sr]
        const std::vector<float>* directional;  // 24 coefficients per node (far_kernels.h), or null
        std::optional<vec3> eye;                // local [m]; none: no `scattered`
        ivec3 reference_node{0};                // at the origin of local space
        float mean_cosine = 0.0f;
        const std::vector<std::uint8_t>* needed = nullptr;  // per node; bricks without a needed node are skipped
        const Occluders* occluders = nullptr;               // surfaces between nodes (lines_of_sight.h); null: none
    };

    // Adds to `out`, whose arrays are planar over the lattice's nodes.
    void gather(const Input& input, Gathered& out) const;

    // kappa [1/m^2] and kappa_1 [1/m] at extinction s [1/m].
    struct SelfKernels {
        float light, flux;
    };
    SelfKernels self_kernels(float s) const;
    // Rows turn differences per node into derivatives per metre.
    const mat3& index_from_local() const { return index_from_local_; }
    std::size_t separations() const { return stencil_.size(); }

    struct Tap {
        ivec3 node;
        float length;  // coefficient of the extinction there [m]
    };
    struct Separation {
        ivec3 node;
        float kernel;    // blend / distance^2 [1/m^2]
        vec3 direction;  // from the light to the receiver, unit
        std::vector<Tap> taps;
    };
    const std::vector<Separation>& stencil() const { return stencil_; }
    int margin() const { return margin_; }
    bool shadows() const { return shadows_; }

private:
    struct Sight;
    Sight sight_past(const Input& input) const;
    void tabulate_self_kernel();

    mat3 local_from_index_, index_from_local_;
    float spacing_;
    bool shadows_;
    int margin_ = 1;
    std::vector<Separation> stencil_;
    // kappa h^2 (1 + s h) and kappa_1 h (1 + s h)^2 over u = s h / (1 + s h)
    std::vector<SelfKernels> self_;
};

}  // namespace brisance
