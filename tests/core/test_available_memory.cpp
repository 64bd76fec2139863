// How much memory is left is what the system says: the machine's, or less where a control group has a limit.
#include <gtest/gtest.h>

#include "core/available_memory.h"
#include "volume/temp_folder.h"

namespace brisance {
namespace {

void put(const std::filesystem::path& file, const std::string& text) {
    std::filesystem::create_directories(file.parent_path());
    write_bytes(file, text);
}

TEST(AvailableMemory, IsSaidByTheSystemItself) {
    const auto bytes = available_memory();
    ASSERT_TRUE(bytes.has_value());
    EXPECT_GT(*bytes, std::uint64_t{16} << 20);
}

TEST(AvailableMemory, IsTheMachinesWithoutALimit) {
    const TempFolder folder;
    EXPECT_FALSE(available_memory_in(folder.path()).has_value());
    put(folder.path() / "proc/meminfo", "MemTotal:  1000 kB\nMemFree:   10 kB\nMemAvailable:  600 kB\n");
    EXPECT_EQ(available_memory_in(folder.path()), 600u * 1024);
    put(folder.path() / "sys/fs/cgroup/memory.max", "max\n");
    put(folder.path() / "sys/fs/cgroup/memory.current", "4096\n");
    EXPECT_EQ(available_memory_in(folder.path()), 600u * 1024);
}

TEST(AvailableMemory, IsWhatTheGroupsLimitLeaves) {
    const TempFolder folder;
    put(folder.path() / "proc/meminfo", "MemAvailable:  600 kB\n");
    put(folder.path() / "sys/fs/cgroup/memory.max", "500000\n");
    put(folder.path() / "sys/fs/cgroup/memory.current", "300000\n");
    EXPECT_EQ(available_memory_in(folder.path()), 200000u);
    put(folder.path() / "sys/fs/cgroup/memory.stat", "anon 1\ninactive_file 50000\nactive_file 2\n");
    EXPECT_EQ(available_memory_in(folder.path()), 250000u);
    put(folder.path() / "sys/fs/cgroup/memory.current", "600000\n");
    EXPECT_EQ(available_memory_in(folder.path()), 0u) << "the group is over its limit";
}

}  // namespace
}  // namespace brisance
