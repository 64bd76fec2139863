// Only regular files are read, and a message tells what else stands there.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/input_file.h"

namespace brisance {
namespace {

class InputFile : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::path(::testing::TempDir()) / ("brisance_input_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    static void expect_failure(const std::filesystem::path& file, ExitCode code, const std::string& says) {
        try {
            size_of_input(file, ExitCode::Usage);
            ADD_FAILURE() << file << " counts as a file";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), code);
            EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
        }
    }

    std::filesystem::path folder_;
};

TEST_F(InputFile, IsReadWhole) {
    std::ofstream(folder_ / "a") << "five\n";
    EXPECT_EQ(size_of_input(folder_ / "a"), 5u);
    EXPECT_EQ(read_input(folder_ / "a", 5), "five\n");
    EXPECT_THROW(read_input(folder_ / "a", 4), Error);
}

TEST_F(InputFile, ThatIsNotThereSaysWhy) {
    expect_failure(folder_ / "none", ExitCode::MissingInput, "no such file");
    expect_failure(folder_ / "no/none", ExitCode::MissingInput, "does not exist either");
    std::filesystem::create_symlink("gone", folder_ / "link");
    expect_failure(folder_ / "link", ExitCode::MissingInput, "is a link to gone");
}

TEST_F(InputFile, IsNeitherFolderNorPipeNorDevice) {
    expect_failure(folder_, ExitCode::Usage, "is a folder");
    expect_failure("/dev/zero", ExitCode::Usage, "is a device");
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    expect_failure(folder_ / "pipe", ExitCode::Usage, "is a pipe");
}

TEST_F(InputFile, WithoutPermissionIsNotEmpty) {
    if (geteuid() == 0)
        GTEST_SKIP() << "root may read everything";
    std::ofstream(folder_ / "secret") << "text";
    std::filesystem::permissions(folder_ / "secret", std::filesystem::perms::none);
    expect_failure(folder_ / "secret", ExitCode::Usage, "no permission to read it");
}

}  // namespace
}  // namespace brisance
