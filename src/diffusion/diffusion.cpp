#include "diffusion/diffusion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "diffusion/cell_loops.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/lattice/local_bounds.h"
#include "medium/sh.h"

namespace brisance {

namespace {

constexpr double kFullSphere = 4.0 * std::numbers::pi;  // [sr]
// The coefficient of sh_basis that a component of the flux has: degree 1 is ordered y, z, x.
constexpr int kMomentOfAxis[3] = {2, 0, 1};

// D by the rational flux limiter, written without a division by the extinction or the fluence.
double limited(double extinction, double fluence, double gradient, double most) {
    const double thick = extinction * fluence;
    const double below = 6.0 * thick * thick + 3.0 * thick * gradient + gradient * gradient;
    return below > 0.0 ? std::min(most, fluence * (2.0 * thick + gradient) / below) : most;
}

// Root mean square of the difference over that of the fluence.
double relative_change(const std::vector<double>& before, const std::vector<double>& now) {
    const double squares =
        sum_over(now.size(), [&](std::size_t i) { return (now[i] - before[i]) * (now[i] - before[i]); });
    const double all = sum_over(now.size(), [&](std::size_t i) { return now[i] * now[i]; });
    return all > 0.0 ? std::sqrt(squares / all) : 0.0;
}

}  // namespace

struct Diffusion::Colour {
    int index = 0;
    std::vector<float> reduced;     // sigma_t' of the cells [1/m]
    std::vector<float> absorption;  // of the cells, integrated [m^2]
    std::vector<double> fluence;    // of the cells [W/m^2], and a last 0
    // D [m] of the faces at +x, +y, +z of a cell, and of the cell itself.
    std::array<std::vector<float>, 4> constant;
};

Diffusion::Diffusion(const ExtinctionPyramid& pyramid, const DiffusionSettings& settings)
    : pyramid_(pyramid),
      medium_(pyramid.medium()),
      settings_(settings),
      multigrid_(medium_.lattice),
      longest_flight_(local_bounds(medium_).diagonal()) {
    for (int a = 0; a < 3; ++a) {
        edge_[a] = glm::length(dvec3(medium_.local_from_index[a]));
        axis_[a] = vec3(dvec3(medium_.local_from_index[a]) / edge_[a]);
        area_[a] = medium_.voxel_volume / edge_[a];
    }
    if (pyramid.occluders())
        find_walls();
    counts_.cells = multigrid_.cells().count();
    counts_.levels = multigrid_.level_count();
}

std::uint64_t Diffusion::bytes() const {
    return multigrid_.bytes() + walls_.size() + multigrid_.cells().count() * (6 * sizeof(float) + 3 * sizeof(double));
}

void Diffusion::find_walls() {
    const Cells& cells = multigrid_.cells();
    walls_.assign(cells.count(), 0);
    const vec3 diagonal = medium_.local_from_index * vec3(float(BrickLattice::kSize));
    parallel_for(cells.lattice.brick_count(), [&](std::size_t b) {
        const vec3 first = medium_.local_of_node(cells.lattice.first_node(b));
        float radius = 0.0f;
        for (int k = 0; k < 8; ++k)
            radius =
                std::max(radius, glm::length(medium_.local_from_index *
                                             (float(BrickLattice::kSize) * (vec3(k >> 2, k >> 1 & 1, k & 1) - 0.5f))));
        if (!pyramid_.occluders()->any_within(first + 0.5f * diagonal, radius))
            return;
        for (int k = 0; k < BrickLattice::kNodes; ++k) {
            const ivec3 node = cells.lattice.first_node(b) + BrickLattice::node_in_brick(k);
            const vec3 from = medium_.local_of_node(node);
            for (int a = 0; a < 3; ++a)
                if (!pyramid_.occluders()->visible(from, from + medium_.local_from_index[a]))
                    walls_[b * BrickLattice::kNodes + k] |= std::uint8_t(1 << a);
        }
    });
}

Diffusion::Colour Diffusion::coefficients(int colour) const {
    Colour out;
    out.index = colour;
    const std::size_t n = multigrid_.cells().count();
    std::vector<Rgb> factor(n);
    over_cells(n, [&](std::size_t i) {
        const float albedo = medium_.albedo_at(i)[colour];
        factor[i] = {1.0f - albedo, 1.0f - medium_.mean_cosine * albedo, 0.0f};
    });
    const std::vector<Rgb> integrated = project_extinction_times(medium_, factor);
    out.reduced.resize(n);
    out.absorption.resize(n);
    over_cells(n, [&](std::size_t i) {
        out.absorption[i] = std::max(0.0f, integrated[i].x);
        out.reduced[i] = std::max(0.0f, integrated[i].y / medium_.voxel_volume);
    });
    out.fluence.assign(n + 1, 0.0);
    for (std::vector<float>& c : out.constant)
        c.resize(n);
    return out;
}

void Diffusion::set_constants(Colour& colour, bool limit) const {
    const Cells& cells = multigrid_.cells();
    const std::size_t n = cells.count();
    const double most = longest_flight_ / 3.0;
    const std::vector<double>& phi = colour.fluence;
    // Along an axis, over the neighbours that there are.
    const auto slope = [&](std::size_t i, int a) {
        const auto& next = cells.neighbour[i];
        const std::size_t up = next[a] == cells.none() ? i : next[a],
                          down = next[3 + a] == cells.none() ? i : next[3 + a];
        return up == down ? 0.0 : (phi[up] - phi[down]) / (edge_[a] * (up != i && down != i ? 2.0 : 1.0));
    };
    const auto unlimited = [&](double extinction) {
        return extinction * 3.0 * most > 1.0 ? 1.0 / (3.0 * extinction) : most;
    };
    std::vector<dvec3> gradient(limit ? n : 0);
    over_cells(gradient.size(), [&](std::size_t i) { gradient[i] = {slope(i, 0), slope(i, 1), slope(i, 2)}; });
    over_cells(n, [&](std::size_t i) {
        colour.constant[3][i] = float(limit ? limited(colour.reduced[i], phi[i], glm::length(gradient[i]), most)
                                            : unlimited(colour.reduced[i]));
        for (int a = 0; a < 3; ++a) {
            const std::int32_t j = cells.neighbour[i][a];
            if (j == cells.none())
                continue;
            const double extinction = 0.5 * (double(colour.reduced[i]) + colour.reduced[j]);
            if (limit) {
                dvec3 g = 0.5 * (gradient[i] + gradient[j]);
                g[a] = (phi[j] - phi[i]) / edge_[a];
                colour.constant[a][i] = float(limited(extinction, 0.5 * (phi[i] + phi[j]), glm::length(g), most));
            } else {
                colour.constant[a][i] = float(unlimited(extinction));
            }
        }
    });
}

void Diffusion::set_system(const Colour& colour) {
    const Cells& cells = multigrid_.cells();
    StencilSystem& s = multigrid_.system();
    over_cells(cells.count(), [&](std::size_t i) {
        double loss = colour.absorption[i];
        // Half an edge of diffusion to the face, where phi / 2 leaves.
        const auto escape = [&](int a) { return area_[a] / (2.0 + 0.5 * edge_[a] / colour.constant[3][i]); };
        for (int a = 0; a < 3; ++a) {
            const std::int32_t up = cells.neighbour[i][a], down = cells.neighbour[i][3 + a];
            const bool open = up != cells.none() && !wall(i, a);
            s.conductance[a][i] = open ? float(colour.constant[a][i] * area_[a] / edge_[a]) : 0.0f;
            loss += open ? 0.0 : escape(a);
            loss += down != cells.none() && !wall(down, a) ? 0.0 : escape(a);
        }
        s.loss[i] = float(loss);
    });
    multigrid_.set_up();
}

// 3 D Q1 through the face of a cell toward +axis [W].
double Diffusion::dipole_flux(const Colour& colour, std::span<const float> directional, std::size_t cell,
                              int axis) const {
    const std::int32_t next = multigrid_.cells().neighbour[cell][axis];
    if (directional.empty() || next == multigrid_.cells().none() || wall(cell, axis))
        return 0.0;
    double moment = 0.0;
    for (int a = 0; a < 3; ++a) {
        const std::size_t k = 3 * kMomentOfAxis[a] + colour.index;
        moment += 0.5 * axis_[axis][a] * (double(directional[cell * 24 + k]) + directional[std::size_t(next) * 24 + k]);
    }
    // The moment of Y against a direction is 4 pi / 3 times its coefficient.
    return kFullSphere * kSh1 * moment / medium_.voxel_volume * colour.constant[axis][cell] * area_[axis];
}

std::vector<double> Diffusion::right_side(const Colour& colour, std::span<const Rgb> intensity,
                                          std::span<const float> directional) const {
    const Cells& cells = multigrid_.cells();
    std::vector<double> right(cells.count());
    over_cells(cells.count(), [&](std::size_t i) {
        double power = kFullSphere * intensity[i][colour.index];
        for (int a = 0; a < 3 && !directional.empty(); ++a) {
            power -= dipole_flux(colour, directional, i, a);
            if (const std::int32_t down = cells.neighbour[i][3 + a]; down != cells.none())
                power += dipole_flux(colour, directional, down, a);
        }
        right[i] = power;
    });
    return right;
}

void Diffusion::solve_colour(Colour& colour, std::span<const Rgb> intensity, std::span<const float> directional) {
    const bool limit = settings_.flux_limiter;
    std::vector<double> before;
    Convergence found;
    double change = 0.0;
    int limiters = 0;
    // Coarsely until the limiter has settled, then finely until it has settled again.
    for (bool fine = !limit, settled = false; !settled && limiters < (limit ? settings_.most_limiters : 1);
         ++limiters) {
        set_constants(colour, limiters > 0);
        set_system(colour);
        before = colour.fluence;
        found = multigrid_.solve(right_side(colour, intensity, directional), colour.fluence,
                                 fine ? settings_.tolerance : settings_.first_tolerance, settings_.most_iterations);
        counts_.iterations += found.iterations;
        for (double& f : colour.fluence)
            f = std::max(f, 0.0);
        change = limit ? relative_change(before, colour.fluence) : 0.0;
        settled = fine && change <= settings_.most_change;
        fine = fine || change <= settings_.most_change;
    }
    counts_.limiters = std::max(counts_.limiters, limiters);
    counts_.residual = std::max(counts_.residual, found.residual);
    counts_.change = std::max(counts_.change, change);
    counts_.converged = counts_.converged && found.residual <= settings_.tolerance && change <= settings_.most_change;
}

void Diffusion::write(const Colour& colour, std::span<const Rgb> intensity, std::span<const float> directional,
                      Gathered& out) {
    const Cells& cells = multigrid_.cells();
    const std::size_t n = cells.count();
    const StencilSystem& s = multigrid_.system();
    const int c = colour.index;
    for (std::size_t i = 0; i < n; ++i) {
        balance_.emitted[c] += intensity[i][c];
        balance_.absorbed[c] += colour.absorption[i] * colour.fluence[i] / (kFullSphere);
        balance_.escaped[c] += (s.loss[i] - colour.absorption[i]) * colour.fluence[i] / (kFullSphere);
    }
    const auto flux = [&](std::size_t i, int a) {
        const std::int32_t next = cells.neighbour[i][a];
        return (s.conductance[a][i] * (colour.fluence[i] - colour.fluence[next]) +
                dipole_flux(colour, directional, i, a)) /
               area_[a];
    };
    over_cells(n, [&](std::size_t i) {
        out.fluence[c * n + i] = float(colour.fluence[i]);
        if (out.moments.empty())
            return;
        dvec3 sum(0.0);
        for (int a = 0; a < 3; ++a) {
            const std::int32_t down = cells.neighbour[i][3 + a];
            sum += dvec3(axis_[a]) * 0.5 * (flux(i, a) + (down == cells.none() ? flux(i, a) : flux(down, a)));
        }
        const double length = glm::length(sum);
        if (length > colour.fluence[i])
            sum *= colour.fluence[i] / length;
        for (int a = 0; a < 3; ++a)
            out.moments[(3 * kMomentOfAxis[a] + c) * n + i] = float(kSh1 * sum[a]);
    });
}

Gathered Diffusion::solve(std::span<const Rgb> intensity, std::span<const float> directional) {
    Gathered out;
    out.resize(multigrid_.cells().count(), false, !directional.empty());
    balance_ = {};
    for (int c = 0; c < 3; ++c) {
        if (std::none_of(intensity.begin(), intensity.end(), [&](const Rgb& i) { return i[c] > 0.0f; }))
            continue;
        Colour colour = coefficients(c);
        solve_colour(colour, intensity, directional);
        write(colour, intensity, directional, out);
    }
    const double emitted = luminance(Rgb(balance_.emitted));
    if (emitted > 0.0)
        counts_.unbalanced =
            std::abs(luminance(Rgb(balance_.emitted - balance_.absorbed - balance_.escaped))) / emitted;
    return out;
}

}  // namespace brisance
