// A volume too large for the memory that there is: refused before it is lit, in one line that says what would help.
#include <gtest/gtest.h>

#include "core/error.h"
#include "fixtures/media.h"
#include "forecast/memory_need.h"

namespace brisance::test_memory_need {
namespace {

using namespace testing;

constexpr std::uint64_t kMaps = std::uint64_t{2} << 30;

TEST(MemoryNeed, GrowsWithTheNodesAndWithTheDirectionsOfLight) {
    const Medium small = make_medium(glowing_ball(10, 1.0f)), large = make_medium(glowing_ball(20, 1.0f));
    EXPECT_GT(bytes_to_light(large, false, kMaps), 2 * bytes_to_light(small, false, kMaps));
    EXPECT_GT(bytes_to_light(small, true, kMaps), bytes_to_light(small, false, kMaps));
    EXPECT_GT(bytes_to_light(small, false, kMaps), bytes_to_light(small, false, 0));
}

TEST(MemoryNeed, FallsWhereLightHasACoarserLattice) {
    const Medium medium = make_medium(glowing_ball(40, 1.0f));
    const std::uint64_t own = bytes_to_light(medium, false, kMaps), twice = bytes_to_light(medium, false, kMaps, 1);
    EXPECT_LT(twice, own / 2);
    EXPECT_GT(twice, own / 16) << "the camera keeps what it sees of every node";
}

TEST(MemoryNeed, IsRefusedWhereItIsMoreThanThereIs) {
    const Medium medium = make_medium(glowing_ball(10, 1.0f));
    const std::uint64_t needed = bytes_to_light(medium, false, kMaps);
    EXPECT_NO_THROW(check_memory(medium, needed, needed));
    EXPECT_NO_THROW(check_memory(medium, needed, std::nullopt)) << "not known";
    try {
        check_memory(medium, needed, needed - 1);
        FAIL() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Temporary);
        const std::string line = error.what();
        EXPECT_NE(line.find("lighting.memory_limit_mebibytes"), std::string::npos) << line;
        EXPECT_NE(line.find("lighting.lattice_level"), std::string::npos) << line;
        EXPECT_NE(line.find("method=path"), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos);
    }
}

}  // namespace
}  // namespace brisance::test_memory_need
