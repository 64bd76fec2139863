// Results that processes keep for each other: found whole or not at all.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>

#include "farm/cache_folder.h"
#include "volume/temp_folder.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kPlenty = 1 << 30;

class Warnings : public Progress {
public:
    void warning(const std::string&, const std::string& line) override { lines.push_back(line); }
    std::vector<std::string> lines;
};

std::vector<fs::path> results_in(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        files.push_back(entry.path());
    return files;
}

std::uint64_t bytes_in(const fs::path& folder) {
    std::uint64_t bytes = 0;
    for (const fs::path& file : results_in(folder))
        bytes += fs::file_size(file);
    return bytes;
}

const std::string kBinary("a\0\n\xff 7", 6);

TEST(CacheFolder, HandsOnWhatWasKept) {
    const TempFolder temp;
    Warnings warnings;
    CacheFolder first(temp / "new/cache", kPlenty, warnings);
    EXPECT_EQ(first.find("a key"), std::nullopt);
    first.keep("a key", kBinary);
    first.keep("another", "");
    CacheFolder second(temp / "new/cache", kPlenty, warnings);
    EXPECT_EQ(second.find("a key"), kBinary);
    EXPECT_EQ(second.find("another"), "");
    EXPECT_EQ(second.find("a third"), std::nullopt);
    EXPECT_EQ(second.found(), 2u);
    EXPECT_TRUE(warnings.lines.empty());
}

// Every byte that is changed, and every length that is cut off.
TEST(CacheFolder, DamageIsToldAndMended) {
    const TempFolder temp;
    Warnings warnings;
    CacheFolder cache(temp.path(), kPlenty, warnings);
    cache.keep("key", "a value");
    const fs::path file = results_in(temp.path()).front();
    std::ifstream in(file, std::ios::binary);
    const std::string whole(std::istreambuf_iterator<char>(in), {});
    std::size_t expected = 0;
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string changed = whole;
        changed[i] ^= 1;
        for (const std::string& bytes : {changed, whole.substr(0, i)}) {
            write_bytes(file, bytes);
            EXPECT_EQ(cache.find("key"), std::nullopt) << i;
            EXPECT_EQ(warnings.lines.size(), ++expected) << i;
            EXPECT_FALSE(fs::exists(file));
        }
    }
    cache.keep("key", "a value");
    EXPECT_EQ(cache.find("key"), "a value");
}

TEST(CacheFolder, IsBounded) {
    const TempFolder temp;
    Warnings warnings;
    constexpr std::uint64_t most = 100'000;
    CacheFolder cache(temp.path(), most, warnings);
    const std::string value(9'000, 'v');
    cache.keep("used again and again", value);
    for (int i = 0; i < 40; ++i) {
        cache.keep(std::to_string(i), value);
        EXPECT_LE(bytes_in(temp.path()), most);
        EXPECT_EQ(cache.find("used again and again"), value);
    }
    EXPECT_EQ(cache.find("39"), value);
    EXPECT_EQ(cache.find("0"), std::nullopt) << "it was not used for longest";
    EXPECT_TRUE(warnings.lines.empty());
}

// Each process reads and writes all results, in another order.
TEST(CacheFolder, ServesSeveralProcessesAtOnce) {
    const TempFolder temp;
    constexpr int kProcesses = 4, kResults = 30;
    std::vector<pid_t> children;
    for (int process = 0; process < kProcesses; ++process) {
        children.push_back(fork());
        ASSERT_GE(children.back(), 0);
        if (children.back() > 0)
            continue;
        Warnings warnings;
        CacheFolder cache(temp.path(), 120'000, warnings);
        bool right = true;
        for (int i = 0; i < 4 * kResults; ++i) {
            const std::string key = std::to_string((i * (2 * process + 1)) % kResults), value(5'000, key[0]);
            const std::optional<std::string> found = cache.find(key);
            right = right && (!found || *found == value);
            cache.keep(key, value);
        }
        _exit(right && warnings.lines.empty() ? 0 : 1);
    }
    for (const pid_t child : children) {
        int status = 1;
        waitpid(child, &status, 0);
        EXPECT_EQ(status, 0);
    }
}

// As on a full disk: writing fails half way.
TEST(CacheFolder, GoesOnWhereItIsFull) {
    const TempFolder temp;
    Warnings warnings;
    CacheFolder cache(temp.path(), kPlenty, warnings);
    cache.keep("small", "value");
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit low{1'000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &low);
    cache.keep("large", std::string(50'000, 'v'));
    cache.keep("larger", std::string(60'000, 'v'));
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(warnings.lines.size(), 1u) << "told once";
    EXPECT_EQ(cache.find("large"), std::nullopt);
    EXPECT_EQ(cache.find("small"), "value");
    EXPECT_EQ(results_in(temp.path()).size(), 1u) << "nothing is left of what was begun";
}

TEST(CacheFolder, AFileInItsPlaceIsAnError) {
    const TempFolder temp;
    Warnings warnings;
    write_bytes(temp / "file", "x");
    const Failure failure = failure_of([&] { CacheFolder(temp / "file", kPlenty, warnings); });
    EXPECT_EQ(failure.code, ExitCode::CannotCreate);
    EXPECT_TRUE(contains(failure.message, "--cache"));
}

}  // namespace
}  // namespace brisance
