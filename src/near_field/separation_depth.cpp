#include "near_field/separation_depth.h"

#include <algorithm>
#include <cmath>

namespace brisance {

namespace {

// Sums over the nodes of a box, for `channels` of values each.
class NodeSums {
public:
    NodeSums(const ivec3& low, const ivec3& high, int channels)
        : low_(low),
          size_(high - low + 1),
          channels_(channels),
          sums_(std::size_t(size_.x) * size_.y * size_.z * channels, 0.0) {}

    double& at(const ivec3& node, int channel) {
        const ivec3 r = node - low_;
        return sums_[((std::size_t(r.x) * size_.y + r.y) * size_.z + r.z) * channels_ + channel];
    }

    // With the node and the pointer to its values, in order.
    template <class Take>
    void for_each(const Take& take) const {
        for (std::size_t i = 0; i < sums_.size(); i += channels_) {
            const auto k = static_cast<int>(i / channels_);
            take(low_ + ivec3(k / (size_.y * size_.z), k / size_.z % size_.y, k % size_.z), &sums_[i]);
        }
    }

private:
    ivec3 low_, size_;
    int channels_;
    std::vector<double> sums_;
};

// Where the line from 0 to p crosses planes of nodes, and its ends, as parts of it.
std::vector<double> cuts_of(const dvec3& p) {
    std::vector<double> cuts{0.0, 1.0};
    for (int a = 0; a < 3; ++a)
        for (int k = 1; k < std::abs(p[a]); ++k)
            cuts.push_back(k / std::abs(p[a]));
    std::sort(cuts.begin(), cuts.end());
    return cuts;
}

void add_trilinear(NodeSums& sums, int channel, const dvec3& p, double weight) {
    const dvec3 base = glm::floor(p);
    const dvec3 f = p - base;
    for (int k = 0; k < 8; ++k) {
        const ivec3 d(k >> 2, k >> 1 & 1, k & 1);
        const double w = (d.x ? f.x : 1 - f.x) * (d.y ? f.y : 1 - f.y) * (d.z ? f.z : 1 - f.z);
        if (w > 1e-12)
            sums.at(ivec3(base) + d, channel) += w * weight;
    }
}

// Adds `scale` times the mean of the interpolant along the line from 0 to p.
void add_line(NodeSums& sums, int channel, const dvec3& p, double scale) {
    const double gauss = 0.5 / std::sqrt(3.0);
    const std::vector<double> cuts = cuts_of(p);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
        const double length = cuts[i + 1] - cuts[i];
        if (length < 1e-12)
            continue;
        const double middle = 0.5 * (cuts[i] + cuts[i + 1]);
        for (const double t : {middle - gauss * length, middle + gauss * length})
            add_trilinear(sums, channel, p * t, 0.5 * length * scale);
    }
}

}  // namespace

std::vector<LineShare> line_shares(const dvec3& p) {
    NodeSums sums(ivec3(glm::floor(glm::min(p, dvec3(0.0)))), ivec3(glm::floor(glm::max(p, dvec3(0.0)))) + 1, 1);
    add_line(sums, 0, p, 1.0);
    std::vector<LineShare> shares;
    sums.for_each([&](const ivec3& node, const double* share) {
        if (*share > 0.0)
            shares.push_back({node, *share});
    });
    return shares;
}

std::vector<ShiftedTap> shifted_taps(const ivec3& node, const mat3& local_from_index) {
    constexpr double kShift = 0.5;                              // [nodes]
    constexpr double kLeastLength = 0.01, kLeastChange = 0.03;  // of taps, over the spacing and over a shift by it
    NodeSums sums(glm::min(node, ivec3(0)) - 1, glm::max(node, ivec3(0)) + 2, 4);
    const dmat3 metres(local_from_index);
    add_line(sums, 0, dvec3(node), glm::length(metres * dvec3(node)));
    for (int a = 0; a < 3; ++a)
        for (const double side : {-1.0, 1.0}) {
            dvec3 p(node);
            p[a] += side * kShift;
            add_line(sums, 1 + a, p, side * glm::length(metres * p) / (2.0 * kShift));
        }
    const double spacing = std::cbrt(std::abs(glm::determinant(metres)));
    const dmat3 per_metre = glm::inverse(metres);
    std::vector<ShiftedTap> taps;
    sums.for_each([&](const ivec3& at, const double* of) {
        const dvec3 change(of[1], of[2], of[3]);
        if (of[0] > kLeastLength * spacing || glm::length(change) > kLeastChange * spacing)
            taps.push_back({at, static_cast<float>(of[0]), vec3(change * per_metre)});
    });
    return taps;
}

}  // namespace brisance
