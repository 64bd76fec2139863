// A binary tree over ray lights, or other lights in boxes, that picks one of them for a camera ray or a surface point,
// about in proportion to what it may send there, at a cost that grows like the logarithm of their number.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light_selection/receiver.h"

namespace brisance {

// A box of ray lights, the power that scatters in it, and where it goes.
struct MediumLightBounds {
    dvec3 low{0.0}, high{0.0};
    double scattered = 0.0;
    double extinction = 0.0;  // mean around the lights, by power [1/m]
    dvec3 heading{0.0};       // mean of the lights' directions by power, between 0 (all over) and 1 long
};
// Of each of some lights.
template <class Lights>
std::vector<MediumLightBounds> boxes_of(const Lights& lights) {
    std::vector<MediumLightBounds> boxes;
    boxes.reserve(lights.size());
    for (const auto& light : lights)
        boxes.push_back(bounds_of(light));
    return boxes;
}
// What is left of light after an optical depth that is only guessed: more than exp(-depth), as guesses may be wrong.
inline double guessed_transmittance(double depth) {
    return 1.0 / (1.0 + depth * (1.0 + 0.5 * depth));
}
MediumLightBounds united(const MediumLightBounds& a, const MediumLightBounds& b);

// About what the lights in the box send to the receiver: above zero wherever their power is. The ray's part is the
// integral of the inverse square distance along it, kept finite by the size of the box. Phase functions count by their
// largest value for the mean heading and any place in the box, smoke as if it were everywhere as it is around the
// lights.
double importance(const MediumLightBounds& box, const LightReceiver& receiver, double mean_cosine);

class MediumLightTree {
public:
    MediumLightTree(std::span<const MediumLightBounds> lights, double mean_cosine);
    bool empty() const { return nodes_.empty(); }

    struct Choice {
        std::size_t light;
        double probability;
        int visited;  // nodes whose importance was asked
    };
    // From a number in [0, 1): neighbouring numbers choose neighbouring lights, so that they may be stratified.
    std::optional<Choice> choose(const LightReceiver& receiver, double u) const;
    // With which choose() picks that light.
    double probability(const LightReceiver& receiver, std::size_t light) const;

    std::uint64_t bytes() const { return nodes_.size() * sizeof(Node) + leaf_of_.size() * sizeof(std::uint32_t); }

private:
    struct Node {
        MediumLightBounds bounds;
        std::uint32_t parent = 0, left = 0, right = 0;  // left == 0: a leaf of the light `right`
    };
    std::uint32_t build(std::span<const MediumLightBounds> lights, std::span<std::uint32_t> order,
                        std::uint32_t parent);
    double share_of_left(const Node& node, const LightReceiver& receiver) const;
    double share_of_power(const Node& node) const;
    double probability_by_receiver(const LightReceiver& receiver, std::size_t light) const;
    double mixed(double by_receiver, std::size_t light) const;

    double mean_cosine_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_of_;
};

}  // namespace brisance
