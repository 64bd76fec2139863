// Kernels compiled for several instruction sets and chosen at run time.
#pragma once

#include <cstdint>
#include <span>

#include "medium/lattice/extinction_pyramid.h"
#include "medium/lattice/homogeneous_bricks.h"

namespace brisance {

// One step of a shadow ray's march, the same for all texels of all lights of a level.
struct ShadowStep {
    float distance;  // of its middle from the light [m]
    float length;    // [m]
    int mip;         // pyramid level sampled
    int store;       // distance sample to store after this step, or -1
};

// Rays of one light: planar arrays padded to a multiple of 16.
struct ShadowRays {
    const float* direction[3];  // nodes per metre
    const float* starts[3];     // kStarts + 16 starting offsets [nodes], the last 16 repeating the first
    const float* weights;       // of the starts, laid out the same
    std::size_t count;          // padded
    int parallel = 8;           // of march_parallel_rays: rays per texel, at most kMostParallelRays
};

// Marches all rays from `origin` [nodes, relative to the reference]; transmittance of ray r at stored distance k goes
// to out[r * distances + k], times 65535. Up to the first stored distance, which `near_steps` reach, the transmittance
// is the mean over kNearRays rays that start at different points of the light's extent and converge there.
constexpr int kNearRays = 4;
constexpr std::size_t kStarts = 64;
void march_shadow_rays(const PackedExtinction* mips, std::span<const ShadowStep> near_steps,
                       std::span<const ShadowStep> steps, const vec3& origin, const ShadowRays& rays, int distances,
                       std::uint16_t* out);

// Where rays may stride. Where the middle of several steps lies in homogeneous bricks for all rays, one step with
// extinction from level `mip` replaces them.
struct HomogeneousStrides {
    HomogeneousBricks::View parts;
    int mip;
};

// The same with the weighted mean over rays.parallel parallel rays along the full length, times `scale` instead of
// 65535. `strides` may be null.
constexpr int kMostParallelRays = 16;
void march_parallel_rays(const PackedExtinction* mips, std::span<const ShadowStep> near_steps,
                         std::span<const ShadowStep> steps, const vec3& origin, const ShadowRays& rays, int distances,
                         float scale, std::uint16_t* out, const HomogeneousStrides* strides = nullptr);

// Segments in planar arrays padded to a multiple of 16: from `begin` to `end`, in nodes of the lattice relative to the
// reference, `metres` long.
struct Segments {
    const float* begin[3];
    const float* end[3];
    const float* metres;
    std::size_t count;  // padded
};

// The optical depths of the segments, by the midpoint rule with steps of at most `step_nodes` nodes.
void segment_optical_depths(const PackedExtinction& extinction, const Segments& segments, float step_nodes,
                            float* depths);

// How much of a light that starts with 1 collides along the segments, each collision counted with the value of the
// field `weight` where it happens. Where `weight` is the source function, it is the radiance that arrives at the
// beginning of a segment.
void segment_collisions(const PackedExtinction& extinction, const PackedExtinction& weight, const Segments& segments,
                        float step_nodes, float* sums);

}  // namespace brisance
