#include "gathering/near_depth.h"

#include <array>
#include <cmath>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr int kMargin = 2;  // [nodes]
constexpr int kWide = 2 * kMargin + 1, kTaps = kWide * kWide * kWide;

struct Tap {
    ivec3 offset;
    float length;  // [m]
};

// The mean over directions of a line's integral over each node's trilinear hat.
std::vector<Tap> taps_around(const mat3& local_from_index, float reach) {
    constexpr int kDirections = 512, kSteps = 16;
    constexpr double kGoldenAngle = 2.39996322972865332;
    const mat3 index_from_local = glm::inverse(local_from_index);
    std::array<double, kTaps> sum{};
    const double weight = double(reach) / (double(kDirections) * kSteps);
    for (int d = 0; d < kDirections; ++d) {
        const double z = 1.0 - (2.0 * d + 1.0) / kDirections, s = std::sqrt(1.0 - z * z);
        const vec3 direction(s * std::cos(d * kGoldenAngle), s * std::sin(d * kGoldenAngle), z);
        for (int k = 0; k < kSteps; ++k) {
            const vec3 p = glm::clamp(index_from_local * (direction * (reach * (float(k) + 0.5f) / kSteps)),
                                      vec3(-float(kMargin)), vec3(float(kMargin) - 1e-4f));
            const ivec3 low(glm::floor(p));
            const vec3 part = p - vec3(low);
            for (int c = 0; c < 8; ++c) {
                const ivec3 side(c >> 2, c >> 1 & 1, c & 1), o = low + side + kMargin;
                double w = weight;
                for (int a = 0; a < 3; ++a)
                    w *= side[a] ? part[a] : 1.0f - part[a];
                sum[std::size_t((o.x * kWide + o.y) * kWide + o.z)] += w;
            }
        }
    }
    std::vector<Tap> taps;
    for (int i = 0; i < kTaps; ++i)
        if (sum[std::size_t(i)] > 0.0)
            taps.push_back(
                {ivec3(i / (kWide * kWide), i / kWide % kWide, i % kWide) - kMargin, float(sum[std::size_t(i)])});
    return taps;
}

}  // namespace

std::vector<float> near_depths(const BrickLattice& lattice, const std::vector<float>& extinction,
                               const mat3& local_from_index, float reach) {
    constexpr int kBox = BrickLattice::kSize + 2 * kMargin;
    const std::vector<Tap> taps = taps_around(local_from_index, reach);
    std::vector<float> depth(lattice.node_count());
    parallel_for(
        lattice.brick_count(),
        [&](std::size_t b) {
            std::array<float, kBox * kBox * kBox> box;
            copy_box(lattice, extinction, 1, lattice.first_node(b) - kMargin, ivec3(kBox), box);
            for (int k = 0; k < BrickLattice::kNodes; ++k) {
                const ivec3 p = BrickLattice::node_in_brick(k) + kMargin;
                const float* const here = &box[std::size_t((p.x * kBox + p.y) * kBox + p.z)];
                float sum = 0.0f;
                for (const Tap& tap : taps)
                    sum += tap.length * here[(tap.offset.x * kBox + tap.offset.y) * kBox + tap.offset.z];
                depth[b * BrickLattice::kNodes + std::size_t(k)] = sum;
            }
        },
        8);
    return depth;
}

}  // namespace brisance
