#include "scattering/balance.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "core/rng.h"
#include "gathering/escape_probability.h"
#include "lighting_grid/footprint.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/phase.h"
#include "shadows/shadow_kernels.h"

namespace brisance {

namespace {

constexpr std::size_t kBatches = 16;
constexpr double kGoldenRatio = 0.61803398874989484820;

vec3 sphere_direction(double u, double v) {
    const double z = 1.0 - 2.0 * u;
    const double s = std::sqrt(std::max(0.0, 1.0 - z * z));
    const double angle = 2.0 * kPi * v;
    return vec3(s * std::cos(angle), s * std::sin(angle), z);
}

// The medium's bounding box in nodes from the reference, one node wider.
struct NodeBox {
    vec3 low, high;
};

NodeBox bounding_box(const Medium& medium) {
    const ivec3 low = medium.lattice.min_brick() * BrickLattice::kSize - medium.reference_node;
    return {vec3(low - 1), vec3(low + medium.lattice.brick_extent() * BrickLattice::kSize)};
}

// Distance [m] from p along `direction` [nodes per metre] to the box's wall.
float exit_distance(const NodeBox& box, const vec3& p, const vec3& direction) {
    float t = 1e30f;
    for (int a = 0; a < 3; ++a)
        if (direction[a] != 0.0f)
            t = std::min(t, ((direction[a] > 0.0f ? box.high[a] : box.low[a]) - p[a]) / direction[a]);
    return std::max(t, 0.0f);
}

// Rays to the edge of the medium, packed for the marching kernel.
class ExitRays {
public:
    // `occluders`: where rays end too, or null.
    ExitRays(const ExtinctionPyramid& pyramid, const Occluders* occluders, std::size_t count)
        : pyramid_(pyramid),
          occluders_(occluders),
          box_(bounding_box(pyramid.medium())),
          padded_((count + 15) / 16 * 16) {
        for (auto* a : {&begin_, &end_})
            for (auto& v : *a)
                v.assign(padded_, 0.0f);
        metres_.assign(padded_, 0.0f);
    }

    void set(std::size_t i, const vec3& from_nodes, const vec3& direction_local) {
        const vec3 nodes = pyramid_.medium().index_from_local * direction_local;
        metres_[i] = exit_distance(box_, from_nodes, nodes);
        if (occluders_)
            metres_[i] =
                occluders_->first_hit(pyramid_.medium().local_from_index * from_nodes, direction_local, metres_[i]);
        for (int a = 0; a < 3; ++a) {
            begin_[a][i] = from_nodes[a];
            end_[a][i] = from_nodes[a] + nodes[a] * metres_[i];
        }
    }

