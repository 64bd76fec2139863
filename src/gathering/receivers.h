// Points that ask for light, packed for vector kernels.
//
// Receivers come in groups of 16 (the last of a block padded by repeating its last point) with planar coordinates;
// groups form blocks that share one interaction list per level. A block is a compact set: the nodes of a brick, say.
#pragma once

#include <cstdint>
#include <vector>

#include "core/vec.h"

namespace brisance {

struct Box {
    vec3 low{1e30f};
    vec3 high{-1e30f};
    void add(const vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

struct ReceiverBlock {
    std::size_t first_group = 0;
    std::size_t group_count = 0;
    Box bounds;  // local [m]
};

// What `scattered` weighs light by (Gathered, below), with the direction of each receiver.
enum class ReceiverKind {
    Medium,  // the phase function toward `toward_camera`
    Surface  // cosine / pi to the normal, which stands in the place of `toward_camera`; 0 from below
};

class Receivers {
public:
    static constexpr int kGroup = 16;

    // Appends a block of points (local [m]); `toward_camera` (unit, or empty) is the direction light must leave in.
    // Consecutive points should lie close together.
    void add_block(const std::vector<vec3>& points, const std::vector<vec3>& toward_camera);

    std::size_t size() const { return x.size(); }  // padded
    const std::vector<ReceiverBlock>& blocks() const { return blocks_; }

    std::vector<float> x, y, z;              // [m]
    std::vector<float> out_x, out_y, out_z;  // empty: no direction asked for
    std::vector<Box> group_bounds;

private:
    std::vector<ReceiverBlock> blocks_;
};

// What arrives, one value per (padded) receiver and channel, planar: value of channel c at receiver i is [c * size +
// i].
struct Gathered {
    // Fluence [W/m^2], channels R G B.
    std::vector<float> fluence;
    // Radiance scattered toward the camera per unit scattering coefficient: integral of p L [W/(m^2 sr)]; R G B; only
    // where receivers have a direction. Of surfaces: what a white Lambert surface reflects [W/(m^2 sr)].
    std::vector<float> scattered;
    // Moments of the incident radiance against the real spherical harmonics of degree 1 and 2 (sh.h), of the direction
    // of travel: channel 3 * m + c for m = 0..7 and colour c; only when asked for.
    std::vector<float> moments;

    void resize(std::size_t receivers, bool camera, bool directional);
    void add(const Gathered& other);
    void scale(const Rgb& factor);
};

}  // namespace brisance
