// A sparse lattice can be read at every node of index space, stored or not.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "core/error.h"
#include "core/rng.h"
#include "medium/lattice/brick_lattice.h"

namespace brisance {
namespace {

std::vector<ivec3> scattered_bricks(int count, int reach) {
    Rng rng(Stream::EscapeRay, 17);
    const auto coordinate = [&] { return static_cast<int>(rng.next() * (2 * reach + 1)) - reach; };
    std::vector<ivec3> bricks;
    for (int i = 0; i < count; ++i) {
        const int x = coordinate(), y = coordinate(), z = coordinate();
        bricks.emplace_back(x, y, z);
    }
    return bricks;
}

ivec3 node_of(const BrickLattice& lattice, std::size_t i) {
    return lattice.first_node(i / BrickLattice::kNodes) + BrickLattice::node_in_brick(int(i % BrickLattice::kNodes));
}

using Key = std::tuple<int, int, int>;
Key key(const ivec3& p) {
    return {p.x, p.y, p.z};
}

std::set<Key> keys(const std::vector<ivec3>& points) {
    std::set<Key> set;
    for (const ivec3& p : points)
        set.insert(key(p));
    return set;
}

std::set<Key> bricks_of(const BrickLattice& lattice) {
    std::set<Key> set;
    for (std::size_t b = 0; b < lattice.brick_count(); ++b)
        set.insert(key(lattice.brick(b)));
    return set;
}

TEST(BrickLattice, EveryNodeIsFoundWhereItIsStoredAndNoOther) {
    const std::vector<ivec3> bricks = scattered_bricks(40, 3);
    const BrickLattice lattice(bricks);
    EXPECT_EQ(bricks_of(lattice), keys(bricks));
    for (std::size_t i = 0; i < lattice.node_count(); ++i)
        ASSERT_EQ(lattice.find_node(node_of(lattice, i)), static_cast<std::int64_t>(i));
    const std::set<Key> stored = keys(bricks);
    for (int x = -5; x <= 5; ++x)
        for (int y = -5; y <= 5; ++y)
            for (int z = -5; z <= 5; ++z)
                ASSERT_EQ(lattice.find({x, y, z}) >= 0, stored.count({x, y, z}) == 1);
}

TEST(BrickLattice, NeitherOrderNorRepetitionOfBricksMatters) {
    std::vector<ivec3> bricks = scattered_bricks(30, 2);
    const BrickLattice once(bricks);
    std::reverse(bricks.begin(), bricks.end());
    bricks.insert(bricks.end(), bricks.begin(), bricks.begin() + 10);
    const BrickLattice again(bricks);
    ASSERT_EQ(once.brick_count(), again.brick_count());
    for (std::size_t b = 0; b < once.brick_count(); ++b)
        EXPECT_EQ(once.brick(b), again.brick(b));
}

TEST(BrickLattice, AnEmptyLatticeHoldsNothing) {
    const BrickLattice lattice(std::vector<ivec3>{});
    EXPECT_TRUE(lattice.empty());
    EXPECT_EQ(lattice.find({0, 0, 0}), -1);
    EXPECT_EQ(lattice.find_node({0, 0, 0}), -1);
}

TEST(BrickLattice, ABoxOfNodesReadsZeroWhereNothingIsStored) {
    const BrickLattice lattice(scattered_bricks(25, 2));
    std::vector<float> field(lattice.node_count() * 2);
    for (std::size_t i = 0; i < field.size(); ++i)
        field[i] = static_cast<float>(i + 1);
    const ivec3 low(-21, -3, -13), size(37, 11, 22);
    const std::size_t plane = std::size_t(size.x) * size.y * size.z;
    std::vector<float> box(plane * 2, -1.0f);
    copy_box(lattice, field, 2, low, size, box);
    for (int x = 0; x < size.x; ++x)
        for (int y = 0; y < size.y; ++y)
            for (int z = 0; z < size.z; ++z)
                for (int c = 0; c < 2; ++c) {
                    const std::int64_t i = lattice.find_node(low + ivec3(x, y, z));
                    ASSERT_EQ(box[c * plane + (std::size_t(x) * size.y + y) * size.z + z],
                              i < 0 ? 0.0f : field[i * 2 + c]);
                }
}

TEST(BrickLattice, BricksAroundAreThoseWithinReachOfAMark) {
    const BrickLattice lattice(scattered_bricks(12, 2));
    std::vector<std::uint8_t> marked(lattice.node_count(), 0);
    Rng rng(Stream::EscapeRay, 5);
    for (int i = 0; i < 9; ++i)
        marked[static_cast<std::size_t>(rng.next() * marked.size())] = 1;
    for (int radius : {0, 1, 3, 8}) {
        std::set<Key> expected;
        for (std::size_t i = 0; i < marked.size(); ++i)
            if (marked[i]) {
                const ivec3 low = (node_of(lattice, i) - radius) >> 3, high = (node_of(lattice, i) + radius) >> 3;
                for (int x = low.x; x <= high.x; ++x)
                    for (int y = low.y; y <= high.y; ++y)
                        for (int z = low.z; z <= high.z; ++z)
                            expected.insert({x, y, z});
            }
        EXPECT_EQ(keys(bricks_around(lattice, marked, radius)), expected) << "radius " << radius;
    }
}

TEST(BrickLattice, EveryCoarseHatThatHoldsAFineNodeHasAVertex) {
    const BrickLattice fine(scattered_bricks(10, 2));
    const BrickLattice coarse = coarse_lattice(fine);
    for (std::size_t i = 0; i < fine.node_count(); ++i) {
        const ivec3 node = node_of(fine, i);
        for (int k = 0; k < 27; ++k) {
            const ivec3 vertex = (node >> 1) + ivec3(k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1);
            const ivec3 away = glm::abs(vertex * 2 - node);
            if (std::max({away.x, away.y, away.z}) <= 1) {
                ASSERT_GE(coarse.find_node(vertex), 0);
            }
        }
    }
}

TEST(BrickLattice, AStrayVoxelFarAwayIsAnErrorThatSaysSo) {
    try {
        const BrickLattice lattice({{0, 0, 0}, {1 << 20, 1 << 20, 1 << 20}});
        FAIL() << "indexed " << lattice.brick_count() << " bricks";
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::BadData);
        EXPECT_NE(std::string(e.what()).find("stray voxels"), std::string::npos) << e.what();
    }
}

}  // namespace
}  // namespace brisance
