#include "scattering/coarse_operator.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "gathering/sh.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/phase.h"
#include "scattering/balance.h"
#include "scattering/multiple_scattering.h"

namespace brisance {

namespace {

constexpr int kCollisionDirections = 32;
constexpr int kBalanceSweeps = 3;
// A node that sharpening leaves less of its unit light than this is about to be emptied.
constexpr float kEmptied = 0.1f;

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

void ScatteredLight::add(const ScatteredLight& other, const Rgb& factor) {
    for (std::size_t i = 0; i < intensity.size(); ++i)
        intensity[i] += factor * other.intensity[i];
    for (std::size_t i = 0; i < directional.size(); ++i)
        directional[i] += factor[int(i % 3)] * other.directional[i];
}

void ScatteredLight::sharpen(const BrickLattice& lattice) {
    const std::vector<Rgb> before = intensity;
    sharpen_lights(lattice, intensity);
    for (std::size_t i = 0; i < intensity.size() && !directional.empty(); ++i)
        for (int k = 0; k < 24; ++k) {
            const float from = before[i][k % 3];
            directional[i * 24 + k] *= from > 0.0f ? intensity[i][k % 3] / from : 0.0f;
        }
}

ScatteredLight scattered_light(const Medium& medium, const Gathered& arriving, const std::vector<std::uint8_t>& mask) {
    const std::size_t n = mask.size();
    const auto projected = [&](const std::vector<float>& field, std::size_t first_plane, float factor) {
        std::vector<Rgb> source(n, Rgb(0.0f));
        parallel_for(
            n,
            [&](std::size_t i) {
                if (mask[i])
                    for (int c = 0; c < 3; ++c)
                        source[i][c] = factor * medium.albedo_at(i)[c] * field[(first_plane + c) * n + i];
            },
            4096);
        return project_extinction_times(medium, source);
    };
    ScatteredLight light;
    light.intensity = projected(arriving.fluence, 0, 1.0f / (4.0f * kPi));
    if (arriving.moments.empty())
        return light;
    light.directional.resize(n * 24);
    for (int m = 0; m < kShMoments; ++m) {
        const std::vector<Rgb> part = projected(arriving.moments, 3 * m, sh_phase_factor(m, medium.mean_cosine));
        for (std::size_t i = 0; i < n; ++i)
            for (int c = 0; c < 3; ++c)
                light.directional[i * 24 + 3 * m + c] = part[i][c];
    }
    return light;
}

CoarseOperator::CoarseOperator(const ExtinctionPyramid& fine, int level, const LightingSettings& lighting, float alpha)
    : level_(level), medium_(coarse_medium(fine, level)), lighting_(lighting), alpha_(alpha) {
    pyramid_ = std::make_unique<ExtinctionPyramid>(medium_, ExtinctionPyramid::kMaxLevels);
    pyramid_->set_occluders(fine.occluders());
    unit_ = project_extinction_times(medium_, std::vector<Rgb>(medium_.extinction.size(), Rgb(1.0f)));
    weight_.resize(unit_.size());
    least_weight_.resize(unit_.size());
    mask_.resize(unit_.size());
    for (std::size_t i = 0; i < unit_.size(); ++i) {
        least_weight_[i] = kEmptied * unit_[i].x;
        active_ += mask_[i] = unit_[i].x > 0.0f;
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
    std::uint64_t sum =
        medium_.bytes() + pyramid_->bytes() + grid_.bytes() + weight_.size() * 13 + collision_.size() * 4;
    for (const auto& m : maps_.levels)
        sum += m.maps.size() * 2;
    return sum;
}

void CoarseOperator::balance_nodes(const ExtinctionPyramid& fine) {
    std::vector<std::size_t> nodes;
    std::vector<ivec3> vertices;
    for (std::size_t i = 0; i < mask_.size(); ++i)
        if (mask_[i]) {
            nodes.push_back(i);
            vertices.push_back(medium_.lattice.node(i));
        }
    collision_numbers_ = medium_.mean_cosine == 0.0f ? 1 : kCollisionMoments;
    const std::vector<float> collision =
        collision_probabilities(fine, vertices, level_, kCollisionDirections, collision_numbers_);
    collision_.assign(mask_.size() * collision_numbers_, 0.0f);
    for (std::size_t k = 0; k < nodes.size(); ++k)
        std::copy_n(&collision[k * collision_numbers_], collision_numbers_, &collision_[nodes[k] * collision_numbers_]);

    // D K D (unit source) = 4 pi collision, by the symmetric fixed point D <- D sqrt(expected / gathered).
    std::vector<LevelCost> costs;
    Progress silent;
    ScatteredLight unit;
    unit.intensity = unit_;
    for (int sweep = 0; sweep < kBalanceSweeps; ++sweep) {
        const Gathered gathered = gather(unit, costs, silent);
        for (std::size_t i : nodes) {
            const float expected = 4.0f * kPi * collision_[i * collision_numbers_];
            if (gathered.fluence[i] > 0.0f && expected > 0.0f)
                factor_[i] = std::clamp(factor_[i] * std::sqrt(expected / gathered.fluence[i]), 0.2f, 5.0f);
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
                           &maps_,
                           pyramid_->occluders()};
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

ScatteredLight CoarseOperator::restricted(const ScatteredLight& fine, const BrickLattice& fine_lattice) const {
    ScatteredLight coarse;
    coarse.intensity = as_colours(splat_down(fine_lattice, flattened(fine.intensity), 3, level_));
    if (!fine.directional.empty())
        coarse.directional = splat_down(fine_lattice, fine.directional, 24, level_);
    coarse.sharpen(medium_.lattice);
    return coarse;
}

dvec3 CoarseOperator::expected_collisions(const ScatteredLight& lights) const {
    dvec3 sum(0.0);
    for (std::size_t i = 0; i < mask_.size(); ++i) {
        const float* collision = &collision_[i * collision_numbers_];
        sum += dvec3(lights.intensity[i]) * double(collision[0]);
        for (int k = 0; k < 24 && collision_numbers_ > 1 && !lights.directional.empty(); ++k)
            sum[k % 3] += double(lights.directional[i * 24 + k]) * collision[1 + k / 3];
    }
    return sum;
}

ScatteredLight CoarseOperator::bounce(const ScatteredLight& lights, FlightPower& flight, std::vector<LevelCost>& costs,
                                      Progress& progress) {
    Gathered arriving = gather(lights, costs, progress);
    prepare_interpolation(medium_.lattice, mask_, arriving);
    flight.gathered = collided_power(medium_, fluence_at_nodes(arriving, mask_));
    if (lighting_.energy_balance) {
        const dvec3 expected = expected_collisions(lights);
        Rgb scale(1.0f);
        for (int c = 0; c < 3; ++c)
            if (flight.gathered[c] > 0.0)
                scale[c] = static_cast<float>(expected[c] / flight.gathered[c]);
        arriving.scale(scale);
        flight.absorbed = absorbed_power(medium_, fluence_at_nodes(arriving, mask_));
    }
    ScatteredLight next = scattered_light(medium_, arriving, mask_);
    next.sharpen(medium_.lattice);
    return next;
}

ScatteredLight CoarseOperator::spread_to_fine(const ScatteredLight& coarse, const Medium& fine) const {
    const std::size_t n = fine.lattice.node_count();
    const CoarseSampler sampler{medium_.lattice, level_};
    const bool directional = !coarse.directional.empty();
    const int channels = directional ? 27 : 3;
    // The source function is the light leaving per volume and extinction. Where a coarse node has no extinction, its
    // neighbours determine it. A node that sharpening has emptied has almost no weight: its quotient would be rounding.
    std::vector<std::vector<Rgb>> source(channels / 3, std::vector<Rgb>(n, Rgb(0.0f)));
    parallel_for(
        fine.lattice.brick_count(),
        [&](std::size_t b) {
            for (int k = 0; k < BrickLattice::kNodes; ++k) {
                const std::size_t i = b * BrickLattice::kNodes + k;
                float sum[27] = {}, mass = 0.0f;
                sampler.at(fine.lattice.first_node(b) + BrickLattice::node_in_brick(k), [&](std::size_t q, float w) {
                    if (!mask_[q])
                        return;
                    const float per_mass = w / std::max(weight_[q], least_weight_[q]);
                    mass += w;
                    for (int c = 0; c < 3; ++c)
                        sum[c] += per_mass * coarse.intensity[q][c];
                    for (int c = 0; c < channels - 3; ++c)
                        sum[3 + c] += per_mass * coarse.directional[q * 24 + c];
                });
                if (mass > 0.0f)
                    for (int c = 0; c < channels; ++c)
                        source[c / 3][i][c % 3] = sum[c] / mass;
            }
        },
        4);
    ScatteredLight light;
    light.intensity = project_extinction_times(fine, source[0]);
    // Extinction and source vary together below the coarse voxel, which the product of averages does not see: the power
    // is that of the series.
    const dvec3 wanted = total(coarse.intensity), found = total(light.intensity);
    Rgb scale(1.0f);
    for (int c = 0; c < 3; ++c)
        if (found[c] > 0.0)
            scale[c] = static_cast<float>(wanted[c] / found[c]);
    for (Rgb& i : light.intensity)
        i *= scale;
    light.directional.resize(directional ? n * 24 : 0);
    for (int m = 0; m < kShMoments && directional; ++m) {
        const std::vector<Rgb> part = project_extinction_times(fine, source[1 + m]);
        for (std::size_t i = 0; i < n; ++i)
            for (int c = 0; c < 3; ++c)
                light.directional[i * 24 + 3 * m + c] = scale[c] * part[i][c];
    }
    return light;
}

}  // namespace brisance
