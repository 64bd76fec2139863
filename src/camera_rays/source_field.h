// The medium as the camera samples it: extinction and the source functions of each ledger cell, together.
//
// Voxels lie in bricks of 8^3 with 9^3 node records, so that a trilinear sample touches one brick; bricks without
// extinction or emission are absent, and a ray steps over them without a sample.
#pragma once

#include <cstdint>
#include <vector>

#include "medium/medium.h"
#include "medium_lighting/node_sources.h"

namespace brisance {

// Per node: extinction [1/m]; for each ledger cell the source function, so that cell c adds extinction * source_c (or,
// for direct emission, source_V itself as an emission coefficient) per metre.
struct SourceRecord {
    enum Slot { Extinction = 0, V = 1, MV = 4, MM = 7, Albedo = 10, Size = 12 };
    float value[Size];
};

// Where scattered light was traced through a similar medium (similar_medium.h): its extinction, its own V, and the
// fraction of the medium's extinction that its omitted peak scatters straight on.
struct SimilarRecord {
    enum Slot { Extinction = 0, V = 1, Forward = 4, Size = 8 };
    float value[Size];
};

// Light of the surroundings: source functions of MS and MA.
struct SurroundingsRecord {
    enum Slot { MS = 0, MA = 3, Size = 6 };
    float value[Size];
};

class SourceField {
public:
    // `similar`: the medium of the sources, if it is not the medium itself; `forward`: the share of all scattering in
    // its omitted peak.
    explicit SourceField(const Medium& medium, const NodeSources& sources = {}, const Medium* similar = nullptr,
                         float forward = 0.0f);

    const Medium& medium() const { return *medium_; }
    const BrickLattice& bricks() const { return bricks_; }  // of voxels
    bool direct_emission() const { return direct_; }
    float minimum(std::size_t brick) const { return minimum_[brick]; }  // of extinction over the brick's voxels
    float majorant(std::size_t brick) const { return majorant_[brick]; }
    float majorant_of_voxel(std::size_t brick, const ivec3& voxel) const;  // of extinction over its corners
    bool has_similar() const { return !similar_.empty(); }
    bool has_outside() const { return !outside_.empty(); }
    std::uint64_t bytes() const {
        return records_.size() * sizeof(SourceRecord) + similar_.size() * sizeof(SimilarRecord) +
               outside_.size() * sizeof(SurroundingsRecord) + bricks_.bytes();
    }

    // Trilinear samples at p, in nodes from the brick's first node, each coordinate in [0, 8].
    SourceRecord sample(std::size_t brick, const vec3& p) const;
    SimilarRecord sample_similar(std::size_t brick, const vec3& p) const;
    SurroundingsRecord sample_outside(std::size_t brick, const vec3& p) const;

private:
    const Medium* medium_;
    bool direct_;
    BrickLattice bricks_;
    std::vector<SourceRecord> records_;
    std::vector<SimilarRecord> similar_;       // empty: the medium itself
    std::vector<SurroundingsRecord> outside_;  // empty: the surroundings send no light
    std::vector<float> minimum_, majorant_;
};

}  // namespace brisance
