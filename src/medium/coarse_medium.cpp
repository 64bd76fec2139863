#include "medium/coarse_medium.h"

#include <algorithm>

namespace brisance {

// The medium of a pyramid level: coarse nodes at every 2^level-th index, mean extinction, mean albedo by extinction.
Medium coarse_medium(const ExtinctionPyramid& fine, int level) {
    const Medium& f = fine.medium();
    Medium m;
    const float scale = float(1 << level);
    m.lattice = fine.lattice(level);
    m.extinction = fine.nodes(level);
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
    if (f.albedo_nodes.empty())
        return m;
    std::vector<float> scattering(f.extinction.size() * 3);
    for (std::size_t i = 0; i < f.extinction.size(); ++i)
        for (int c = 0; c < 3; ++c)
            scattering[i * 3 + c] = f.extinction[i] * f.albedo_nodes[i][c];
    BrickLattice lattice = f.lattice;
    for (int l = 0; l < level; ++l) {
        BrickLattice coarse;
        std::vector<float> values;
        coarsen(lattice, scattering, 3, coarse, values);
        lattice = std::move(coarse);
        scattering = std::move(values);
    }
    m.albedo_nodes.resize(m.extinction.size(), Rgb(0.0f));
    for (std::size_t i = 0; i < m.extinction.size(); ++i)
        if (m.extinction[i] > 0.0f)
            m.albedo_nodes[i] = glm::min(
                Rgb(scattering[i * 3], scattering[i * 3 + 1], scattering[i * 3 + 2]) / m.extinction[i], Rgb(1.0f));
    return m;
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
