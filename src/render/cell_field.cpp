#include "render/cell_field.h"

#include <algorithm>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr int kSide = BrickLattice::kSize + 1;
constexpr int kRecords = kSide * kSide * kSide;

// Bricks whose cells touch a node that absorbs or emits.
BrickLattice lit_cells(const Medium& medium) {
    std::vector<ivec3> bricks;
    for (std::size_t b = 0; b < medium.lattice.brick_count(); ++b) {
        bool lower[3] = {};  // a node of the lowest plane of an axis is not empty
        bool any = false;
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const std::size_t i = b * BrickLattice::kNodes + n;
            if (medium.extinction[i] == 0.0f && (medium.emission.empty() || medium.emission[i] == Rgb(0.0f)))
                continue;
            any = true;
            const ivec3 p = BrickLattice::node_in_brick(n);
            for (int a = 0; a < 3; ++a)
                lower[a] = lower[a] || p[a] == 0;
        }
        for (int k = 0; any && k < 8; ++k)
            if ((!(k & 1) || lower[0]) && (!(k & 2) || lower[1]) && (!(k & 4) || lower[2]))
                bricks.push_back(medium.lattice.brick(b) - ivec3(k & 1, k >> 1 & 1, k >> 2 & 1));
    }
    return BrickLattice(std::move(bricks));
}

void put(const Medium& medium, const std::vector<Rgb>& field, const ivec3& low, int slot, CellRecord* records) {
    if (field.empty())
        return;
    std::vector<float> box(3 * kRecords);
    copy_box(medium.lattice, {reinterpret_cast<const float*>(field.data()), field.size() * 3}, 3, low, ivec3(kSide),
             box);
    for (int i = 0; i < kRecords; ++i)
        for (int c = 0; c < 3; ++c)
            records[i].value[slot + c] = box[c * kRecords + i];
}

}  // namespace

CellField::CellField(const Medium& medium, const std::vector<Rgb>& single, const std::vector<Rgb>& multiple)
    : medium_(&medium), direct_(!medium.emission.empty()), bricks_(lit_cells(medium)) {
    records_.resize(bricks_.brick_count() * kRecords, CellRecord{});
    minimum_.resize(bricks_.brick_count());
    majorant_.resize(bricks_.brick_count());
    parallel_for(bricks_.brick_count(), [&](std::size_t b) {
        CellRecord* records = &records_[b * kRecords];
        const ivec3 low = bricks_.first_node(b);
        std::vector<float> box(kRecords);
        copy_box(medium.lattice, medium.extinction, 1, low, ivec3(kSide), box);
        for (int i = 0; i < kRecords; ++i)
            records[i].value[CellRecord::Extinction] = box[i];
        const auto [least, greatest] = std::minmax_element(box.begin(), box.end());
        minimum_[b] = *least;
        majorant_[b] = *greatest;
        put(medium, direct_ ? medium.emission : medium.source, low, CellRecord::V, records);
        put(medium, single, low, CellRecord::MV, records);
        put(medium, multiple, low, CellRecord::MM, records);
        for (int i = 0; i < kRecords; ++i) {
            const ivec3 node = low + ivec3(i / (kSide * kSide), i / kSide % kSide, i % kSide);
            const std::int64_t n = medium.lattice.find_node(node);
            records[i].value[CellRecord::Albedo] = luminance(n < 0 ? medium.albedo : medium.albedo_at(n));
        }
    });
}

CellRecord CellField::sample(std::size_t brick, const vec3& p) const {
    const ivec3 base = glm::min(ivec3(p), ivec3(BrickLattice::kSize - 1));
    const vec3 f = p - vec3(base);
    const CellRecord* r = &records_[brick * kRecords + (base.x * kSide + base.y) * kSide + base.z];
    CellRecord out{};
    for (int k = 0; k < 8; ++k) {
        const float w = (k & 4 ? f.x : 1 - f.x) * (k & 2 ? f.y : 1 - f.y) * (k & 1 ? f.z : 1 - f.z);
        const CellRecord& corner = r[((k >> 2) * kSide + (k >> 1 & 1)) * kSide + (k & 1)];
        for (int i = 0; i < CellRecord::Size; ++i)
            out.value[i] += w * corner.value[i];
    }
    return out;
}

}  // namespace brisance
