#include "medium_lighting/adaptive_gather.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/parallel.h"
#include "gathering/light_roots.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/phase.h"
#include "medium/voxel_size.h"
#include "scattering/balance.h"
#include "scattering/multiple_scattering.h"

namespace brisance {

namespace {

// The part of the error allowed that the interpolation of one node may have: errors of the nodes along a ray add up as
// random ones do.
constexpr float kShare = 0.5f;

// Light changes from a level to the next finer one by about this part of what it changed by before.
constexpr float kNextChange = 0.5f;

// Radiance per unit albedo that node `i` of `n` scatters toward the camera, as luminance.
float scattered_radiance(const Gathered& g, std::size_t i, std::size_t n) {
    const std::vector<float>& field = g.scattered.empty() ? g.fluence : g.scattered;
    const float unit = g.scattered.empty() ? 1.0f / (4.0f * kPi) : 1.0f;
    return unit * luminance(Rgb(field[i], field[n + i], field[2 * n + i]));
}

class Refinement {
public:
    Refinement(const LitLattice& lattice, float share, const LatticeRequest& request, const LevelLights& lights)
        : lattice_(lattice),
          allowed_(kShare * lattice.interpolation_error(share) / share),
          request_(request),
          lights_(lights) {
        if (allowed_ > 0.0f)
            levels_ = &lattice.coarser_levels();
    }

    AdaptiveLight run(nlohmann::ordered_json& detail) {
        int level = levels_ ? static_cast<int>(levels_->size()) : 0;
        Gathered light = gather_all(level);
        auto counts = nlohmann::ordered_json::array({{{"level", level}, {"nodes", count(needed(level))}}});
        // Of the source functions, from the next coarser level to this one. Of the coarsest, all is new.
        std::vector<float> change = level > 0 ? sources(level, light) : std::vector<float>{};
        for (; level > 0; --level) {
            const std::vector<float> weight = refinement_weights(level, light, change);
            light = refine(level - 1, light, weight, change, counts);
        }
        detail["lit_nodes"] = counts;
        return {std::move(light), std::move(gathered_), std::move(conserving_)};
    }

private:
    const LitLevel& at(int level) const { return (*levels_)[level - 1]; }
    const BrickLattice& nodes(int level) const {
        return level == 0 ? lattice_.medium().lattice : at(level).medium.lattice;
    }
    const std::vector<std::uint8_t>& needed(int level) const {
        return level == 0 ? lattice_.needed() : at(level).needed;
    }
    static std::size_t count(const std::vector<std::uint8_t>& mask) {
        return std::size_t(std::count_if(mask.begin(), mask.end(), [](std::uint8_t m) { return m != 0; }));
    }

    GatherTarget target(int level, const std::vector<std::uint8_t>& mask, bool sparse) const {
        LatticeRequest request = request_;
        request.needed = &mask;
        if (level > 0 || sparse)
            request.own_share = 1.0f;
        return {level, level == 0 ? lattice_.pyramid() : *at(level).pyramid, request, sparse};
    }

    // At all needed nodes.
    Gathered gather_all(int level) const {
        const GatherTarget all = target(level, needed(level), false);
        Gathered light = lights_.gather(all);
        prepare_interpolation(nodes(level), needed(level), light);
        if (level > 0)
            lights_.balance(all, light);
        return light;
    }

    // Root mean square over what the camera sees.
    static float brightness(const LitLevel& l, const std::vector<float>& radiance) {
        double sum = 0.0, weights = 0.0;
        for (std::size_t i = 0; i < l.visible.size(); ++i) {
            sum += double(l.visible[i]) * radiance[i] * radiance[i];
            weights += l.visible[i];
        }
        return weights > 0.0 ? static_cast<float>(std::sqrt(sum / weights)) : 0.0f;
    }

    static float source(const LitLevel& l, const Gathered& light, std::size_t i) {
        return luminance(l.medium.albedo_at(i)) * scattered_radiance(light, i, l.needed.size());
    }

    std::vector<float> sources(int level, const Gathered& light) const {
        const LitLevel& l = at(level);
        std::vector<float> out(l.needed.size(), 0.0f);
        parallel_for(
            out.size(), [&](std::size_t i) { out[i] = l.needed[i] ? source(l, light, i) : 0.0f; }, 4096);
        return out;
    }

    // Per node of the level, how much of the light gathered at the next finer level counts there, in [0, 1].
    std::vector<float> refinement_weights(int level, const Gathered& light, const std::vector<float>& change) const {
        const LitLevel& l = at(level);
        const std::vector<float> radiance = radiance_through_nodes(l, sources(level, light), lattice_.input().eye);
        const float typical = brightness(l, radiance);
        std::vector<float> error = estimated_errors(l, light);
        for (std::size_t i = 0; i < error.size(); ++i)
            error[i] = std::max(error[i], kNextChange * change[i]);
        std::vector<float> weight(error.size(), 0.0f);
        parallel_for(
            weight.size(),
            [&](std::size_t i) {
                // Between the pixel's own radiance and the picture's: dark parts count more than in the sum of squares.
                const float allowed = allowed_ * std::sqrt(radiance[i] * typical);
                if (!l.needed[i] || !(allowed > 0.0f))
                    return;
                const float part = l.importance[i] * largest_around(l, error, i) / allowed;
                const bool beside = l.importance[i] > 0.0f && beside_surface(l, i);
                weight[i] = beside ? 1.0f : glm::smoothstep(0.5f, 1.0f, part);
            },
            4096);
        return weight;
    }

