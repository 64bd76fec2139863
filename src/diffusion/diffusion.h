// The diffusion approximation of light that scatters again and again.
//
// J. Stam, Multiple Scattering as a Diffusion Process, EGWR 1995; A. Ishimaru, Wave Propagation and Scattering in
// Random Media, 1978. The radiance is taken as linear in the direction. Its fluence phi and its flux F then obey
//   div F + sigma_a phi = Q0,   F = D (3 Q1 - grad phi),   D = 1 / (3 sigma_t'),   sigma_t' = sigma_a + (1 - g)
//   sigma_s,
// where Q0 and Q1 are the integral of the emitted light over directions and its first moment. At the edge of the
// lattice and at surfaces light leaves and none comes back (Marshak): F n = phi / 2.
//
// Clear air has no D. The flux limiter of C. D. Levermore and G. C. Pomraning (A Flux-limited Diffusion Theory,
// Astrophysical Journal 248, 1981), here in its rational form, keeps |F| <= phi; for pictures: D. Koerner, J.
// Portsmouth, F. Sadlo, T. Ertl, B. Eberhardt, Flux-limited Diffusion for Multiple Scattering in Participating Media,
// CGF 33, 2014:
//   D = lambda(R) / sigma_t',   lambda(R) = (2 + R) / (6 + 3 R + R^2),   R = |grad phi| / (sigma_t' phi).
// It depends on the solution, which is found by solving again with the D of the last solution; the first has none.
//
// Control volumes are the lattice's nodes. A node absorbs what the interpolated medium does under its hat, so that
// absorbed + escaped = emitted for the fields that the other solvers use. Between two nodes the extinction is their
// mean. Axes count as orthogonal: on a sheared lattice the operator is that of a straightened one.
#pragma once

#include <span>
#include <vector>

#include "diffusion/multigrid.h"
#include "diffusion/settings.h"
#include "medium/lattice/extinction_pyramid.h"
#include "receivers/receivers.h"

namespace brisance {

// Power over 4 pi [W/sr].
struct DiffusionBalance {
    dvec3 emitted{0.0}, absorbed{0.0}, escaped{0.0};
};

struct DiffusionCounts {
    std::uint64_t cells = 0;
    int levels = 0;           // of the multigrid
    int limiters = 0;         // solutions one after another, of the colour with most; 1 without a flux limiter
    int iterations = 0;       // of conjugate gradients, of all colours and limiters
    double residual = 0.0;    // of the worst colour's last solution
    double change = 0.0;      // of the fluence by the last limiter, of the worst colour
    bool converged = true;    // both are below what the settings allow
    double unbalanced = 0.0;  // |emitted - absorbed - escaped| / emitted, luminance
};

class Diffusion {
public:
    // On level 0 of the pyramid, whose surfaces stop light. Keeps a reference to it.
    Diffusion(const ExtinctionPyramid& pyramid, const DiffusionSettings& settings);

    // `intensity`: light that leaves the nodes [W/sr], mean over directions; `directional`: its degrees 1 and 2, 24 per
    // node (sh.h), or empty. Fluence at all nodes, and with directional light its moments, of which degree 2 is 0.
    Gathered solve(std::span<const Rgb> intensity, std::span<const float> directional);

    const DiffusionCounts& counts() const { return counts_; }
    const DiffusionBalance& balance() const { return balance_; }  // of the last solution
    std::uint64_t bytes() const;

private:
    struct Colour;  // what one colour's equation consists of

    void find_walls();
    bool wall(std::size_t cell, int axis) const { return !walls_.empty() && (walls_[cell] >> axis & 1) != 0; }
    Colour coefficients(int colour) const;
    // `limit`: by the flux limiter, for the fluence that the colour has.
    void set_constants(Colour& colour, bool limit) const;
    void set_system(const Colour& colour);
    std::vector<double> right_side(const Colour& colour, std::span<const Rgb> intensity,
                                   std::span<const float> directional) const;
    void solve_colour(Colour& colour, std::span<const Rgb> intensity, std::span<const float> directional);
    void write(const Colour& colour, std::span<const Rgb> intensity, std::span<const float> directional, Gathered& out);
    double dipole_flux(const Colour& colour, std::span<const float> directional, std::size_t cell, int axis) const;

    const ExtinctionPyramid& pyramid_;
    const Medium& medium_;
    DiffusionSettings settings_;
    Multigrid multigrid_;
    std::array<vec3, 3> axis_;           // unit vectors of the lattice's axes, local
    std::array<double, 3> edge_, area_;  // distance of nodes along an axis [m] and the face between them [m^2]
    double longest_flight_;              // [m]
    std::vector<std::uint8_t> walls_;    // per cell, bits 0, 1, 2: a surface before the neighbour at +x, +y, +z
    DiffusionCounts counts_;
    DiffusionBalance balance_;
};

}  // namespace brisance
