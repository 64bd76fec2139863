// Points at which light is gathered, packed for vector kernels.
//
// Receivers come in groups of 16 with planar coordinates; the last group of a block is padded by repeating its last
// point. Groups form blocks that share one interaction list per level. A block is a compact set, such as the nodes of a
// brick.
#pragma once

#include <cstdint>
#include <span>
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

// The weight of light in `scattered` (Gathered, below), given the direction of each receiver.
enum class ReceiverKind {
    Medium,  // the phase function toward `toward_camera`
    Surface  // cosine / pi to the normal, which is passed as `toward_camera`; 0 from below
};

// Unit vector from `p` to `eye` (local [m]).
vec3 direction_toward(const vec3& eye, const vec3& p);

class Receivers {
public:
    static constexpr int kGroup = 16;

    Receivers() = default;
    // Room for one block for each of `counts` (at least 1 point). set_block() fills each once; several threads may.
    Receivers(const std::vector<std::size_t>& counts, bool directions);
    void set_block(std::size_t block, const std::vector<vec3>& points, const std::vector<vec3>& toward_camera);

    // Appends a block of points (local [m]); `toward_camera` (unit, or empty) is the direction light must leave in.
    // Consecutive points should lie close together.
    void add_block(const std::vector<vec3>& points, const std::vector<vec3>& toward_camera);

    std::size_t size() const { return x.size(); }  // padded
    const std::vector<ReceiverBlock>& blocks() const { return blocks_; }

    std::vector<float> x, y, z;              // [m]
    std::vector<float> out_x, out_y, out_z;  // empty: no directions
    std::vector<Box> group_bounds;

private:
    std::vector<ReceiverBlock> blocks_;
};

// Gathered light, one value per (padded) receiver and channel. It is planar: channel c of receiver i is at
// [c * size + i].
struct Gathered {
    // Fluence [W/m^2], channels R G B.
    std::vector<float> fluence;
    // Radiance scattered toward the camera per unit scattering coefficient: integral of p L [W/(m^2 sr)], channels
    // R G B, only where receivers have a direction. For surfaces it is what a white Lambert surface reflects
    // [W/(m^2 sr)].
    std::vector<float> scattered;
    // Moments of the incident radiance against the real spherical harmonics of degree 1 and 2 (sh.h) of the direction
    // of travel: channel 3 * m + c for m = 0..7 and colour c. Empty unless requested.
    std::vector<float> moments;

    void resize(std::size_t receivers, bool camera, bool directional);
    // The channels of all fields in the order above, each of one value per receiver.
    std::vector<std::span<float>> planes();
    std::vector<std::span<const float>> planes() const;
    void add(const Gathered& other);
    void scale(const Rgb& factor);
    std::uint64_t bytes() const { return (fluence.size() + scattered.size() + moments.size()) * sizeof(float); }
};

}  // namespace brisance
