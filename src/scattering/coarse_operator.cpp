#include "scattering/coarse_operator.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "gathering/sh.h"
#include "lights/voxel_lights.h"
#include "medium/phase.h"
#include "scattering/balance.h"
#include "scattering/multiple_scattering.h"

namespace brisance {

namespace {

constexpr int kEscapeDirections = 32;
constexpr int kBalanceSweeps = 3;

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
    // Where nothing is to be averaged the node's own albedo stays: interpolation reaches there.
    m.albedo_nodes.resize(m.extinction.size(), f.albedo);
    for (std::size_t i = 0; i < m.extinction.size(); ++i) {
        const ivec3 vertex = m.lattice.first_node(i / BrickLattice::kNodes) +
                             BrickLattice::node_in_brick(int(i % BrickLattice::kNodes));
        const std::int64_t own = f.lattice.find_node(vertex * (1 << level));
        if (m.extinction[i] > 0.0f)
            m.albedo_nodes[i] = glm::min(
                Rgb(scattering[i * 3], scattering[i * 3 + 1], scattering[i * 3 + 2]) / m.extinction[i], Rgb(1.0f));
        else if (own >= 0)
            m.albedo_nodes[i] = f.albedo_nodes[own];
    }
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

std::vector<float> flattened(const std::vector<Rgb>& v) {
    const auto* p = reinterpret_cast<const float*>(v.data());
    return {p, p + v.size() * 3};
}

std::vector<Rgb> as_colours(const std::vector<float>& v) {
    std::vector<Rgb> c(v.size() / 3);
    for (std::size_t i = 0; i < c.size(); ++i)
        c[i] = {v[i * 3], v[i * 3 + 1], v[i * 3 + 2]};
    return c;
}

// Coarse node values at fine nodes, trilinearly.
struct CoarseSampler {
    const BrickLattice& lattice;
    int level;

    template <class Add>
    void at(const ivec3& fine_node, const Add& add) const {
        const ivec3 base = fine_node >> level;
        const vec3 f = vec3(fine_node - (base << level)) / float(1 << level);
        for (int k = 0; k < 8; ++k) {
            const ivec3 d(k >> 2, k >> 1 & 1, k & 1);
            const float w = (d.x ? f.x : 1 - f.x) * (d.y ? f.y : 1 - f.y) * (d.z ? f.z : 1 - f.z);
            const std::int64_t i = w > 0.0f ? lattice.find_node(base + d) : -1;
            if (i >= 0)
                add(std::size_t(i), w);
        }
    }
};

}  // namespace

CoarseOperator::CoarseOperator(const ExtinctionPyramid& fine, int level, const LightingSettings& lighting, float alpha)
    : level_(level), medium_(coarse_medium(fine, level)), lighting_(lighting), alpha_(alpha) {
    pyramid_ = std::make_unique<ExtinctionPyramid>(medium_, ExtinctionPyramid::kMaxLevels);
    unit_ = project_extinction_times(medium_, std::vector<Rgb>(medium_.extinction.size(), Rgb(1.0f)));
    weight_.resize(unit_.size());
    mask_.resize(unit_.size());
    // Before sharpening, which may leave a node nothing but rounding: then whether a node counts would be chance.
    mass_.resize(unit_.size());
    for (std::size_t i = 0; i < unit_.size(); ++i) {
        mass_[i] = unit_[i].x;
        active_ += mask_[i] = mass_[i] > 0.0f;
    }
    sharpen_lights(medium_.lattice, unit_);
    for (std::size_t i = 0; i < unit_.size(); ++i)
        weight_[i] = unit_[i].x;
    grid_ = build_lighting_grid(medium_, unit_, &weight_, automatic_levels(medium_));
    factor_.assign(weight_.size(), 1.0f);
    if (lighting_.energy_balance)
        balance_nodes(fine);
}

std::uint64_t CoarseOperator::bytes() const {
    std::uint64_t sum = medium_.bytes() + pyramid_->bytes() + grid_.bytes() + weight_.size() * 13;
    for (const auto& m : maps_.levels)
        sum += m.size() * 2;
    return sum;
}

void CoarseOperator::balance_nodes(const ExtinctionPyramid& fine) {
    std::vector<std::size_t> nodes;
    std::vector<ivec3> vertices;
    for (std::size_t i = 0; i < mask_.size(); ++i)
        if (mask_[i]) {
            nodes.push_back(i);
            vertices.push_back(medium_.lattice.first_node(i / BrickLattice::kNodes) +
                               BrickLattice::node_in_brick(int(i % BrickLattice::kNodes)));
        }
    const std::vector<float> collision = collision_probabilities(fine, vertices, level_, kEscapeDirections);
    const std::vector<float> of_hat = collision_probabilities_of_hats(fine, vertices, level_, kEscapeDirections);
    collision_.assign(mask_.size(), 0.0f);
    hat_collision_.assign(mask_.size(), 0.0f);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        collision_[nodes[k]] = collision[k];
        hat_collision_[nodes[k]] = of_hat[k];
    }