    // Whether a surface may part the node from some node interpolated from it.
    static bool beside_surface(const LitLevel& l, std::size_t i) {
        const Occluders* const surfaces = l.pyramid->occluders();
        return surfaces &&
               surfaces->any_within(l.medium.local_of_node(l.medium.lattice.node(i)), longest_diagonal(l.medium));
    }

    // A quarter of the difference between a node and the interpolant through the even nodes around it.
    static std::vector<float> estimated_errors(const LitLevel& l, const Gathered& light) {
        const BrickLattice& nodes = l.medium.lattice;
        std::vector<float> error(l.needed.size(), 0.0f);
        parallel_for(
            nodes.brick_count(),
            [&](std::size_t b) {
                for (int k = 0; k < BrickLattice::kNodes; ++k) {
                    const std::size_t i = b * BrickLattice::kNodes + k;
                    if (!l.needed[i])
                        continue;
                    const ivec3 node = nodes.node(i), odd = node & 1;
                    if (odd == ivec3(0))
                        continue;
                    float sum = 0.0f, weights = 0.0f;
                    for (int c = 0; c < 8; ++c) {
                        const ivec3 side(c >> 2, c >> 1 & 1, c & 1);
                        if (glm::any(glm::greaterThan(side, odd)))
                            continue;
                        const std::int64_t j = nodes.find_node(node + odd * (2 * side - 1));
                        if (j >= 0 && l.needed[j]) {
                            sum += source(l, light, std::size_t(j));
                            weights += 1.0f;
                        }
                    }
                    if (weights > 0.0f)
                        error[i] = 0.25f * std::abs(source(l, light, i) - sum / weights);
                }
            },
            4);
        return error;
    }

    static float largest_around(const LitLevel& l, const std::vector<float>& error, std::size_t i) {
        const ivec3 node = l.medium.lattice.node(i);
        float largest = 0.0f;
        for (int k = 0; k < 27; ++k) {
            const std::int64_t j = l.medium.lattice.find_node(node + ivec3(k / 9, k / 3 % 3, k % 3) - 1);
            if (j >= 0)
                largest = std::max(largest, error[j]);
        }
        return largest;
    }

    // Light of the next coarser level at the nodes of this one, mixed with light gathered here where it has weight.
    // `change`: replaced by that of this level's source functions.
    Gathered refine(int level, Gathered& coarse, const std::vector<float>& coarse_weight, std::vector<float>& change,
                    nlohmann::ordered_json& counts) {
        const std::size_t n = nodes(level).node_count();
        const std::vector<float> collisions = collisions_around(level + 1, coarse);
        Gathered out;
        out.resize(n, !coarse.scattered.empty(), !coarse.moments.empty());
        std::vector<float> weight(n, 0.0f);
        interpolate(level, coarse, coarse_weight, out, weight);
        keep_collisions(level, collisions, out);
        std::vector<std::uint8_t> mask(n);
        for (std::size_t i = 0; i < n; ++i)
            mask[i] = weight[i] > 0.0f;
        const std::size_t gathered = count(mask);
        counts.push_back({{"level", level}, {"nodes", gathered}});
        change = level > 0 ? sources(level, out) : std::vector<float>{};
        gathered_.power = dvec3(0.0);
        if (gathered > 0) {
            Gathered fine = lights_.gather(target(level, mask, true));
            mix(level, mask, weight, fine, out);
        }
        for (std::size_t i = 0; i < change.size(); ++i)
            change[i] = needed(level)[i] ? std::abs(change[i] - source(at(level), out, i)) : 0.0f;
        gathered_.share = std::move(weight);
        return out;
    }

    // Calls `take` with each needed node of the level and the coarser nodes and weights that interpolate there.
    template <class Take>
    void for_each_interpolated(int level, const Take& take) const {
        const BrickLattice& fine = nodes(level);
        const CoarseSampler sampler{nodes(level + 1), 1};
        parallel_for(
            fine.brick_count(),
            [&](std::size_t b) {
                for (int k = 0; k < BrickLattice::kNodes; ++k)
                    if (const std::size_t i = b * BrickLattice::kNodes + k; needed(level)[i])
                        take(i, [&](const auto& add) {
                            sampler.at(fine.first_node(b) + BrickLattice::node_in_brick(k), add);
                        });
            },
            4);
    }