    // What collides on the way: 1 - transmittance.
    std::vector<float> march(float step_nodes) const {
        std::vector<float> depth(padded_);
        const PackedExtinction view = pyramid_.view(0);
        parallel_blocks(padded_, 1024, [&](std::size_t first, std::size_t last) {
            const float* begin[3] = {&begin_[0][first], &begin_[1][first], &begin_[2][first]};
            const float* end[3] = {&end_[0][first], &end_[1][first], &end_[2][first]};
            segment_optical_depths(view, begin, end, &metres_[first], step_nodes, last - first, &depth[first]);
            for (std::size_t i = first; i < last; ++i)
                depth[i] = -std::expm1(-depth[i]);
        });
        return depth;
    }

private:
    const ExtinctionPyramid& pyramid_;
    const Occluders* occluders_;
    NodeBox box_;
    std::size_t padded_;
    std::vector<float> begin_[3], end_[3], metres_;
};

std::uint64_t vertex_key(const ivec3& v) {
    const auto part = [](int c) { return static_cast<std::uint64_t>(static_cast<std::uint32_t>(c) & 0x1fffffu); };
    return part(v.x) << 42 | part(v.y) << 21 | part(v.z);
}

std::vector<float> luminances(const std::vector<Rgb>& intensity) {
    std::vector<float> y;
    for (const Rgb& i : intensity)
        y.push_back(std::max(0.0f, luminance(i)));
    return y;
}

// Node index of each of `rays` systematic picks in proportion to `density`.
std::vector<std::size_t> pick_nodes(const std::vector<float>& density, std::size_t rays) {
    const double sum = std::accumulate(density.begin(), density.end(), 0.0);
    std::vector<std::size_t> picks;
    double passed = 0.0;
    for (std::size_t i = 0; i < density.size(); ++i) {
        passed += density[i];
        while (picks.size() < rays && passed > (picks.size() + 0.5) / rays * sum)
            picks.push_back(i);
    }
    return picks;
}

// Golden-ratio rotation of consecutive rays: well spread for any run of them.
vec3 ray_direction(std::size_t ray) {
    return sphere_direction(std::fmod(0.5 + ray * 0.7548776662466927, 1.0),
                            std::fmod(0.5 + ray * 0.5698402909980532, 1.0));
}

Rgb directional_part(const float* coefficients, const std::array<float, kShMoments>& basis) {
    Rgb sum(0.0f);
    for (int m = 0; m < kShMoments; ++m)
        for (int c = 0; c < 3; ++c)
            sum[c] += coefficients[3 * m + c] * basis[m];
    return sum;
}

// One ray from each of the picked nodes to the edge of the medium or a surface: the part that collides.
std::vector<float> collisions_from(const ExtinctionPyramid& pyramid, const Occluders* occluders,
                                   const std::vector<std::size_t>& picks) {
    const Medium& medium = pyramid.medium();
    ExitRays exits(pyramid, occluders, picks.size());
    parallel_for(
        picks.size(),
        [&](std::size_t r) {
            const std::size_t i = picks[r];
            const ivec3 node = medium.lattice.node(i);
            exits.set(r, vec3(node - medium.reference_node), ray_direction(r));
        },
        1024);
    return exits.march(1.0f);
}

// What node i sends along ray r [W/sr].
dvec3 sent(const std::vector<Rgb>& intensity, std::span<const float> directional, std::size_t i, std::size_t r) {
    dvec3 toward(intensity[i]);
    if (!directional.empty())
        toward += dvec3(directional_part(&directional[i * 3 * kShMoments], sh_basis(ray_direction(r))));
    return toward;
}

}  // namespace

CollisionEstimate estimate_collisions(const ExtinctionPyramid& pyramid, const std::vector<Rgb>& intensity,
                                      std::span<const float> directional, std::size_t rays) {
    CollisionEstimate estimate;
    const std::vector<std::size_t> picks = pick_nodes(luminances(intensity), rays);
    if (picks.empty())
        return estimate;
    const std::vector<float> collided = collisions_from(pyramid, pyramid.occluders(), picks);
    dvec3 hit[kBatches] = {}, emitted[kBatches] = {};
    for (std::size_t r = 0; r < picks.size(); ++r) {
        const std::size_t i = picks[r];
        const double y = luminance(intensity[i]);
        const dvec3 toward = sent(intensity, directional, i, r);
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

EscapeEstimate estimate_escape(const ExtinctionPyramid& pyramid, const std::vector<Rgb>& intensity,
                               std::span<const float> directional, const std::vector<float>& likelihood,
                               std::size_t rays) {
    const NodeWeights density = escape_density(intensity, likelihood);
    const double all = std::accumulate(density.begin(), density.end(), 0.0);
    const std::vector<std::size_t> picks = pick_nodes(density, rays);
    if (picks.size() < kBatches)
        return {};
    const std::vector<float> collided = collisions_from(pyramid, nullptr, picks);
    dvec3 batches[kBatches] = {};
    for (std::size_t r = 0; r < picks.size(); ++r) {
        const double ray_stands_for = all / density[picks[r]] / double(picks.size());
        batches[r % kBatches] += sent(intensity, directional, picks[r], r) * (ray_stands_for * (1.0 - collided[r]));
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

dvec3 collided(const Medium& medium, const std::vector<Rgb>& fluence) {
    return total(project_extinction_times(medium, fluence)) / (4.0 * double(kPi));
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
        ExitRays exits(pyramid, pyramid.occluders(), count * directions);
        std::vector<vec3> way(count * directions);
        parallel_blocks(count, 256, [&](std::size_t begin, std::size_t end) {
            FootprintPicker picker(medium, medium.extinction, level);
            for (std::size_t k = begin; k < end; ++k) {
                const std::vector<ivec3>& starts = picker.pick(vertices[first + k], directions);
                Rng rng(Stream::EscapeRay, vertex_key(vertices[first + k]), 1);
                const double turn_u = rng.next(), turn_v = rng.next();
                for (std::size_t d = 0; d < starts.size(); ++d) {
                    const std::size_t ray = k * directions + d;
                    way[ray] = sphere_direction(std::fmod((d + turn_u) / directions, 1.0),
                                                std::fmod(turn_v + d * kGoldenRatio, 1.0));
                    exits.set(ray, vec3(starts[start_of(d, starts.size())] - medium.reference_node), way[ray]);
                }
            }
        });
        const std::vector<float> collided = exits.march(1.0f);
        parallel_blocks(count, 256, [&](std::size_t begin, std::size_t end) {
            for (std::size_t ray = begin * directions; ray < end * directions; ++ray) {
                float* sums = &probability[(first + ray / directions) * numbers];
                const float share = collided[ray] / directions;
                sums[0] += share;
                if (numbers == 1)
                    continue;
                const auto basis = sh_basis(way[ray]);
                for (int m = 0; m < kShMoments; ++m)
                    sums[1 + m] += share * basis[m];
            }
        });
    }
    return probability;
}

}  // namespace brisance
