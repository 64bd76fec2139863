// Large arrays keep what is put into them, however they grow, and lie where large pages can be.
#include "shadows/large_vector.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>

namespace brisance {
namespace {

TEST(LargeVector, KeepsItsValuesAsItGrows) {
    LargeVector<std::uint16_t> v;
    std::size_t filled = 0;
    for (const std::size_t size :
         {std::size_t{10}, std::size_t{100'000}, std::size_t{5'000'000}, std::size_t{9'000'000}}) {
        v.resize(size);
        for (; filled < size; ++filled)
            v[filled] = std::uint16_t(filled * 7);
        for (std::size_t i = 0; i < size; i += 997)
            ASSERT_EQ(v[i], std::uint16_t(i * 7));
    }
    const LargeVector<std::uint16_t> copy = v;
    EXPECT_EQ(copy, v);
    v.resize(3);
    v.shrink_to_fit();
    EXPECT_EQ(v[2], std::uint16_t(14));
}

TEST(LargeVector, LiesAtLargePages) {
    const LargeVector<std::uint16_t> v(10'000'000, std::uint16_t{5});
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(v.data()) % (std::uintptr_t{2} << 20), 0u);
    EXPECT_EQ(std::accumulate(v.begin(), v.end(), std::uint64_t{0}), 50'000'000u);
}

}  // namespace
}  // namespace brisance
