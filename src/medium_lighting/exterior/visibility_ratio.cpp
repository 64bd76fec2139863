#include "medium_lighting/exterior/visibility_ratio.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gathering/escape_probability.h"

namespace brisance {

namespace {

// Voxels along a cluster's side: the tree chooses between clusters by their distance, inside all voxels count alike.
constexpr int kClusterShift = 3;
// Enough for clusters of a small explosion, and little to search.
constexpr std::size_t kNodesOfFront = 512, kPointsPerNode = 4;

std::uint64_t key_of(const ivec3& node) {
    const auto part = [](int i) { return static_cast<std::uint64_t>((i >> kClusterShift) + (1 << 20)); };
    return part(node.x) << 42 | part(node.y) << 21 | part(node.z);
}

}  // namespace

VisibilityRatio::VisibilityRatio(const Medium& medium, const PointDepths& depths, const std::vector<Rgb>& intensity,
                                 const NodeWeights& escape)
    : medium_(medium), depths_(depths), tree_({}) {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> lit;
    for (std::size_t i = 0; i < intensity.size(); ++i)
        if (luminance(intensity[i]) > 0.0f)
            lit.emplace_back(key_of(medium.lattice.node(i)), static_cast<std::uint32_t>(i));
    std::sort(lit.begin(), lit.end());
    const NodeWeights density = escape_density(intensity, escape);
    std::vector<LightBounds> bounds;
    for (std::size_t i = 0; i < lit.size(); ++i) {
        const std::uint32_t node = lit[i].second;
        const dvec3 p(medium.local_of_node(medium.lattice.node(node)));
        const float weight = density[node];
        if (i == 0 || lit[i].first != lit[i - 1].first) {
            clusters_.push_back({static_cast<std::uint32_t>(i), 0.0f});
            bounds.push_back({p, p, {0, 0, 1}, std::numbers::pi, 0.5 * std::numbers::pi, 0.0, false});
        }
        bounds.back().low = glm::min(bounds.back().low, p);
        bounds.back().high = glm::max(bounds.back().high, p);
        bounds.back().intensity += weight;
        clusters_.back().sum += weight;
        nodes_.push_back(node);
        passed_.push_back(clusters_.back().sum);
        per_weight_.push_back(luminance(intensity[node]) / weight);
    }
    clusters_.push_back({static_cast<std::uint32_t>(lit.size()), 0.0f});
    tree_ = LightTree(bounds);
}

// A voxel in proportion to its weight.
std::size_t VisibilityRatio::voxel_in(std::size_t cluster, Rng& rng) const {
    const auto begin = passed_.begin() + clusters_[cluster].first, end = passed_.begin() + clusters_[cluster + 1].first;
    const auto found = std::min(std::upper_bound(begin, end, rng.next() * clusters_[cluster].sum), end - 1);
    return static_cast<std::size_t>(found - passed_.begin());
}

vec3 VisibilityRatio::point_in(std::size_t voxel, Rng& rng) const {
    const float x = rng.next(), y = rng.next(), z = rng.next();
    return medium_.local_of_node(medium_.lattice.node(nodes_[voxel])) +
           medium_.local_from_index * (vec3(x, y, z) - 0.5f);
}

// A front of n nodes saves log2(n) branches of every draw, and costs about as much as 2 n branches.
LightFront VisibilityRatio::around(const LitPoint& middle, std::size_t points) const {
    return LightFront(tree_, middle, std::clamp<std::size_t>(points / kPointsPerNode, 1, kNodesOfFront));
}

VisibilityRatio::Targets VisibilityRatio::choose(const LightFront& around, const LitPoint& point, double shift,
                                                 Rng& rng) const {
    Targets targets;
    for (int k = 0; k < kDraws; ++k) {
        const auto choice = around.choose(point, (k + shift) / kDraws);
        if (!choice)
            continue;
        const std::size_t voxel = voxel_in(choice->light, rng);
        targets[k] = {point_in(voxel, rng),
                      clusters_[choice->light].sum * per_weight_[voxel] / float(choice->probability)};
    }
    return targets;
}

void VisibilityRatio::weigh(const LitPoint& point, const Targets& targets, std::array<Draw, kDraws>& draws) const {
    const vec3 from(point.position);
    std::array<vec3, kDraws> points;
    for (int k = 0; k < kDraws; ++k)
        points[k] = targets[k].power > 0.0f ? targets[k].point : from;
    std::array<float, kDraws> depth;
    depths_.between(from, points.data(), depth.data());
    for (int k = 0; k < kDraws; ++k) {
        const vec3 offset = points[k] - from;
        const float square = std::max(glm::dot(offset, offset), 1e-30f);
        const vec3 direction = offset / std::sqrt(square);
        const float cosine = std::max(0.0f, glm::dot(vec3(point.normal), direction));
        draws[k] = {points[k], direction, targets[k].power * cosine / square * std::exp(-depth[k])};
    }
}

bool VisibilityRatio::draw(const LightFront& around, const LitPoint& point, Rng& rng,
                           std::array<Draw, kDraws>& draws) const {
    if (tree_.empty())
        return false;
    const double shift = rng.next_double();
    weigh(point, choose(around, point, shift, rng), draws);
    return true;
}

std::uint64_t VisibilityRatio::bytes() const {
    return nodes_.size() * 12 + clusters_.size() * sizeof(Cluster) + tree_.bytes();
}

}  // namespace brisance
