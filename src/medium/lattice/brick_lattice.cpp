#include "medium/lattice/brick_lattice.h"

#include <algorithm>
#include <string>
#include <tuple>

#include "core/error.h"
#include "core/parallel.h"

namespace brisance {

namespace {

constexpr std::uint64_t kMaxDirectory = std::uint64_t{1} << 28;  // 1 GiB of entries

bool comes_before(const ivec3& a, const ivec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

}  // namespace

BrickLattice::BrickLattice(std::vector<ivec3> bricks) : bricks_(std::move(bricks)) {
    std::sort(bricks_.begin(), bricks_.end(), comes_before);
    bricks_.erase(std::unique(bricks_.begin(), bricks_.end()), bricks_.end());
    if (bricks_.empty())
        return;
    min_ = bricks_.front();
    ivec3 max = min_;
    for (const ivec3& b : bricks_) {
        min_ = glm::min(min_, b);
        max = glm::max(max, b);
    }
    const glm::i64vec3 wide = glm::i64vec3(max) - glm::i64vec3(min_) + glm::i64vec3(1);
    const double entries = double(wide.x) * double(wide.y) * double(wide.z);
    if (entries > double(kMaxDirectory))
        throw Error(ExitCode::BadData,
                    "the volume's bounding box is " + std::to_string(wide.x * kSize) + " x " +
                        std::to_string(wide.y * kSize) + " x " + std::to_string(wide.z * kSize) +
                        " voxels, too large to index: remove stray voxels far from the fire or clip the grid");
    extent_ = ivec3(wide);
    directory_.assign(static_cast<std::size_t>(entries), -1);
    for (std::size_t i = 0; i < bricks_.size(); ++i) {
        const ivec3 r = bricks_[i] - min_;
        directory_[(static_cast<std::size_t>(r.x) * extent_.y + r.y) * extent_.z + r.z] = static_cast<std::int32_t>(i);
    }
}

namespace {

// One brick's share of copy_box.
void copy_brick(std::span<const float> values, int channels, const ivec3& first, const ivec3& low, const ivec3& size,
                std::span<float> out) {
    const ivec3 from = glm::max(first, low);
    const ivec3 to = glm::min(first + BrickLattice::kSize, low + size);
    const std::size_t plane = static_cast<std::size_t>(size.x) * size.y * size.z;
    for (int x = from.x; x < to.x; ++x)
        for (int y = from.y; y < to.y; ++y) {
            const float* src = &values[BrickLattice::offset_in_brick({x, y, from.z}) * channels];
            float* dst = &out[(static_cast<std::size_t>(x - low.x) * size.y + (y - low.y)) * size.z + (from.z - low.z)];
            for (int z = 0; z < to.z - from.z; ++z)
                for (int c = 0; c < channels; ++c)
                    dst[c * plane + z] = src[z * channels + c];
        }
}

}  // namespace

void copy_box(const BrickLattice& lattice, std::span<const float> field, int channels, const ivec3& low,
              const ivec3& size, std::span<float> out) {
    const std::size_t plane = static_cast<std::size_t>(size.x) * size.y * size.z;
    std::fill(out.begin(), out.begin() + plane * channels, 0.0f);
    const ivec3 first = low >> 3;
    const ivec3 last = (low + size - 1) >> 3;
    for (int x = first.x; x <= last.x; ++x)
        for (int y = first.y; y <= last.y; ++y)
            for (int z = first.z; z <= last.z; ++z) {
                const int b = lattice.find({x, y, z});
                if (b < 0)
                    continue;
                const std::size_t count = std::size_t{BrickLattice::kNodes} * channels;
                copy_brick(field.subspan(b * count, count), channels, lattice.first_node(b), low, size, out);
            }
}

BrickLattice coarse_lattice(const BrickLattice& fine) {
    std::vector<ivec3> bricks;
    for (std::size_t b = 0; b < fine.brick_count(); ++b) {
        const ivec3 first = (fine.first_node(b) - 1) >> 4;
        const ivec3 last = (fine.first_node(b) + BrickLattice::kSize) >> 4;
        for (int x = first.x; x <= last.x; ++x)
            for (int y = first.y; y <= last.y; ++y)
                for (int z = first.z; z <= last.z; ++z)
                    bricks.emplace_back(x, y, z);
    }
    return BrickLattice(std::move(bricks));
}

std::vector<ivec3> bricks_around(const BrickLattice& lattice, const std::vector<std::uint8_t>& marked, int radius) {
    // Per brick, the 27 neighbours that a marked node reaches.
    std::vector<std::uint32_t> reached(lattice.brick_count(), 0);
    parallel_for(
        lattice.brick_count(),
        [&](std::size_t b) {
            for (int n = 0; n < BrickLattice::kNodes; ++n) {
                if (!marked[b * BrickLattice::kNodes + n])
                    continue;
                const ivec3 p = BrickLattice::node_in_brick(n);
                for (int k = 0; k < 27; ++k) {
                    const ivec3 d(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1);
                    bool reach = true;
                    for (int a = 0; a < 3; ++a)
                        reach = reach && (d[a] == 0 || (d[a] < 0 ? p[a] - radius < 0 : p[a] + radius > 7));
                    reached[b] |= std::uint32_t{reach} << k;
                }
            }
        },
        16);
    std::vector<ivec3> bricks;
    for (std::size_t b = 0; b < lattice.brick_count(); ++b)
        for (int k = 0; k < 27; ++k)
            if (reached[b] >> k & 1u)
                bricks.push_back(lattice.brick(b) + ivec3(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1));
    return bricks;
}

}  // namespace brisance
