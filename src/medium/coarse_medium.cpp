#include "medium/coarse_medium.h"

#include <algorithm>

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
    const std::vector<float> mean = averaged_down(f.lattice, std::move(scattering), 3, level);
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
    BrickLattice lattice = fine.lattice;
    std::vector<float> extinction = fine.extinction;
    average_down(lattice, extinction, 1, level);
    return coarse_medium(fine, std::move(lattice), std::move(extinction), level);
}

void average_down(BrickLattice& lattice, std::vector<float>& values, int channels, int levels) {
    for (int l = 0; l < levels; ++l) {
        BrickLattice coarse;
        std::vector<float> means;
        coarsen(lattice, values, channels, coarse, means);
        lattice = std::move(coarse);
        values = std::move(means);
    }
}

std::vector<float> averaged_down(BrickLattice lattice, std::vector<float> values, int channels, int levels) {
    average_down(lattice, values, channels, levels);
    return values;
}

// Splats node values to the lattice 2^levels coarser.
std::vector<float> splat_down(BrickLattice lattice, std::vector<float> values, int channels, int levels) {
    for (int l = 0; l < levels; ++l) {
        BrickLattice coarse;
        std::vector<float> sums;
        coarsen(lattice, values, channels, coarse, sums);
        for (float& v : sums)
            v *= 8.0f;
        lattice = std::move(coarse);
        values = std::move(sums);
    }
    return values;
}

std::vector<std::uint8_t> parents(const BrickLattice& fine, const std::vector<std::uint8_t>& mask,
                                  BrickLattice& coarse) {
    std::vector<float> sums;
    coarsen(fine, std::vector<float>(mask.begin(), mask.end()), 1, coarse, sums);
    std::vector<std::uint8_t> out(sums.size());
    std::transform(sums.begin(), sums.end(), out.begin(), [](float sum) { return sum > 0.0f; });
    return out;
}

std::vector<float> flattened(const std::vector<Rgb>& colours) {
    const auto* p = reinterpret_cast<const float*>(colours.data());
    return {p, p + colours.size() * 3};
}

}  // namespace brisance
