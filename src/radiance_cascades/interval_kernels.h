// The vector kernel of radiance cascades: the same interval of a ray from many probes at once.
#pragma once

#include <cstdint>

namespace brisance {

constexpr int kProbesAtOnce = 64;
constexpr std::uint8_t kUnhidden = 255;  // no surface on the way

// What a medium gives along an interval: radiance toward the probe and transmittance, planar.
struct Intervals {
    alignas(64) float red[kProbesAtOnce];
    alignas(64) float green[kProbesAtOnce];
    alignas(64) float blue[kProbesAtOnce];
    alignas(64) float transmittance[kProbesAtOnce];
};

struct IntervalMarch {
    const float* nodes;  // four per node of a block, z fastest: source function R G B, extinction [1/m]
    int stride_x, stride_y;
    const std::int32_t* probe;     // node of each probe in the block
    int count;                     // of probes, a multiple of 16
    float first[3], step[3];       // from a probe to the first sample, and between samples, in nodes
    int samples;                   // in the middle of segments of equal length
    float length;                  // of a segment [m]
    const std::uint8_t* unhidden;  // per probe: samples before a surface, or kUnhidden; null: no surfaces
};

// Samples source function and extinction trilinearly; each segment is integrated exactly as if they were constant:
// L += T S (1 - exp(-extinction * length)). The block must hold all nodes around every sample.
void march_intervals(const IntervalMarch& march, Intervals& out);

}  // namespace brisance
