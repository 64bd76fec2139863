// The medium as the camera samples it: extinction and the source functions of each ledger cell, together.
//
// Voxels lie in bricks of 8^3 with 9^3 node records, so that a trilinear sample touches one brick; bricks without
// extinction or emission are absent, and a ray steps over them without a sample. The records of a brick are made when
// the first ray samples it: smoke that is hidden, or outside the picture, has none.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "medium/lattice/made_when_asked.h"
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
    enum Slot { MS = 0, MA = 3, Size = 8 };
    float value[Size];
};

// The same for rays that leave surfaces (secondary_field.h): extinction, V, and the source function of all that is
// scattered.
struct alignas(16) SecondaryRecord {
    enum Slot { Extinction = 0, V = 1, Scattered = 4, Size = 8 };
    float value[Size];
};

constexpr int kRecordsAside = BrickLattice::kSize + 1;  // along a brick's side

// Four values of a record: compilers leave them apart otherwise, and half of a camera's time goes by here.
using Quad = float __attribute__((vector_size(16)));

template <class Record>
constexpr int quads_of() {
    static_assert(Record::Size % 4 == 0);
    return Record::Size / 4;
}

template <class Record>
inline Quad quad(const Record& record, int i) {
    Quad out;
    std::memcpy(&out, record.value + 4 * i, sizeof(out));
    return out;
}

// Trilinear between the records of a brick at p, in nodes from its first node, each coordinate in [0, 8].
template <class Record>
inline Record interpolated(const Record* records, const vec3& p) {
    constexpr int kQuads = quads_of<Record>();
    const ivec3 base = glm::min(ivec3(p), ivec3(BrickLattice::kSize - 1));
    const vec3 f = p - vec3(base);
    const float x[] = {1 - f.x, f.x}, y[] = {1 - f.y, f.y}, z[] = {1 - f.z, f.z};
    const Record* const r = records + (base.x * kRecordsAside + base.y) * kRecordsAside + base.z;
    Quad sum[kQuads] = {};
#pragma GCC unroll 8
    for (int k = 0; k < 8; ++k) {
        const float w = x[k >> 2] * y[k >> 1 & 1] * z[k & 1];
        const Record& corner = r[((k >> 2) * kRecordsAside + (k >> 1 & 1)) * kRecordsAside + (k & 1)];
        for (int i = 0; i < kQuads; ++i)
            sum[i] += w * quad(corner, i);
    }
    Record out;
    std::memcpy(out.value, sum, sizeof(sum));
    return out;
}

class SourceField {
public:
    static constexpr int kSide = kRecordsAside;  // nodes along a side of a brick's records
    static constexpr int kRecords = kSide * kSide * kSide;

    // The medium by itself: nothing lights it. Keeps a reference.
    explicit SourceField(const Medium& medium);
    // Keeps references to all. `similar`: the medium of the sources, if it is not the medium itself; `forward`: the
    // share of all scattering in its omitted peak.
    SourceField(const Medium& medium, const NodeSources& sources, const Medium* similar = nullptr,
                float forward = 0.0f);
    SourceField(const Medium&, NodeSources&&, const Medium* = nullptr, float = 0.0f) = delete;
    SourceField(const SourceField&) = delete;
    SourceField& operator=(const SourceField&) = delete;

    const Medium& medium() const { return *medium_; }
    const BrickLattice& bricks() const { return bricks_; }  // of voxels
    bool direct_emission() const { return direct_; }
    float minimum(std::size_t brick) const { return minimum_[brick]; }  // of extinction over the brick's voxels
    float majorant(std::size_t brick) const { return majorant_[brick]; }
    float majorant_of_voxel(std::size_t brick, const ivec3& voxel) const;  // of extinction over its corners
    bool has_similar() const { return similar_ != nullptr; }
    bool has_outside() const { return outside_; }
    // The share of MA that the field holds; the rest is sampled along rays, and the field guides it.
    float emitters_share() const { return sources_ ? sources_->emitters_at_nodes : 1.0f; }
    bool has_emitters() const { return sources_ && !sources_->from_emitters.empty(); }
    std::uint64_t bytes() const;  // of what has been made so far

    // The medium's own records of a brick, and those of the surroundings' light, for interpolated().
    const SourceRecord* own_records(std::size_t brick) const { return records(brick).own.data(); }
    const SurroundingsRecord* outside_records(std::size_t brick) const { return records(brick).outside.data(); }
    // Trilinear samples at p, in nodes from the brick's first node, each coordinate in [0, 8].
    SourceRecord sample(std::size_t brick, const vec3& p) const;
    SimilarRecord sample_similar(std::size_t brick, const vec3& p) const;
    SurroundingsRecord sample_outside(std::size_t brick, const vec3& p) const;

    // Fills the records of a brick for rays from surfaces. There must be no similar medium.
    void put_secondary(std::size_t brick, std::array<SecondaryRecord, kRecords>& out) const;

private:
    struct BrickRecords {
        std::array<SourceRecord, kRecords> own;
        std::vector<SimilarRecord> similar;       // empty: the medium itself
        std::vector<SurroundingsRecord> outside;  // empty: the surroundings send no light
    };

    SourceField(const Medium& medium, const NodeSources* sources, const Medium* similar, float forward);

    const BrickRecords& records(std::size_t brick) const {
        return made_.get(brick, [&] { return new_records(brick); });
    }
    std::unique_ptr<BrickRecords> new_records(std::size_t brick) const;
    void put_own(BrickRecords& out, const ivec3& low) const;
    void put_outside(BrickRecords& out, const ivec3& low) const;
    void put_similar(BrickRecords& out, const ivec3& low) const;

    const Medium* medium_;
    const NodeSources* sources_;  // null: none
    const Medium* similar_;       // null: the medium itself
    float forward_;
    bool direct_, outside_;
    BrickLattice bricks_;
    std::vector<float> minimum_, majorant_;
    MadeWhenAsked<BrickRecords> made_;
};

}  // namespace brisance
