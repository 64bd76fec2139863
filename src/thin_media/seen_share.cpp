#include "thin_media/seen_share.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr int kRays = PointDepths::kRays;

struct Seen {
    double part = 0.0, all = 0.0;
};

// What is seen of a node whose optical depth from the eye is `depth`. It is seen from its near side on.
double seen_of_node(const Medium& medium, std::size_t node, float depth, float distance) {
    const float own = medium.extinction[node] * medium.spacing;
    const float angle = medium.spacing / std::max(distance, medium.spacing);
    return double(luminance(medium.albedo_at(node))) * std::exp(-std::max(0.0f, depth - 0.5f * own)) *
           -std::expm1(-own) * angle * angle;
}

// Of kRays successive nodes of a brick.
Seen seen_of_row(const Medium& medium, const PointDepths& depths, const std::vector<float>& part, const vec3& eye,
                 std::size_t first) {
    Seen seen;
    if (std::none_of(&medium.extinction[first], &medium.extinction[first] + kRays, [](float e) { return e > 0.0f; }))
        return seen;
    std::array<vec3, kRays> to;
    std::array<float, kRays> depth;
    for (int k = 0; k < kRays; ++k)
        to[k] = medium.local_of_node(medium.lattice.node(first + k));
    depths.between(eye, to.data(), depth.data());
    for (int k = 0; k < kRays; ++k) {
        const double s = seen_of_node(medium, first + k, depth[k], glm::distance(eye, to[k]));
        seen.part += part[first + k] * s;
        seen.all += s;
    }
    return seen;
}

}  // namespace

float seen_share(const Medium& medium, const PointDepths& depths, const std::vector<float>& part, const vec3& eye) {
    if (std::none_of(part.begin(), part.end(), [](float p) { return p > 0.0f; }))
        return 0.0f;
    std::vector<Seen> of_brick(medium.lattice.brick_count());
    parallel_for(
        of_brick.size(),
        [&](std::size_t b) {
            for (int n = 0; n < BrickLattice::kNodes; n += kRays) {
                const Seen s = seen_of_row(medium, depths, part, eye, b * BrickLattice::kNodes + n);
                of_brick[b].part += s.part;
                of_brick[b].all += s.all;
            }
        },
        8);
    Seen sum;
    for (const Seen& s : of_brick) {
        sum.part += s.part;
        sum.all += s.all;
    }
    return sum.all > 0.0 ? float(sum.part / sum.all) : 0.0f;
}

}  // namespace brisance