    // Turns `coarse` into what is interpolated (gathering/light_roots.h).
    void interpolate(int level, Gathered& coarse, const std::vector<float>& coarse_weight, Gathered& out,
                     std::vector<float>& weight) const {
        constexpr std::size_t kMostPlanes = 3 + 3 + 24;
        const std::size_t below = coarse_weight.size(), lights = planes_of_light(coarse, below);
        take_roots(coarse, below);
        const auto from = coarse.planes(), to = out.planes();
        for_each_interpolated(level, [&](std::size_t i, const auto& each) {
            std::array<float, kMostPlanes> light{};
            each([&](std::size_t j, float w) {
                for (std::size_t c = 0; c < from.size(); ++c)
                    light[c] += w * from[c][j];
                weight[i] += w * coarse_weight[j];
            });
            raise_roots(std::span(light).first(from.size()), lights);
            for (std::size_t c = 0; c < from.size(); ++c)
                to[c][i] = light[c];
        });
    }

    const Medium& medium(int level) const { return level == 0 ? lattice_.medium() : at(level).medium; }

    // Luminance that collides around each node, of light that conserves energy with the factors found so far.
    std::vector<float> collisions_around(int level, const Gathered& light) const {
        std::vector<Rgb> fluence = fluence_at_nodes(light, needed(level));
        for (std::size_t i = 0; i < conserving_.size(); ++i)
            fluence[i] *= conserving_[i];
        fluence = project_extinction_times(medium(level), fluence);
        std::vector<float> collisions(fluence.size());
        std::transform(fluence.begin(), fluence.end(), collisions.begin(), luminance);
        return collisions;
    }

    // Carries the factors on to the nodes of this level, such that as much collides around every coarser node as there:
    // `wanted`.
    void keep_collisions(int level, const std::vector<float>& wanted, const Gathered& out) {
        std::vector<float> factor = std::move(conserving_);
        if (factor.empty())
            factor.assign(wanted.size(), 1.0f);
        interpolate_factors(level, factor);
        const std::vector<float> found = splat_down(nodes(level), collisions_around(level, out), 1, 1);
        for (std::size_t i = 0; i < wanted.size(); ++i)
            if (found[i] > 0.0f && wanted[i] > 0.0f)
                factor[i] *= std::clamp(wanted[i] / found[i], 0.2f, 5.0f);
        interpolate_factors(level, factor);
    }

    void interpolate_factors(int level, const std::vector<float>& coarse) {
        conserving_.assign(needed(level).size(), 1.0f);
        for_each_interpolated(level, [&](std::size_t i, const auto& each) {
            float sum = 0.0f, weights = 0.0f;
            each([&](std::size_t j, float w) {
                sum += w * coarse[j];
                weights += w;
            });
            if (weights > 0.0f)
                conserving_[i] = sum / weights;
        });
    }

    // Collisions at nodes of this level after gathering there, over those of the interpolated light before. Nodes that
    // are not gathered are given the same ratio. It is 1 where none are.
    float collisions_gained(int level, const std::vector<float>& weight, const Gathered& fine,
                            const Gathered& out) const {
        const std::vector<Rgb> gathered = fluence_at_nodes(fine, needed(level)),
                               interpolated = fluence_at_nodes(out, needed(level));
        const std::vector<Rgb> per_fluence =
            project_extinction_times(medium(level), std::vector<Rgb>(weight.size(), Rgb(1.0f)));
        double before = 0.0, after = 0.0;
        for (std::size_t i = 0; i < weight.size(); ++i) {
            const float was = conserving_[i] * luminance(interpolated[i]);
            before += double(per_fluence[i].x) * was;
            after += double(per_fluence[i].x) * glm::mix(was, luminance(gathered[i]), weight[i]);
        }
        return before > 0.0 ? static_cast<float>(after / before) : 1.0f;
    }

    // Sharpened among its neighbours, which have the coarser level's light where none was gathered.
    void mix(int level, const std::vector<std::uint8_t>& mask, const std::vector<float>& weight, Gathered& fine,
             Gathered& out) {
        const std::size_t n = mask.size();
        const auto from = fine.planes(), to = out.planes();
        parallel_for(from.size(), [&](std::size_t c) {
            for (std::size_t i = 0; i < n; ++i)
                if (!mask[i])
                    from[c][i] = to[c][i];
        });
        prepare_interpolation(nodes(level), needed(level), fine);
        gathered_.power = collided_power(medium(level), fluence_at_nodes(fine, needed(level)), weight);
        const float gained = collisions_gained(level, weight, fine, out);
        parallel_for(from.size(), [&](std::size_t c) {
            for (std::size_t i = 0; i < n; ++i)
                if (mask[i])
                    to[c][i] += weight[i] * (from[c][i] - to[c][i]);
        });
        for (std::size_t i = 0; i < n; ++i)
            conserving_[i] = glm::mix(gained * conserving_[i], 1.0f, weight[i]);
    }

    const LitLattice& lattice_;
    float allowed_;                                  // error of a node's light, relative; 0: none is interpolated
    const std::vector<LitLevel>* levels_ = nullptr;  // to gather on first; null: none
    LatticeRequest request_;
    const LevelLights& lights_;
    GatheredPart gathered_;  // at the level lit last, as of AdaptiveLight
    std::vector<float> conserving_;
};

}  // namespace

AdaptiveLight gather_adaptively(const LitLattice& lattice, float share, const LatticeRequest& request,
                                const LevelLights& lights, nlohmann::ordered_json& detail) {
    return Refinement(lattice, share, request, lights).run(detail);
}

}  // namespace brisance
