// Where the scene's light is, coarsely: it tells paths where to go. Learned once from particles of light.
//
// The lattice's cells are cubes of 4^3 voxels. A cell knows the mean radiance in it and the direction in which most of
// it flows, from the track lengths of particles, and the power that leaves the smoke after its last scattering or its
// emission in the cell: what an eye outside sees of it. A guide that is wrong costs noise, never truth: each density
// keeps a share of the phase function's or of the BSDF's own, and roulette never ends a path for certain.
//
// Sources: J. Vorba, J. Krivanek, Adjoint-Driven Russian Roulette and Splitting in Light Transport Simulation, SIGGRAPH
// 2016 (weights follow the expected contribution); S. Herholz et al., Volume Path Guiding Based on Zero-Variance Random
// Walk Theory, ACM TOG 2019 (directions by incident radiance). Here the radiance is one lobe in a cell, by its mean
// cosine, instead of a fitted mixture, and distances are not guided.
#pragma once

#include <array>
#include <vector>

#include "core/cell.h"
#include "transport/direct_light.h"

namespace brisance {

class LightGuide {
public:
    LightGuide() = default;
    // Keeps a reference to the scene. The same guide for any number of threads.
    explicit LightGuide(const DirectLight& scene);

    // No particle met smoke.
    bool empty() const { return cells_.empty(); }

    struct Cell {
        float radiance = 0.0f;  // mean over all directions [W/(m^2 sr)], luminance
        vec3 flow{0.0f};        // mean direction of the light; its length is the mean cosine about it
    };
    // The cell's number at a local position [m]; -1 outside the smoke.
    std::ptrdiff_t cell_at(const dvec3& position) const;
    // The cell of a local position [m]; null outside the smoke.
    const Cell* at(const dvec3& position) const;
    const Cell& of(const VoxelSegment& voxel) const { return cells_[CoarseField::cell_of(voxel.brick, voxel.cube)]; }
    // What smoke scatters [W/(m^2 sr)], by what sends it the light, and in all. It estimates the albedo times the mean
    // of the incident radiance, weighted by the phase function as if that were constant.
    const Rgb& scattered(std::size_t cell, Sender from) const { return by_sender_[cell][int(from)]; }
    const CoarseField& scattered() const { return scattered_; }

    // The mean radiance of smoke that an eye outside sees [W/(m^2 sr)], luminance.
    float seen_radiance() const { return seen_radiance_; }

    // The share of directions toward the smoke's glow at a surface, by what particles found near it.
    float glow_share(const dvec3& position) const;
    // A unit vector toward a point that sends light out of the smoke, and the density of its direction along a ray
    // [1/sr].
    dvec3 sample_glow(const dvec3& from, Rng& rng) const;
    double pdf_glow(const Ray& ray) const;
    bool has_glow() const { return !cumulative_.empty(); }

    std::uint64_t bytes() const;

private:
    class Learner;
    static constexpr int kCube = 4;
    static constexpr int kCubes = 8;  // to a brick
    static constexpr int kSharesPerSide = 16;

    static std::size_t cell_of(std::size_t brick, const ivec3& cube) {
        return brick * kCubes + (cube.x * 2 + cube.y) * 2 + cube.z;
    }
    std::size_t share_at(const dvec3& position) const;

    const TrackingField* field_ = nullptr;
    dmat3 index_from_local_{1.0}, local_from_index_{1.0};
    dvec3 origin_{0.0};  // local position of the lattice's first node [m]
    std::vector<Cell> cells_;
    std::vector<std::array<Rgb, 4>> by_sender_;
    CoarseField scattered_;
    float seen_radiance_ = 0.0f;
    std::vector<double> density_;     // of glow per cell [1/m^3]
    std::vector<double> cumulative_;  // its probability, inclusive
    dvec3 shares_low_{0.0};
    double shares_size_ = 1.0;   // of a cell of shares [m]
    std::vector<float> shares_;  // per cell
};

}  // namespace brisance
