#include "medium/coarse_medium.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/parallel.h"

namespace brisance {

namespace {

// Means of the albedo, weighted by extinction, at the nodes of `to`, whose lattice and extinction are there.
void average_albedo(const Medium& f, int level, Medium& to) {
    std::vector<float> scattering(f.extinction.size() * 3);
    parallel_for(
        f.extinction.size(),
        [&](std::size_t i) {
            for (int c = 0; c < 3; ++c)
                scattering[i * 3 + c] = f.extinction[i] * f.albedo_nodes[i][c];
        },
        4096);
    const std::vector<float> mean = averaged_down(f.lattice, scattering, 3, level).values;
    to.albedo_nodes.resize(to.extinction.size(), Rgb(0.0f));
    for (std::size_t i = 0; i < to.extinction.size(); ++i)
        if (to.extinction[i] > 0.0f)
            to.albedo_nodes[i] =
                glm::min(Rgb(mean[i * 3], mean[i * 3 + 1], mean[i * 3 + 2]) / to.extinction[i], Rgb(1.0f));
}

Medium coarse_medium(const Medium& f, BrickLattice lattice, std::vector<float> extinction, int level) {
    Medium m;
    const float scale = float(1 << level);
    m.lattice = std::move(lattice);
    m.extinction = std::move(extinction);
    m.world_from_index = f.world_from_index;
    for (int a = 0; a < 3; ++a)
        m.world_from_index[a] *= double(scale);
    m.reference_node = f.reference_node >> level;
    m.local_from_index = f.local_from_index * scale;
    m.index_from_local = f.index_from_local * (1.0f / scale);
    m.voxel_volume = f.voxel_volume * scale * scale * scale;
    m.spacing = f.spacing * scale;
    m.albedo = f.albedo;
    m.mean_cosine = f.mean_cosine;
    m.max_extinction = m.extinction.empty() ? 0.0f : *std::max_element(m.extinction.begin(), m.extinction.end());
    if (!f.albedo_nodes.empty())
        average_albedo(f, level, m);
    return m;
}

}  // namespace

Medium coarse_medium(const ExtinctionPyramid& fine, int level) {
    return coarse_medium(fine.medium(), fine.lattice(level), fine.nodes(level), level);
}

Medium coarse_medium(const Medium& fine, int level) {
    Averages mean = averaged_down(fine.lattice, fine.extinction, 1, level);
    return coarse_medium(fine, std::move(mean.lattice), std::move(mean.values), level);
}

// Volumes are large: the first step reads the values where they are.
Averages averaged_down(const BrickLattice& lattice, std::span<const float> values, int channels, int levels) {
    if (levels == 0)
        return {lattice, {values.begin(), values.end()}};
    Averages out;
    coarsen(lattice, values, channels, out.lattice, out.values);
    for (int l = 1; l < levels; ++l) {
        Averages next;
        coarsen(out.lattice, out.values, channels, next.lattice, next.values);
        out = std::move(next);
    }
    return out;
}

std::vector<float> splat_down(const BrickLattice& lattice, std::span<const float> values, int channels, int levels) {
    std::vector<float> sums = averaged_down(lattice, values, channels, levels).values;
    const float nodes = std::exp2(3.0f * float(levels));  // finer ones for each
    parallel_for(
        sums.size(), [&](std::size_t i) { sums[i] *= nodes; }, 4096);
    return sums;
}

std::vector<std::uint8_t> parents(const BrickLattice& fine, const std::vector<std::uint8_t>& mask,
                                  BrickLattice& coarse) {
    std::vector<float> sums;
    coarsen(fine, std::vector<float>(mask.begin(), mask.end()), 1, coarse, sums);
    std::vector<std::uint8_t> out(sums.size());
    std::transform(sums.begin(), sums.end(), out.begin(), [](float sum) { return sum > 0.0f; });
    return out;
}

std::span<const float> flattened(const std::vector<Rgb>& colours) {
    return {reinterpret_cast<const float*>(colours.data()), colours.size() * 3};
}

}  // namespace brisance
