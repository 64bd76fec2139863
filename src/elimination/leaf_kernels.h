// The inner loops of elimination compare one point with the sixteen of a leaf.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "elimination/leaves.h"

namespace brisance {

// One slot of a leaf, with the values by which it is compared.
struct Probe {
    vec3 position;
    float inverse_reach;
    Weight weight;
    std::uint32_t rank;
};

// The square of a distance beyond which a point adds to no weight, with a margin for rounding.
inline float square_reach(float inverse_reach) {
    return 1.000001f / inverse_reach / inverse_reach;
}

struct LeafView {
    const Leaf* leaves;
    const float* square_reach;  // the greatest of each leaf's points
};

// The weights that the removal of a point subtracts from its neighbours.
struct Taken {
    std::vector<std::int32_t> weight;   // per leaf of the list, sixteen each
    std::vector<std::uint8_t> touched;  // per leaf of the list: whether any of the sixteen is not zero

    void resize(std::size_t leaves) {
        weight.resize(leaves * kLeafSize);
        touched.resize(leaves);
    }
};

// Sets the weights of a leaf's points to the sum over their neighbours, which are all in the leaves of `list`.
void sum_weights(Leaf* leaves, std::uint32_t leaf, std::span<const std::uint32_t> list, float least);

// How many points of the leaves listed are in reach of the first point of `leaf`, itself included.
std::size_t count_in_reach(const Leaf* leaves, std::span<const std::uint32_t> list, const Leaf& leaf);

// The location of a point among the leaves.
struct Slot {
    std::uint32_t leaf, slot;
};

// Returns the heaviest of the points that would be removed before the probe and are in reach of it or reach it. If
// there is none, fills `taken`. The probe itself must have been removed from its leaf.
std::optional<Slot> take_weights(const LeafView& view, std::span<const std::uint32_t> list, const Probe& probe,
                                 float least, Taken& taken);

// Subtracts sixteen weights from a leaf's.
void subtract(Leaf& leaf, const std::int32_t* taken);

// Subtracts what a point at `position` has added to the weights of one leaf.
void subtract(Leaf& leaf, const vec3& position, float least);

// Squares of the distances from p to the points of the leaves listed, sixteen per leaf.
void square_distances(const Leaf* leaves, std::span<const std::uint32_t> list, const vec3& p, float* squares);

// How many of n values (n a multiple of sixteen) are not above the limit.
std::size_t count_up_to(const float* values, std::size_t n, float limit);

// The greatest of n values (n a multiple of sixteen) that are not negative and not above the limit; else 0.
float greatest_up_to(const float* values, std::size_t n, float limit);

}  // namespace brisance