    // D K D (unit source) = 4 pi (collision probability), by the symmetric fixed point D <- D sqrt(wanted / found).
    std::vector<LevelCost> costs;
    Progress silent;
    ScatteredLight unit;
    unit.intensity = unit_;
    node_scale_.assign(mask_.size(), 1.0f);
    for (int sweep = 0; sweep < kBalanceSweeps; ++sweep) {
        const Gathered found = gather(unit, costs, silent);
        for (std::size_t i : nodes) {
            const float wanted = 4.0f * kPi * collision_[i];
            if (!(found.fluence[i] > 0.0f && wanted > 0.0f))
                continue;
            const float ratio = wanted / found.fluence[i];
            if (sweep == 0)
                node_scale_[i] = std::clamp(ratio, 0.2f, 5.0f);
            factor_[i] = std::clamp(factor_[i] * std::sqrt(ratio), 0.2f, 5.0f);
        }
    }
}

Gathered CoarseOperator::gather(const ScatteredLight& lights, std::vector<LevelCost>& costs, Progress& progress) {
    ScatteredLight scaled = lights;
    for (std::size_t i = 0; i < factor_.size(); ++i) {
        scaled.intensity[i] *= factor_[i];
        for (std::size_t k = 0; k < 24 && !scaled.directional.empty(); ++k)
            scaled.directional[i * 24 + k] *= factor_[i];
    }
    const bool directional = !scaled.directional.empty();
    set_intensity(grid_, medium_.lattice, scaled.intensity, directional ? &scaled.directional : nullptr);
    const LightField field{pyramid_.get(),
                           &scaled.intensity,
                           directional ? &scaled.directional : nullptr,
                           &grid_,
                           &weight_,
                           alpha_,
                           lighting_,
                           &maps_};
    std::vector<LevelCost> these;
    Gathered out = gather_at_nodes(field, {&mask_, nullptr, directional, medium_.mean_cosine}, these, progress);
    if (costs.empty())
        costs = these;
    const std::size_t n = factor_.size();
    for (auto* f : {&out.fluence, &out.moments})
        parallel_for(f->size() / n, [&](std::size_t plane) {
            for (std::size_t i = 0; i < n; ++i)
                (*f)[plane * n + i] *= mask_[i] ? factor_[i] : 0.0f;
        });
    return out;
}

Departure CoarseOperator::restricted(const ScatteredLight& fine, const BrickLattice& fine_lattice) const {
    Departure out;
    out.light.intensity = out.power = as_colours(splat_down(fine_lattice, flattened(fine.intensity), 3, level_));
    if (!fine.directional.empty())
        out.light.directional = splat_down(fine_lattice, fine.directional, 24, level_);
    out.light.sharpen(medium_.lattice);
    return out;
}

Departure CoarseOperator::departure_of(const NodeRadiance& source) const {
    Departure out;
    out.light = scattered_light(medium_, source);
    out.light.sharpen(medium_.lattice);
    out.power.resize(mass_.size());
    for (std::size_t i = 0; i < mass_.size(); ++i)
        out.power[i] = mass_[i] * source.mean[i];
    return out;
}

