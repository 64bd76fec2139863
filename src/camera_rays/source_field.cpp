#include "camera_rays/source_field.h"

#include <algorithm>
#include <memory>

#include "core/parallel.h"
#include "medium/lattice/voxel_walk.h"

namespace brisance {

namespace {

constexpr int kNodesAside = SourceField::kSide, kNodes = SourceField::kRecords;

// Calls visit(record, node) for those nodes of a lattice that a brick's records stand for; `low` is the first of them.
template <class Visit>
void for_nodes(const BrickLattice& lattice, const ivec3& low, const Visit& visit) {
    constexpr int kSize = BrickLattice::kSize;
    const ivec3 end = low + kNodesAside, first = low >> 3, last = (end - 1) >> 3;
    for (int b = 0; b < 8; ++b) {
        const ivec3 place = first + ivec3(b >> 2, b >> 1 & 1, b & 1);
        const int brick = glm::all(glm::lessThanEqual(place, last)) ? lattice.find(place) : -1;
        if (brick < 0)
            continue;
        const ivec3 from = glm::max(low, place * kSize), to = glm::min(end, (place + 1) * kSize);
        const std::size_t nodes = std::size_t(brick) * BrickLattice::kNodes;
        for (int x = from.x; x < to.x; ++x)
            for (int y = from.y; y < to.y; ++y) {
                const std::size_t record = std::size_t((x - low.x) * kNodesAside + y - low.y) * kNodesAside,
                                  node = nodes + std::size_t(BrickLattice::offset_in_brick({x, y, from.z}));
                for (int z = from.z; z < to.z; ++z)
                    visit(record + std::size_t(z - low.z), node + std::size_t(z - from.z));
            }
    }
}

// A node's value; 0 where the field is empty.
void put(const std::vector<Rgb>& field, std::size_t node, float* to) {
    for (int c = 0; c < 3; ++c)
        to[c] = field.empty() ? 0.0f : field[node][c];
}

const std::vector<Rgb> kNoLight;

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
            std::array<float, kNodes> extinction{};
            for_nodes(medium.lattice, bricks_.first_node(b),
                      [&](std::size_t i, std::size_t node) { extinction[i] = medium.extinction[node]; });
            const auto [least, greatest] = std::minmax_element(extinction.begin(), extinction.end());
            minimum_[b] = *least;
            majorant_[b] = *greatest;
        },
        16);
}

SourceField::SourceField(const Medium& medium) : SourceField(medium, nullptr, nullptr, 0.0f) {}

SourceField::SourceField(const Medium& medium, const NodeSources& sources, const Medium* similar, float forward)
    : SourceField(medium, &sources, similar, forward) {}

void SourceField::put_own(BrickRecords& out, const ivec3& low) const {
    const std::vector<Rgb>&fire = direct_ ? medium_->emission : medium_->source,
          &single = sources_ ? sources_->single : kNoLight, &multiple = sources_ ? sources_->multiple : kNoLight;
    for (SourceRecord& r : out.own)
        r.value[SourceRecord::Albedo] = luminance(medium_->albedo);
    for_nodes(medium_->lattice, low, [&](std::size_t i, std::size_t node) {
        float* const own = out.own[i].value;
        own[SourceRecord::Extinction] = medium_->extinction[node];
        put(fire, node, own + SourceRecord::V);
        put(single, node, own + SourceRecord::MV);
        put(multiple, node, own + SourceRecord::MM);
        own[SourceRecord::Albedo] = luminance(medium_->albedo_at(node));
    });
}

void SourceField::put_outside(BrickRecords& out, const ivec3& low) const {
    out.outside.resize(kRecords);
    for_nodes(medium_->lattice, low, [&](std::size_t i, std::size_t node) {
        put(sources_->from_surfaces, node, out.outside[i].value + SurroundingsRecord::MS);
        put(sources_->from_emitters, node, out.outside[i].value + SurroundingsRecord::MA);
    });
}

void SourceField::put_similar(BrickRecords& out, const ivec3& low) const {
    out.similar.resize(kRecords);
    const auto put_forward = [&](std::size_t i, const Rgb& albedo) {
        for (int c = 0; c < 3; ++c)
            out.similar[i].value[SimilarRecord::Forward + c] = forward_ * albedo[c];
    };
    for (std::size_t i = 0; i < kRecords; ++i)
        put_forward(i, medium_->albedo);
    for_nodes(medium_->lattice, low,
              [&](std::size_t i, std::size_t node) { put_forward(i, medium_->albedo_at(node)); });
    const std::vector<Rgb>& fire = direct_ ? similar_->emission : similar_->source;
    for_nodes(similar_->lattice, low, [&](std::size_t i, std::size_t node) {
        out.similar[i].value[SimilarRecord::Extinction] = similar_->extinction[node];
        put(fire, node, out.similar[i].value + SimilarRecord::V);
    });
}

std::unique_ptr<SourceField::BrickRecords> SourceField::new_records(std::size_t brick) const {
    auto out = std::make_unique<BrickRecords>();
    const ivec3 low = bricks_.first_node(brick);
    put_own(*out, low);
    if (outside_)
        put_outside(*out, low);
    if (similar_ != nullptr)
        put_similar(*out, low);
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
