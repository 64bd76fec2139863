// A binary tree over bounded lights that picks one of them for a point, about in proportion to its contribution there
// (Conty Estevez and Kulla, Importance Sampling of Many Lights with Adaptive Tree Splitting, HPG 2018; the bounds of
// angles as in Pharr, Jakob, Humphreys, Physically Based Rendering, 4th edition, section 12.6).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/vec.h"
#include "emitters/tree_descent.h"

namespace brisance {

// Bounds of a group of lights: position, directions of emission, and intensity.
struct LightBounds {
    dvec3 low{0.0}, high{0.0};
    dvec3 axis{0.0, 0.0, 1.0};  // of emission
    double spread = 0.0;        // the lights' axes lie within this angle of it; pi: everywhere
    double reach = 0.0;         // each emits within this angle of its own axis
    double intensity = 0.0;     // sum of the largest of each light, luminance [W/sr]
    bool two_sided = false;     // along both directions of the axis
    // Above 0: lights at infinity, which shine along their axes alone. They count as if they were so far away from
    // every point [m]: `intensity` is irradiance times the square of it. All distant lights of a tree have the same.
    double distance = 0.0;
    bool near_too = false;  // others are among them, in the box
};

// Lights that are bright in a narrow lobe have a peak many times their mean. Bounds need the peak; by the peak, most
// samples would go to lobes that point elsewhere.
enum class LobeBrightness { Mean, Peak };

// A receiver: a point of a medium, or of a surface that faces `normal` (or both sides, where it transmits light).
struct LitPoint {
    dvec3 position{0.0};
    dvec3 normal{0.0};
    enum class Kind { Medium, Surface, Transmitting } kind = Kind::Medium;
};

// A group of lights as seen from a point: what it sends there at most, and where it may lie.
struct LightsInView {
    double intensity = 0.0;                  // the largest toward the point, luminance [W/sr]; 0: none reaches it
    double nearest2 = 0.0, farthest2 = 0.0;  // to the box of the lights, squared [m^2]
    dvec3 direction{0.0, 0.0, 1.0};          // unit, from the point: of the cone around all lights ...
    double cos_around = -1.0;                // ... and of its half angle; -1: the lights are all around the point
};

// Importance: the most that bounded lights can send to a point, by the geometry of the bounds. Angles are stored as
// cosines and sines, since every choice evaluates them at every branch.
class LightCone {
public:
    LightCone() = default;
    explicit LightCone(const LightBounds& lights);
    double importance(const LitPoint& point) const;
    // Without the cosine of the point's normal, which belongs to its BSDF. `around`: half the size of a box around the
    // point, for bounds over all points of it [m].
    LightsInView seen_from(const dvec3& point, const dvec3& around = dvec3(0.0)) const;
    double intensity() const { return intensity_; }
    double radius2() const { return radius2_; }  // of the ball around the box [m^2]

private:
    double importance_of_far(const LitPoint& point) const;

    dvec3 middle_{0.0}, axis_{0.0, 0.0, 1.0};
    double radius2_ = 0.0;  // of the ball around the box [m^2]
    double intensity_ = 0.0;
    vec3 half_{0.0f};  // size of the box [m]
    double cos_spread_ = 1.0, sin_spread_ = 0.0, cos_reach_ = 1.0;
    double far2_ = 0.0;  // squared distance of lights at infinity; 0: there are none [m^2]
    bool two_sided_ = false, near_ = true;
};

// Distant lights and others share no node but the root.
class LightTree {
public:
    explicit LightTree(const std::vector<LightBounds>& lights);
    bool empty() const { return nodes_.empty(); }
    std::size_t size() const { return leaf_of_.size(); }

    struct Choice {
        std::size_t light;
        double probability;
    };
    // Chooses by a number in [0, 1). None where no light can reach the point.
    std::optional<Choice> choose(const LitPoint& point, double u) const;
    // The same among those below a node.
    std::optional<Choice> choose_from(std::uint32_t node, const LitPoint& point, double u) const;
    // The probability with which choose() picks that light.
    double probability(const LitPoint& point, std::size_t light) const;

    // The tree itself, for those who choose otherwise. Node 0 is the root; children have greater numbers.
    std::size_t node_count() const { return nodes_.size(); }
    const LightCone& lights(std::uint32_t node) const { return nodes_[node].lights; }
    bool is_leaf(std::uint32_t node) const { return nodes_[node].left == 0; }
    std::uint32_t left(std::uint32_t node) const { return nodes_[node].left; }  // of inner nodes
    std::uint32_t right(std::uint32_t node) const { return nodes_[node].right; }
    std::size_t light(std::uint32_t leaf) const { return nodes_[leaf].right; }
    std::uint32_t leaf(std::size_t light) const { return leaf_of_[light]; }
    // A light below `node`, by a number in [0, 1). `share_of_left(left, right)`: the probability of the left of two
    // nodes, below 0 where neither has any. None there.
    template <class ShareOfLeft>
    std::optional<Choice> choose_below(std::uint32_t node, double u, const ShareOfLeft& share_of_left) const {
        const auto found = descend(
            nodes_, u, [&](const Node& n) { return share_of_left(n.left, n.right); }, node);
        if (!found)
            return std::nullopt;
        return Choice{nodes_[found->leaf].right, found->probability};
    }

    std::uint64_t bytes() const { return nodes_.size() * sizeof(Node) + leaf_of_.size() * sizeof(std::uint32_t); }

private:
    struct Node {
        LightCone lights;
        std::uint32_t parent = 0, left = 0, right = 0;  // left == 0: a leaf of the light `right`
    };
    std::uint32_t build(std::vector<std::uint32_t>& order, const std::vector<LightBounds>& lights, std::size_t begin,
                        std::size_t end, std::uint32_t parent);
    double share_of_left(const Node& node, const LitPoint& point) const;
    static std::size_t divide(std::vector<std::uint32_t>& order, const std::vector<LightBounds>& lights,
                              std::size_t begin, std::size_t end, const LightBounds& all);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_of_;
};

// Bounds of both.
LightBounds united(const LightBounds& a, const LightBounds& b);

}  // namespace brisance
