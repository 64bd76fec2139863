#include "camera_rays/one_sided_voxels.h"

#include <vector>

#include "medium/lattice/occluders.h"

namespace brisance {

namespace {

constexpr int kCorners = 8;

ivec3 corner(int k) {
    return {k >> 2, k >> 1 & 1, k & 1};
}

std::size_t record_of(const ivec3& node) {
    return std::size_t((node.x * SourceField::kSide + node.y) * SourceField::kSide + node.z);
}

// Calls visit(record) for the nodes of a voxel and of those beside it, as far as they are the brick's.
template <class Visit>
void for_nodes_around(const ivec3& voxel, const Visit& visit) {
    const ivec3 first = glm::max(voxel - 1, ivec3(0)), last = glm::min(voxel + 2, ivec3(SourceField::kSide - 1));
    for (int x = first.x; x <= last.x; ++x)
        for (int y = first.y; y <= last.y; ++y)
            for (int z = first.z; z <= last.z; ++z)
                visit(record_of({x, y, z}));
}

// The corners of a voxel whose light a corner behind the surface takes over, one bit each: its neighbours along edges
// that are in front, or else all that are in front.
unsigned in_place_of(int k, unsigned front) {
    const unsigned neighbours = (1u << (k ^ 1) | 1u << (k ^ 2) | 1u << (k ^ 4)) & front;
    return neighbours != 0 ? neighbours : front;
}

// The mean of values [begin, end) at those corners.
template <class Record>
void take_over(Record* records, const std::size_t (&at)[kCorners], int k, unsigned from, int begin, int end) {
    for (int i = begin; i < end; ++i) {
        float sum = 0.0f, count = 0.0f;
        for (int j = 0; j < kCorners; ++j)
            if (from >> j & 1u) {
                sum += records[at[j]].value[i];
                count += 1.0f;
            }
        records[at[k]].value[i] = sum / count;
    }
}

}  // namespace

OneSidedVoxels::OneSidedVoxels(const SourceField& field, const RayEnd& end)
    : field_(field),
      distance_(end.distance),
      normal_(end.normal * dmat3(field.medium().local_from_index)),
      moved_(glm::dot(end.normal, dvec3(field.medium().spacing * kBesidePlanes))),
      most_behind_(glm::min(normal_.x, 0.0) + glm::min(normal_.y, 0.0) + glm::min(normal_.z, 0.0)),
      some_(end.normal != dvec3(0.0)) {}

BrickRecords OneSidedVoxels::in_front(const VoxelSegment& voxel) const {
    thread_local std::vector<SourceRecord> own(SourceField::kRecords);
    thread_local std::vector<SurroundingsRecord> outside(SourceField::kRecords);
    const auto [all, all_outside] = records_of(field_, voxel.brick);
    for_nodes_around(voxel.cube, [&, all = all, all_outside = all_outside](std::size_t node) {
        own[node] = all[node];
        if (all_outside)
            outside[node] = all_outside[node];
    });
    std::size_t at[kCorners];
    unsigned front = 0;
    for (int k = 0; k < kCorners; ++k) {
        at[k] = record_of(voxel.cube + corner(k));
        if (side_of(voxel, voxel.cube + corner(k)) > 0.0)
            front |= 1u << k;
    }
    for (int k = 0; k < kCorners && front != 0; ++k) {
        if (front >> k & 1u)
            continue;
        const unsigned from = in_place_of(k, front);
        take_over(own.data(), at, k, from, SourceRecord::MV, SourceRecord::Albedo);
        if (all_outside)
            take_over(outside.data(), at, k, from, 0, SurroundingsRecord::Size);
    }
    return {own.data(), all_outside ? outside.data() : nullptr};
}

}  // namespace brisance
