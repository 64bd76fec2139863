#include "scattering/coarse_operator.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/coarse_medium.h"
#include "medium/phase.h"
#include "medium/sh.h"
#include "scattering/balance.h"
#include "scattering/multiple_scattering.h"

namespace brisance {

namespace {

constexpr int kCollisionDirections = 32;
constexpr int kBalanceSweeps = 3;
// Lights at the points of a lattice of needles are gathered a hundred times too brightly by their neighbours.
constexpr float kLeastFactor = 1e-3f;
// A node that sharpening leaves less of its unit light than this is about to be emptied.
constexpr float kEmptied = 0.1f;

std::vector<Rgb> as_colours(const std::vector<float>& v) {
    std::vector<Rgb> c(v.size() / 3);
    for (std::size_t i = 0; i < c.size(); ++i)
        c[i] = {v[i * 3], v[i * 3 + 1], v[i * 3 + 2]};
    return c;
}

}  // namespace

void ScatteredLight::add(const ScatteredLight& other, const Rgb& factor) {
    for (std::size_t i = 0; i < intensity.size(); ++i)
        intensity[i] += factor * other.intensity[i];
    for (std::size_t i = 0; i < directional.size(); ++i)
        directional[i] += factor[int(i % 3)] * other.directional[i];
    for (std::size_t i = 0; i < source.size(); ++i)
        source[i] += factor[int(i % 3)] * other.source[i];
}

void ScatteredLight::sharpen(const BrickLattice& lattice, int sharpened_below) {
    const std::vector<Rgb> before = intensity;
    sharpen_lights(lattice, intensity, sharpened_below);
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

std::vector<float> scattered_source(const Medium& medium, const Gathered& arriving,
                                    const std::vector<std::uint8_t>& mask) {
    const std::size_t n = mask.size();
    const int channels = arriving.moments.empty() ? 3 : 27;
    std::vector<float> source(n * channels, 0.0f);
    parallel_for(
        n,
        [&](std::size_t i) {
            if (!mask[i])
                return;
            for (int c = 0; c < channels; ++c) {
                const float light =
                    c < 3 ? arriving.fluence[c * n + i] / (4.0f * kPi)
                          : arriving.moments[(c - 3) * n + i] * sh_phase_factor(c / 3 - 1, medium.mean_cosine);
                source[i * channels + c] = medium.albedo_at(i)[c % 3] * light;
            }
        },
        4096);
    return source;
}

CoarseOperator::CoarseOperator(const ExtinctionPyramid& fine, int level, const LightingSettings& lighting,
                               const ScatteringSettings& scattering)
    : level_(level), medium_(coarse_medium(fine, level)), lighting_(lighting), alpha_(scattering.alpha) {
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
    if (scattering.solver == ScatteringSolver::RadianceCascades) {
        CascadeSettings settings;
        settings.side = scattering.cascade_side;
        cascades_ = std::make_unique<RadianceCascades>(*pyramid_, mask_, settings);
    } else {
        grid_ = build_lighting_grid(medium_, unit_, &weight_, automatic_levels(medium_));
    }
    factor_.assign(weight_.size(), 1.0f);
    if (lighting_.energy_balance)
        balance_nodes(fine);
}

std::uint64_t CoarseOperator::bytes() const {
    std::uint64_t sum =
        medium_.bytes() + pyramid_->bytes() + grid_.bytes() + weight_.size() * 13 + collision_.size() * 4;
    for (const auto& m : maps_.levels)
        sum += m.maps.size() * 2;
    return sum + (cascades_ ? cascades_->bytes() : 0);
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
    if (cascades_)
        for (const std::uint8_t m : mask_)
            unit.source.insert(unit.source.end(), 3, m ? 1.0f : 0.0f);
    for (int sweep = 0; sweep < kBalanceSweeps; ++sweep) {
        const Gathered gathered = gather(unit, costs, silent);
        for (std::size_t i : nodes) {
            const float expected = 4.0f * kPi * collision_[i * collision_numbers_];
            if (gathered.fluence[i] > 0.0f && expected > 0.0f)
                factor_[i] = std::clamp(factor_[i] * std::sqrt(expected / gathered.fluence[i]), kLeastFactor,
                                        1.0f / kLeastFactor);
        }
    }
}

Gathered CoarseOperator::gather(const ScatteredLight& lights, std::vector<LevelCost>& costs, Progress& progress) {
    Gathered out = cascades_ ? gather_by_cascades(lights) : gather_from_hierarchy(lights, costs, progress);
    const std::size_t n = factor_.size();
    for (auto* f : {&out.fluence, &out.moments})
        parallel_for(f->size() / n, [&](std::size_t plane) {
            for (std::size_t i = 0; i < n; ++i)
                (*f)[plane * n + i] *= mask_[i] ? factor_[i] : 0.0f;
        });
    return out;
}

Gathered CoarseOperator::gather_from_hierarchy(const ScatteredLight& lights, std::vector<LevelCost>& costs,
                                               Progress& progress) {
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
    // At every node: bounces multiply errors, and the lattice is small.
    const LatticeRequest request{&mask_, std::nullopt, directional, medium_.mean_cosine, false};
    Gathered out = gather_at_nodes(field, request, these, progress);
    if (costs.empty())
        costs = these;
    return out;
}

Gathered CoarseOperator::gather_by_cascades(const ScatteredLight& lights) {
    const int channels = lights.directional.empty() ? 3 : 27;
    std::vector<float> source = lights.source;
    for (std::size_t i = 0; i < source.size(); ++i)
        source[i] *= factor_[i / channels];
    return cascades_->gather(source, channels);
}

ScatteredLight restricted(const ScatteredLight& fine, const BrickLattice& fine_lattice, int levels) {
    ScatteredLight coarse;
    coarse.intensity = as_colours(splat_down(fine_lattice, flattened(fine.intensity), 3, levels));
    if (!fine.directional.empty())
        coarse.directional = splat_down(fine_lattice, fine.directional, 24, levels);
    return coarse;
}

ScatteredLight CoarseOperator::restricted(const ScatteredLight& fine, const BrickLattice& fine_lattice) const {
    ScatteredLight coarse = brisance::restricted(fine, fine_lattice, level_);
    if (cascades_) {
        const int channels = coarse.directional.empty() ? 3 : 27;
        coarse.source.assign(mask_.size() * channels, 0.0f);
        for (std::size_t i = 0; i < mask_.size(); ++i)
            for (int c = 0; c < channels && mask_[i]; ++c)
                coarse.source[i * channels + c] =
                    (c < 3 ? coarse.intensity[i][c] : coarse.directional[i * 24 + c - 3]) * kEmptied / least_weight_[i];
    }
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
    if (cascades_)
        next.source = scattered_source(medium_, arriving, mask_);
    return next;
}

ScatteredLight spread_to_fine(const ScatteredLight& coarse, const CoarseNodes& nodes, const Medium& fine) {
    const std::size_t n = fine.lattice.node_count();
    const CoarseSampler sampler{nodes.lattice, nodes.level};
    const bool directional = !coarse.directional.empty();
    const int channels = directional ? 27 : 3;
    // The source function is the light leaving per volume and extinction. Where a coarse node has no extinction, its
    // neighbours determine it.
    std::vector<std::vector<Rgb>> source(channels / 3, std::vector<Rgb>(n, Rgb(0.0f)));
    parallel_for(
        fine.lattice.brick_count(),
        [&](std::size_t b) {
            for (int k = 0; k < BrickLattice::kNodes; ++k) {
                const std::size_t i = b * BrickLattice::kNodes + k;
                float sum[27] = {}, mass = 0.0f;
                sampler.at(fine.lattice.first_node(b) + BrickLattice::node_in_brick(k), [&](std::size_t q, float w) {
                    if (!nodes.mask[q])
                        return;
                    mass += w;
                    for (int c = 0; c < channels && !coarse.source.empty(); ++c)
                        sum[c] += w * coarse.source[q * channels + c];
                    if (!coarse.source.empty())
                        return;
                    const float per_mass = w / nodes.unit_light[q];
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

ScatteredLight CoarseOperator::spread_to_fine(const ScatteredLight& coarse, const Medium& fine) const {
    CoarseNodes nodes{medium_.lattice, level_, mask_};
    // A node that sharpening has emptied has almost no weight: its quotient would be rounding.
    nodes.unit_light.resize(weight_.size());
    for (std::size_t i = 0; i < weight_.size(); ++i)
        nodes.unit_light[i] = std::max(weight_[i], least_weight_[i]);
    return brisance::spread_to_fine(coarse, nodes, fine);
}

}  // namespace brisance
