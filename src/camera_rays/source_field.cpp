#include "camera_rays/source_field.h"

#include <algorithm>
#include <memory>

#include "core/parallel.h"
#include "medium/lattice/voxel_walk.h"

namespace brisance {

namespace {

constexpr int kNodesAside = SourceField::kSide, kNodes = SourceField::kRecords;

std::vector<float> around_brick(const BrickLattice& lattice, std::span<const float> field, int channels,
                                const ivec3& low) {
    std::vector<float> box(static_cast<std::size_t>(channels) * kNodes);
    copy_box(lattice, field, channels, low, ivec3(kNodesAside), box);
    return box;
}

template <class Record>
void put(const Medium& medium, const std::vector<Rgb>& field, const ivec3& low, int slot, Record* records) {
    if (field.empty())
        return;
    const std::vector<float> box =
        around_brick(medium.lattice, {reinterpret_cast<const float*>(field.data()), field.size() * 3}, 3, low);
    for (int i = 0; i < kNodes; ++i)
        for (int c = 0; c < 3; ++c)
            records[i].value[slot + c] = box[c * kNodes + i];
}

template <class Record>
void put_extinction(const Medium& medium, const ivec3& low, Record* records) {
    const std::vector<float> box = around_brick(medium.lattice, medium.extinction, 1, low);
    for (int i = 0; i < kNodes; ++i)
        records[i].value[Record::Extinction] = box[i];
}

bool light_from_outside(const NodeSources* sources) {
    return sources != nullptr && (!sources->from_surfaces.empty() || !sources->from_emitters.empty());
}

}  // namespace

SourceField::SourceField(const Medium& medium, const NodeSources* sources, const Medium* similar, float forward)
    : medium_(&medium),
      sources_(sources),
      similar_(similar),
      forward_(forward),
      direct_(!medium.emission.empty()),
      outside_(light_from_outside(sources)),
      bricks_(voxel_lattice(medium)),
      minimum_(bricks_.brick_count()),
      majorant_(bricks_.brick_count()),
      made_(bricks_.brick_count()) {
    parallel_for(
        bricks_.brick_count(),
        [&](std::size_t b) {
            const std::vector<float> extinction =
                around_brick(medium.lattice, medium.extinction, 1, bricks_.first_node(b));
            const auto [least, greatest] = std::minmax_element(extinction.begin(), extinction.end());
            minimum_[b] = *least;
            majorant_[b] = *greatest;
        },
        16);
}

SourceField::SourceField(const Medium& medium) : SourceField(medium, nullptr, nullptr, 0.0f) {}

SourceField::SourceField(const Medium& medium, const NodeSources& sources, const Medium* similar, float forward)
    : SourceField(medium, &sources, similar, forward) {}

void SourceField::put_similar(BrickRecords& out, const ivec3& low) const {
    out.similar.resize(kRecords);
    put_extinction(*similar_, low, out.similar.data());
    put(*similar_, direct_ ? similar_->emission : similar_->source, low, SimilarRecord::V, out.similar.data());
}

std::unique_ptr<SourceField::BrickRecords> SourceField::new_records(std::size_t brick) const {
    auto out = std::make_unique<BrickRecords>();
    SourceRecord* const own = out->own.data();
    const ivec3 low = bricks_.first_node(brick);
    put_extinction(*medium_, low, own);
    put(*medium_, direct_ ? medium_->emission : medium_->source, low, SourceRecord::V, own);
    if (sources_ != nullptr) {
        put(*medium_, sources_->single, low, SourceRecord::MV, own);
        put(*medium_, sources_->multiple, low, SourceRecord::MM, own);
    }
    if (outside_) {
        out->outside.resize(kRecords);
        put(*medium_, sources_->from_surfaces, low, SurroundingsRecord::MS, out->outside.data());
        put(*medium_, sources_->from_emitters, low, SurroundingsRecord::MA, out->outside.data());
    }
    if (similar_ != nullptr)
        put_similar(*out, low);
    for (int i = 0; i < kRecords; ++i) {
        const ivec3 node = low + ivec3(i / (kSide * kSide), i / kSide % kSide, i % kSide);
        const std::int64_t n = medium_->lattice.find_node(node);
        const Rgb albedo = n < 0 ? medium_->albedo : medium_->albedo_at(n);
        own[i].value[SourceRecord::Albedo] = luminance(albedo);
        for (int c = 0; similar_ != nullptr && c < 3; ++c)
            out->similar[i].value[SimilarRecord::Forward + c] = forward_ * albedo[c];
    }
    return out;
}

// Where no ray of the camera has come, all records are made for a moment.
void SourceField::put_secondary(std::size_t brick, std::array<SecondaryRecord, kRecords>& out) const {
    std::unique_ptr<const BrickRecords> own;
    const BrickRecords* all = made_.find(brick);
    if (all == nullptr) {
        own = new_records(brick);
        all = own.get();
    }
    for (int i = 0; i < kRecords; ++i) {
        const float* const from = all->own[i].value;
        float* const to = out[i].value;
        to[SecondaryRecord::Extinction] = from[SourceRecord::Extinction];
        to[SecondaryRecord::Size - 1] = 0.0f;
        for (int c = 0; c < 3; ++c) {
            to[SecondaryRecord::V + c] = from[SourceRecord::V + c];
            to[SecondaryRecord::Scattered + c] = from[SourceRecord::MV + c] + from[SourceRecord::MM + c];
            if (outside_)
                to[SecondaryRecord::Scattered + c] +=
                    all->outside[i].value[SurroundingsRecord::MS + c] +
                    emitters_share() * all->outside[i].value[SurroundingsRecord::MA + c];
        }
    }
}

std::uint64_t SourceField::bytes() const {
    const std::uint64_t of_brick = sizeof(BrickRecords) + kRecords * (has_similar() ? sizeof(SimilarRecord) : 0) +
                                   kRecords * (has_outside() ? sizeof(SurroundingsRecord) : 0);
    return made_.made() * of_brick + made_.bytes_of_places() + 2 * minimum_.size() * sizeof(float) + bricks_.bytes();
}

float SourceField::majorant_of_voxel(std::size_t brick, const ivec3& voxel) const {
    const SourceRecord* r =
        &records(brick).own[static_cast<std::size_t>((voxel.x * kSide + voxel.y) * kSide + voxel.z)];
    float most = 0.0f;
    for (int k = 0; k < 8; ++k)
        most = std::max(most, r[((k >> 2) * kSide + (k >> 1 & 1)) * kSide + (k & 1)].value[SourceRecord::Extinction]);
    return most;
}

SourceRecord SourceField::sample(std::size_t brick, const vec3& p) const {
    return interpolated(records(brick).own.data(), p);
}

SurroundingsRecord SourceField::sample_outside(std::size_t brick, const vec3& p) const {
    return interpolated(records(brick).outside.data(), p);
}

SimilarRecord SourceField::sample_similar(std::size_t brick, const vec3& p) const {
    return interpolated(records(brick).similar.data(), p);
}

}  // namespace brisance
