#include "gathering/local_ratios.h"

#include "core/parallel.h"

namespace brisance {

namespace {

// So many nodes are needed to know a ratio: of all bricks, and around a corner.
constexpr double kFewNodes = 256.0, kFewAround = 16.0;

ivec3 corner(int k) {
    return {k >> 2, k >> 1 & 1, k & 1};
}

}  // namespace

LocalRatios::LocalRatios(const BrickLattice& lattice) : lattice_(lattice), sums_(lattice.brick_count()) {}

void LocalRatios::Sums::add(const Sums& other) {
    above += other.above;
    below += other.below;
    count += other.count;
}

Rgb LocalRatios::Sums::ratio(const Rgb& general, double nodes) const {
    Rgb out = general;
    for (int c = 0; c < 3; ++c)
        if (below[c] > 0.0)
            out[c] = float((count * above[c] / below[c] + nodes * general[c]) / (count + nodes));
    return out;
}

std::vector<LocalRatios::Corners> LocalRatios::at_corners() const {
    Sums all;
    for (const Sums& s : sums_)
        all.add(s);
    const Rgb general = all.ratio(Rgb(0.0f), kFewNodes);
    std::vector<Corners> out(sums_.size());
    parallel_for(
        out.size(),
        [&](std::size_t b) {
            for (int k = 0; k < 8; ++k) {
                Sums around;
                for (int n = 0; n < 8; ++n)
                    if (const int brick = lattice_.find(lattice_.brick(b) + corner(k) + corner(n) - 1); brick >= 0)
                        around.add(sums_[std::size_t(brick)]);
                out[b][std::size_t(k)] = around.ratio(general, kFewAround);
            }
        },
        64);
    return out;
}

Rgb LocalRatios::at_node(const Corners& corners, const ivec3& node) {
    const vec3 part = (vec3(node) + 0.5f) / float(BrickLattice::kSize);
    const auto along_z = [&](int k) { return glm::mix(corners[std::size_t(k)], corners[std::size_t(k + 1)], part.z); };
    const auto along_y = [&](int k) { return glm::mix(along_z(k), along_z(k + 2), part.y); };
    return glm::mix(along_y(0), along_y(4), part.x);
}

}  // namespace brisance
