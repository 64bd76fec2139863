#include "scattering/balance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/rng.h"
#include "gathering/escape_probability.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/lattice/node_key.h"
#include "medium/phase.h"
#include "scattering/escape_rays.h"

namespace brisance {

namespace {

constexpr std::size_t kBatches = 16;
constexpr double kGoldenRatio = 0.61803398874989484820;

std::vector<float> luminances(const std::vector<Rgb>& intensity) {
    std::vector<float> y;
    y.reserve(intensity.size());
    for (const Rgb& i : intensity)
        y.push_back(std::max(0.0f, luminance(i)));
    return y;
}

// Golden-ratio rotation of consecutive rays: well spread for any run of them.
vec3 ray_direction(std::size_t ray) {
    return uniform_sphere_direction(glm::fract(0.5 + ray * 0.7548776662466927),
                                    glm::fract(0.5 + ray * 0.5698402909980532));
}

// One ray from each of the picked nodes to the edge of the medium or a surface.
EscapeRays rays_from(const ExtinctionPyramid& pyramid, const Occluders* occluders,
                     const std::vector<std::size_t>& picks) {
    const Medium& medium = pyramid.medium();
    EscapeRays rays(pyramid, occluders, picks.size());
    parallel_for(
        picks.size(),
        [&](std::size_t r) {
            rays.set(r, vec3(medium.lattice.node(picks[r]) - medium.reference_node), ray_direction(r));
        },
        1024);
    return rays;
}

// The estimate by rays from `picks`, of which `collided` collides.
CollisionEstimate collision_estimate(const std::vector<Rgb>& intensity, std::span<const float> directional,
                                     const std::vector<std::size_t>& picks, const std::vector<float>& collided) {
    CollisionEstimate estimate;
    dvec3 hit[kBatches] = {}, emitted[kBatches] = {};
    for (std::size_t r = 0; r < picks.size(); ++r) {
        const std::size_t i = picks[r];
        const double y = luminance(intensity[i]);
        const dvec3 toward = directional_intensity(intensity, directional, i, ray_direction(r));
        hit[r % kBatches] += toward * (collided[r] / y);
        emitted[r % kBatches] += dvec3(intensity[i]) / y;
    }
    const dvec3 all_hit = std::accumulate(hit, hit + kBatches, dvec3(0.0)),
                all_emitted = std::accumulate(emitted, emitted + kBatches, dvec3(0.0));
    for (int c = 0; c < 3; ++c)
        if (all_emitted[c] > 0.0)
            estimate.fraction[c] = all_hit[c] / all_emitted[c];
    estimate.rays = picks.size();
    if (picks.size() < kBatches) {
        estimate.standard_error = 1.0;
        return estimate;
    }
    double square = 0.0;
    for (std::size_t b = 0; b < kBatches; ++b)
        square += std::pow(
            luminance(Rgb(hit[b])) / luminance(Rgb(emitted[b])) - luminance(Rgb(all_hit)) / luminance(Rgb(all_emitted)),
            2);
    estimate.standard_error = std::sqrt(square / (kBatches - 1.0) / kBatches);
    return estimate;
}

}  // namespace

CollisionEstimate estimate_collisions(const ExtinctionPyramid& pyramid, const std::vector<Rgb>& intensity,
                                      std::span<const float> directional, std::size_t rays) {
    const std::vector<std::size_t> picks = systematic_picks(luminances(intensity), rays);
    if (picks.empty())
        return {};
    return collision_estimate(intensity, directional, picks,
                              rays_from(pyramid, pyramid.occluders(), picks).collision_probabilities());
}

PartlyCollided estimate_collisions(const ExtinctionPyramid& pyramid, const std::vector<Rgb>& intensity,
                                   std::span<const float> directional, std::size_t rays,
                                   const std::vector<float>& part) {
    const std::vector<std::size_t> picks = systematic_picks(luminances(intensity), rays);
    if (picks.empty())
        return {};
    const EscapeRays from_lights = rays_from(pyramid, pyramid.occluders(), picks);
    const Medium& medium = pyramid.medium();
    const PackedField weight(medium.lattice, part, medium.reference_node);
    return {collision_estimate(intensity, directional, picks, from_lights.collision_probabilities()),
            collision_estimate(intensity, directional, picks, from_lights.weighted_collisions(weight))};
}

EscapeEstimate estimate_escape(const ExtinctionPyramid& pyramid, const std::vector<Rgb>& intensity,
                               std::span<const float> directional, const std::vector<float>& likelihood,
                               std::size_t rays) {
    const NodeWeights density = escape_density(intensity, likelihood);
    const double all = std::accumulate(density.begin(), density.end(), 0.0);
    const std::vector<std::size_t> picks = systematic_picks(density, rays);
    if (picks.size() < kBatches)
        return {};
    const std::vector<float> collided = rays_from(pyramid, nullptr, picks).collision_probabilities();
    dvec3 batches[kBatches] = {};
    for (std::size_t r = 0; r < picks.size(); ++r) {
        const double ray_stands_for = all / density[picks[r]] / double(picks.size());
        batches[r % kBatches] += directional_intensity(intensity, directional, picks[r], ray_direction(r)) *
                                 (ray_stands_for * (1.0 - collided[r]));
    }
    EscapeEstimate estimate;
    estimate.power = std::accumulate(batches, batches + kBatches, dvec3(0.0));
    const double mean = luminance(Rgb(estimate.power));
    double square = 0.0;
    for (const dvec3& b : batches)
        square += std::pow(luminance(Rgb(b)) * double(kBatches) - mean, 2);
    estimate.standard_error = mean > 0.0 ? std::sqrt(square / (kBatches - 1.0) / kBatches) / mean : 0.0;
    return estimate;
}

dvec3 directional_intensity(const std::vector<Rgb>& intensity, std::span<const float> directional, std::size_t node,
                            const vec3& direction) {
    if (directional.empty())
        return dvec3(intensity[node]);
    const auto basis = sh_basis(direction);
    Rgb higher_degrees(0.0f);
    for (int m = 0; m < kShMoments; ++m)
        for (int c = 0; c < 3; ++c)
            higher_degrees[c] += directional[(node * kShMoments + m) * 3 + c] * basis[m];
    return dvec3(intensity[node]) + dvec3(higher_degrees);
}

dvec3 collided_power(const Medium& medium, const std::vector<Rgb>& fluence) {
    return total(project_extinction_times(medium, fluence)) / (4.0 * double(kPi));
}

dvec3 collided_power(const Medium& medium, std::vector<Rgb> fluence, const std::vector<float>& share) {
    for (std::size_t i = 0; i < fluence.size(); ++i)
        fluence[i] *= share[i];
    return collided_power(medium, fluence);
}

dvec3 absorbed_power(const Medium& medium, std::vector<Rgb> fluence) {
    for (std::size_t i = 0; i < fluence.size(); ++i)
        fluence[i] *= Rgb(1.0f) - medium.albedo_at(i);
    return collided_power(medium, fluence);
}

std::vector<ivec3> nodes_of_vertex(FootprintPicker& picker, const ivec3& vertex, int level, int count) {
    std::vector<ivec3> nodes;
    if (level > 0)
        nodes = picker.pick(vertex, count);
    if (nodes.empty())
        nodes.push_back(vertex * (1 << level));
    return nodes;
}

std::vector<float> collision_probabilities(const ExtinctionPyramid& pyramid, const std::vector<ivec3>& vertices,
                                           int level, int directions, int numbers) {
    const Medium& medium = pyramid.medium();
    std::vector<float> probability(vertices.size() * numbers, 0.0f);
    const std::size_t batch = std::max<std::size_t>(1, (std::size_t{1} << 20) / directions);
    // Starts come in space order and directions in order of height: an odd stride parts the two.
    const auto start_of = [](std::size_t d, std::size_t starts) { return d * 27 % starts; };
    for (std::size_t first = 0; first < vertices.size(); first += batch) {
        const std::size_t count = std::min(batch, vertices.size() - first);
        EscapeRays escape(pyramid, pyramid.occluders(), count * directions);
        std::vector<vec3> escape_direction(count * directions);
        parallel_blocks(count, 256, [&](std::size_t begin, std::size_t end) {
            FootprintPicker picker(medium, medium.extinction, level);
            for (std::size_t k = begin; k < end; ++k) {
                const std::vector<ivec3> starts = nodes_of_vertex(picker, vertices[first + k], level, directions);
                Rng rng(Stream::EscapeRay, node_key(vertices[first + k]), 1);
                const double turn_u = rng.next(), turn_v = rng.next();
                for (int d = 0; d < directions; ++d) {
                    const std::size_t ray = k * directions + d;
                    escape_direction[ray] = uniform_sphere_direction(glm::fract((d + turn_u) / directions),
                                                                     glm::fract(turn_v + d * kGoldenRatio));
                    escape.set(ray, vec3(starts[start_of(d, starts.size())] - medium.reference_node),
                               escape_direction[ray]);
                }
            }
        });
        const std::vector<float> collided = escape.collision_probabilities();
        parallel_blocks(count, 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t ray = begin * directions; ray < end * directions; ++ray) {
                float* sums = &probability[(first + ray / directions) * numbers];
                const float share = collided[ray] / directions;
                sums[0] += share;
                if (numbers == 1)
                    continue;
                const auto basis = sh_basis(escape_direction[ray]);
                for (int m = 0; m < kShMoments; ++m)
                    sums[1 + m] += share * basis[m];
            }
        });
    }
    return probability;
}

}  // namespace brisance