// Multiplies what arrives so that `collides` of it does. Deep in thick smoke a gather cannot but be right: what arrives
// there set out next door. So it is the nodes from which light escapes that answer for what is missing or too much.
void CoarseOperator::close_balance(const dvec3& collides, const dvec3& hit, Gathered& arriving) const {
    constexpr float kLeastShare = 1e-3f;
    constexpr double kMostChange = 0.5;
    const std::size_t n = mask_.size();
    std::vector<float> share(n, 0.0f);
    std::vector<Rgb> shared(n, Rgb(0.0f));
    for (std::size_t i = 0; i < n; ++i)
        if (mask_[i]) {
            share[i] = 1.0f - collision_[i] + kLeastShare;
            for (int c = 0; c < 3; ++c)
                shared[i][c] = share[i] * arriving.fluence[c * n + i];
        }
    const dvec3 of_shares = collided(medium_, shared);
    dvec3 change(0.0);
    for (int c = 0; c < 3; ++c)
        if (of_shares[c] > 0.0)
            change[c] = std::clamp((collides[c] - hit[c]) / of_shares[c], -kMostChange, kMostChange);
    for (auto* field : {&arriving.fluence, &arriving.moments})
        for (std::size_t k = 0; k < field->size(); ++k)
            (*field)[k] *= 1.0f + static_cast<float>(change[int(k / n % 3)]) * share[k % n];
}

NodeRadiance CoarseOperator::bounce(const Departure& departure, BounceBalance& balance, std::vector<LevelCost>& costs,
                                    Progress& progress) {
    Gathered arriving = gather(departure.light, costs, progress);
    prepare_interpolation(medium_.lattice, mask_, arriving);
    const dvec3 hit = collided(medium_, fluence_at_nodes(arriving, mask_));
    const dvec3 emitted = total(departure.power);
    const double y = luminance(Rgb(emitted));
    balance.collided = luminance(Rgb(hit)) / y;
    if (lighting_.energy_balance) {
        dvec3 collides(0.0);
        for (std::size_t i = 0; i < mask_.size(); ++i)
            collides += dvec3(departure.power[i]) * double(hat_collision_[i]);
        close_balance(collides, hit, arriving);
        balance.escaped = 1.0 - luminance(Rgb(collides)) / y;
        balance.scale = luminance(Rgb(collided(medium_, fluence_at_nodes(arriving, mask_)))) / y / balance.collided;
    }
    return scattered_source(medium_, arriving, mask_);
}

ScatteredLight CoarseOperator::spread_to_fine(const NodeRadiance& coarse, const Medium& fine) const {
    const std::size_t n = fine.lattice.node_count();
    const CoarseSampler sampler{medium_.lattice, level_};
    const int coefficients = coarse.directional.empty() ? 0 : 3 * kShMoments;
    NodeRadiance source;
    source.mean.resize(n, Rgb(0.0f));
    source.directional.resize(n * coefficients, 0.0f);
    // Where a coarse node has no extinction its neighbours speak.
    parallel_for(
        fine.lattice.brick_count(),
        [&](std::size_t b) {
            for (int k = 0; k < BrickLattice::kNodes; ++k) {
                const std::size_t i = b * BrickLattice::kNodes + k;
                float* const directional = source.directional.data() + i * coefficients;
                float mass = 0.0f;
                sampler.at(fine.lattice.first_node(b) + BrickLattice::node_in_brick(k), [&](std::size_t q, float w) {
                    if (!mask_[q])
                        return;
                    mass += w;
                    source.mean[i] += w * coarse.mean[q];
                    for (int c = 0; c < coefficients; ++c)
                        directional[c] += w * coarse.directional[q * coefficients + c];
                });
                if (mass <= 0.0f)
                    continue;
                source.mean[i] /= mass;
                for (int c = 0; c < coefficients; ++c)
                    directional[c] /= mass;
            }
        },
        4);
    ScatteredLight light = scattered_light(fine, source);
    // Extinction and source vary together below the coarse voxel, which the product of averages does not see: the power
    // is that of the series.
    const dvec3 wanted = total(project_extinction_times(medium_, coarse.mean)), found = total(light.intensity);
    Rgb scale(1.0f);
    for (int c = 0; c < 3; ++c)
        if (found[c] > 0.0)
            scale[c] = static_cast<float>(wanted[c] / found[c]);
    for (Rgb& i : light.intensity)
        i *= scale;
    for (std::size_t i = 0; i < light.directional.size(); ++i)
        light.directional[i] *= scale[int(i % 3)];
    return light;
}

}  // namespace brisance
