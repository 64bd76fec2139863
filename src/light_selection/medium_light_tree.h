// A binary tree over ray lights, or other lights in boxes. It picks one light for a camera ray or a surface point with
// a probability about proportional to the light's contribution, at a cost logarithmic in the number of lights.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "light_selection/receiver.h"

namespace brisance {

// A box of ray lights, the power that scatters in it, and its mean direction.
struct MediumLightBounds {
    dvec3 low{0.0}, high{0.0};
    double scattered = 0.0;
    double extinction = 0.0;  // mean around the lights, by power [1/m]
    // Power-weighted mean of the lights' directions; its length is between 0 (all directions) and 1.
    dvec3 heading{0.0};
};
// The boxes of all lights.
template <class Lights>
std::vector<MediumLightBounds> boxes_of(const Lights& lights) {
    std::vector<MediumLightBounds> boxes;
    boxes.reserve(lights.size());
    for (const auto& light : lights)
        boxes.push_back(bounds_of(light));
    return boxes;
}
// Approximate transmittance of an estimated optical depth: more than exp(-depth), as the estimate may be wrong.
inline double guessed_transmittance(double depth) {
    return 1.0 / (1.0 + depth * (1.0 + 0.5 * depth));
}
MediumLightBounds united(const MediumLightBounds& a, const MediumLightBounds& b);

// Approximate contribution of the lights in the box to the receiver; above zero wherever they have power. For a ray it
// is the integral of the inverse square distance along it, kept finite by the size of the box. Phase functions take
// their largest value for the mean direction and any point in the box. The extinction is taken to be that around the
// lights everywhere.
double importance(const MediumLightBounds& box, const LightReceiver& receiver, double mean_cosine);

class MediumLightTree {
public:
    MediumLightTree(std::span<const MediumLightBounds> lights, double mean_cosine);
    bool empty() const { return nodes_.empty(); }

    struct Choice {
        std::size_t light;
        double probability;
        int visited;  // nodes whose importance was evaluated
    };
    // Chooses by a number in [0, 1). Neighbouring numbers choose neighbouring lights, so that they can be stratified.
    std::optional<Choice> choose(const LightReceiver& receiver, double u) const;
    // The probability with which choose() picks that light.
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
