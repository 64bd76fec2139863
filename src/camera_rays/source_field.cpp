#include "camera_rays/source_field.h"

#include <algorithm>

#include "core/parallel.h"
#include "medium/lattice/voxel_walk.h"

namespace brisance {

namespace {

constexpr int kSide = BrickLattice::kSize + 1;
constexpr int kRecords = kSide * kSide * kSide;

template <class Record>
void put(const Medium& medium, const std::vector<Rgb>& field, const ivec3& low, int slot, Record* records) {
    if (field.empty())
        return;
    std::vector<float> box(3 * kRecords);
    copy_box(medium.lattice, {reinterpret_cast<const float*>(field.data()), field.size() * 3}, 3, low, ivec3(kSide),
             box);
    for (int i = 0; i < kRecords; ++i)
        for (int c = 0; c < 3; ++c)
            records[i].value[slot + c] = box[c * kRecords + i];
}

template <class Record>
void put_extinction(const Medium& medium, const ivec3& low, Record* records) {
    std::vector<float> box(kRecords);
    copy_box(medium.lattice, medium.extinction, 1, low, ivec3(kSide), box);
    for (int i = 0; i < kRecords; ++i)
        records[i].value[Record::Extinction] = box[i];
}

template <class Record>
Record interpolated(const Record* records, const vec3& p) {
    const ivec3 base = glm::min(ivec3(p), ivec3(BrickLattice::kSize - 1));
    const vec3 f = p - vec3(base);
    const Record* r = records + (base.x * kSide + base.y) * kSide + base.z;
    Record out{};
    for (int k = 0; k < 8; ++k) {
        const float w = (k & 4 ? f.x : 1 - f.x) * (k & 2 ? f.y : 1 - f.y) * (k & 1 ? f.z : 1 - f.z);
        const Record& corner = r[((k >> 2) * kSide + (k >> 1 & 1)) * kSide + (k & 1)];
        for (int i = 0; i < Record::Size; ++i)
            out.value[i] += w * corner.value[i];
    }
    return out;
}

}  // namespace

SourceField::SourceField(const Medium& medium, const NodeSources& sources, const Medium* similar, float forward)
    : medium_(&medium), direct_(!medium.emission.empty()), bricks_(voxel_lattice(medium)) {
    records_.resize(bricks_.brick_count() * kRecords, SourceRecord{});
    similar_.resize(similar ? records_.size() : 0, SimilarRecord{});
    const bool outside = !sources.from_surfaces.empty() || !sources.from_emitters.empty();
    outside_.resize(outside ? records_.size() : 0, SurroundingsRecord{});
    minimum_.resize(bricks_.brick_count());
    majorant_.resize(bricks_.brick_count());
    parallel_for(bricks_.brick_count(), [&](std::size_t b) {
        SourceRecord* records = &records_[b * kRecords];
        const ivec3 low = bricks_.first_node(b);
        put_extinction(medium, low, records);
        const auto by_extinction = [](const SourceRecord& p, const SourceRecord& q) { return p.value[0] < q.value[0]; };
        const auto [least, greatest] = std::minmax_element(records, records + kRecords, by_extinction);
        minimum_[b] = least->value[SourceRecord::Extinction];
        majorant_[b] = greatest->value[SourceRecord::Extinction];
        put(medium, direct_ ? medium.emission : medium.source, low, SourceRecord::V, records);
        put(medium, sources.single, low, SourceRecord::MV, records);
        put(medium, sources.multiple, low, SourceRecord::MM, records);
        if (outside) {
            put(medium, sources.from_surfaces, low, SurroundingsRecord::MS, &outside_[b * kRecords]);
            put(medium, sources.from_emitters, low, SurroundingsRecord::MA, &outside_[b * kRecords]);
        }
        if (similar) {
            put_extinction(*similar, low, &similar_[b * kRecords]);
            put(*similar, direct_ ? similar->emission : similar->source, low, SimilarRecord::V,
                &similar_[b * kRecords]);
        }
        for (int i = 0; i < kRecords; ++i) {
            const ivec3 node = low + ivec3(i / (kSide * kSide), i / kSide % kSide, i % kSide);
            const std::int64_t n = medium.lattice.find_node(node);
            const Rgb albedo = n < 0 ? medium.albedo : medium.albedo_at(n);
            records[i].value[SourceRecord::Albedo] = luminance(albedo);
            for (int c = 0; similar && c < 3; ++c)
                similar_[b * kRecords + i].value[SimilarRecord::Forward + c] = forward * albedo[c];
        }
    });
}

float SourceField::majorant_of_voxel(std::size_t brick, const ivec3& voxel) const {
    const SourceRecord* r = &records_[brick * kRecords + std::size_t((voxel.x * kSide + voxel.y) * kSide + voxel.z)];
    float most = 0.0f;
    for (int k = 0; k < 8; ++k)
        most = std::max(most, r[((k >> 2) * kSide + (k >> 1 & 1)) * kSide + (k & 1)].value[SourceRecord::Extinction]);
    return most;
}

SourceRecord SourceField::sample(std::size_t brick, const vec3& p) const {
    return interpolated(&records_[brick * kRecords], p);
}

SurroundingsRecord SourceField::sample_outside(std::size_t brick, const vec3& p) const {
    return interpolated(&outside_[brick * kRecords], p);
}

SimilarRecord SourceField::sample_similar(std::size_t brick, const vec3& p) const {
    return interpolated(&similar_[brick * kRecords], p);
}

}  // namespace brisance
