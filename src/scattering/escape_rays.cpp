#include "scattering/escape_rays.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/parallel.h"
#include "medium/phase.h"
#include "shadows/shadow_kernels.h"

namespace brisance {

namespace {

constexpr float kStep = 1.0f;  // [nodes]

}  // namespace

vec3 uniform_sphere_direction(double u, double v) {
    const double z = 1.0 - 2.0 * u;
    const double s = std::sqrt(std::max(0.0, 1.0 - z * z));
    const double angle = 2.0 * kPi * v;
    return vec3(s * std::cos(angle), s * std::sin(angle), z);
}

std::vector<std::size_t> systematic_picks(const std::vector<float>& density, std::size_t count) {
    const double sum = std::accumulate(density.begin(), density.end(), 0.0);
    std::vector<std::size_t> picks;
    double passed = 0.0;
    for (std::size_t i = 0; i < density.size(); ++i) {
        passed += density[i];
        while (picks.size() < count && passed > (picks.size() + 0.5) / count * sum)
            picks.push_back(i);
    }
    return picks;
}

EscapeRays::NodeBox EscapeRays::bounding_box(const Medium& medium) {
    const ivec3 low = medium.lattice.min_brick() * BrickLattice::kSize - medium.reference_node;
    return {vec3(low - 1), vec3(low + medium.lattice.brick_extent() * BrickLattice::kSize)};
}

float EscapeRays::exit_distance(const NodeBox& box, const vec3& p, const vec3& direction) {
    float t = 1e30f;
    for (int a = 0; a < 3; ++a)
        if (direction[a] != 0.0f)
            t = std::min(t, ((direction[a] > 0.0f ? box.high[a] : box.low[a]) - p[a]) / direction[a]);
    return std::max(t, 0.0f);
}

EscapeRays::EscapeRays(const ExtinctionPyramid& pyramid, const Occluders* occluders, std::size_t count)
    : pyramid_(pyramid), occluders_(occluders), box_(bounding_box(pyramid.medium())), padded_((count + 15) / 16 * 16) {
    for (auto* a : {&begin_, &end_})
        for (auto& v : *a)
            v.assign(padded_, 0.0f);
    length_.assign(padded_, 0.0f);
}

void EscapeRays::set(std::size_t ray, const vec3& from_nodes, const vec3& direction_local) {
    const vec3 nodes = pyramid_.medium().index_from_local * direction_local;
    length_[ray] = exit_distance(box_, from_nodes, nodes);
    if (occluders_)
        length_[ray] =
            occluders_->first_hit(pyramid_.medium().local_from_index * from_nodes, direction_local, length_[ray]);
    for (int a = 0; a < 3; ++a) {
        begin_[a][ray] = from_nodes[a];
        end_[a][ray] = from_nodes[a] + nodes[a] * length_[ray];
    }
}

template <class March>
std::vector<float> EscapeRays::for_runs(const March& march) const {
    std::vector<float> out(padded_);
    parallel_blocks(padded_, 1024, [&](std::size_t first, std::size_t last) {
        march(Segments{{&begin_[0][first], &begin_[1][first], &begin_[2][first]},
                       {&end_[0][first], &end_[1][first], &end_[2][first]},
                       &length_[first],
                       last - first},
              &out[first]);
    });
    return out;
}

std::vector<float> EscapeRays::collision_probabilities() const {
    const PackedExtinction extinction = pyramid_.view(0);
    return for_runs([&](const Segments& run, float* collided) {
        segment_optical_depths(extinction, run, kStep, collided);
        for (std::size_t i = 0; i < run.count; ++i)
            collided[i] = -std::expm1(-collided[i]);
    });
}

std::vector<float> EscapeRays::weighted_collisions(const PackedField& weight) const {
    const PackedExtinction extinction = pyramid_.view(0), weights = weight.view();
    return for_runs(
        [&](const Segments& run, float* sums) { segment_collisions(extinction, weights, run, kStep, sums); });
}

}  // namespace brisance
