#include "smoke_box.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brisance::independent {

SmokeBox::SmokeBox(const Medium& medium)
    : index_from_world_(glm::inverse(medium.world_from_index)), mean_cosine_(medium.mean_cosine) {
    const std::size_t stored = medium.lattice.node_count();
    if (stored == 0)
        return;
    ivec3 high = low_ = medium.lattice.node(0);
    for (std::size_t i = 0; i < stored; ++i) {
        low_ = glm::min(low_, medium.lattice.node(i));
        high = glm::max(high, medium.lattice.node(i));
    }
    // One layer of zeros around: the fields fade to zero within one voxel of the outermost nodes.
    low_ -= 1;
    size_ = high + 2 - low_;
    const std::size_t all = std::size_t(size_.x) * size_.y * size_.z;
    extinction_.assign(all, 0.0);
    albedo_.assign(all, medium.albedo_nodes.empty() ? dvec3(medium.albedo) : dvec3(0.0));
    source_.assign(medium.source.empty() ? 0 : all, dvec3(0.0));
    emission_.assign(medium.emission.empty() ? 0 : all, dvec3(0.0));
    for (std::size_t i = 0; i < stored; ++i) {
        const ivec3 n = medium.lattice.node(i) - low_;
        const std::size_t k = (std::size_t(n.x) * size_.y + n.y) * size_.z + n.z;
        extinction_[k] = medium.extinction[i];
        if (!medium.albedo_nodes.empty())
            albedo_[k] = dvec3(medium.albedo_nodes[i]);
        if (!source_.empty())
            source_[k] = dvec3(medium.source[i]);
        if (!emission_.empty())
            emission_[k] = dvec3(medium.emission[i]);
    }
    majorant_ = *std::max_element(extinction_.begin(), extinction_.end());
}

bool SmokeBox::corners(const dvec3& p, Corners& c) const {
    const dvec3 index = dvec3(index_from_world_ * glm::dvec4(p, 1.0)) - dvec3(low_);
    const ivec3 base(glm::floor(index));
    if (base.x < 0 || base.y < 0 || base.z < 0 || base.x + 1 >= size_.x || base.y + 1 >= size_.y ||
        base.z + 1 >= size_.z)
        return false;
    const dvec3 f = index - dvec3(base);
    for (int k = 0; k < 8; ++k) {
        const int x = k & 1, y = k >> 1 & 1, z = k >> 2;
        c.node[k] = (std::size_t(base.x + x) * size_.y + base.y + y) * size_.z + base.z + z;
        c.weight[k] = (x ? f.x : 1.0 - f.x) * (y ? f.y : 1.0 - f.y) * (z ? f.z : 1.0 - f.z);
    }
    return true;
}

double SmokeBox::extinction(const dvec3& p) const {
    Corners c;
    double sum = 0.0;
    if (corners(p, c))
        for (int k = 0; k < 8; ++k)
            sum += c.weight[k] * extinction_[c.node[k]];
    return sum;
}

dvec3 SmokeBox::albedo(const dvec3& p) const {
    Corners c;
    dvec3 sum(0.0);
    if (corners(p, c))
        for (int k = 0; k < 8; ++k)
            sum += c.weight[k] * albedo_[c.node[k]];
    return sum;
}

dvec3 SmokeBox::emission(const dvec3& p) const {
    Corners c;
    if ((source_.empty() && emission_.empty()) || !corners(p, c))
        return dvec3(0.0);
    double extinction = 0.0;
    dvec3 source(0.0), direct(0.0);
    for (int k = 0; k < 8; ++k) {
        extinction += c.weight[k] * extinction_[c.node[k]];
        if (!source_.empty())
            source += c.weight[k] * source_[c.node[k]];
        if (!emission_.empty())
            direct += c.weight[k] * emission_[c.node[k]];
    }
    return extinction * source + direct;
}

bool SmokeBox::clip(const dvec3& origin, const dvec3& direction, double& begin, double& end) const {
    const dvec3 from = dvec3(index_from_world_ * glm::dvec4(origin, 1.0)) - dvec3(low_);
    const dvec3 along(index_from_world_ * glm::dvec4(direction, 0.0));
    begin = 0.0;
    end = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a) {
        const double wall = size_[a] - 1.0;
        if (along[a] == 0.0) {
            if (from[a] < 0.0 || from[a] > wall)
                return false;
            continue;
        }
        const double t0 = -from[a] / along[a], t1 = (wall - from[a]) / along[a];
        begin = std::max(begin, std::min(t0, t1));
        end = std::min(end, std::max(t0, t1));
    }
    return begin < end;
}

}  // namespace brisance::independent
