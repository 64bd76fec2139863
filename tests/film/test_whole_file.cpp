// A file appears whole or not at all, and what was there before stays until then.

#include "film/whole_file.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <functional>

#include "core/error.h"
#include "film/write_image.h"
#include "fixtures.h"

namespace brisance {
namespace {

namespace fs = std::filesystem;
using testing::contents;
using testing::gray_image;
using testing::TemporaryFolder;

Error error_of(const std::function<void()>& work) {
    try {
        work();
    } catch (const Error& error) {
        return error;
    }
    return {ExitCode::Success, "no error"};
}

// The three writers, each on a file in `folder`.
void expect_all_fail(const fs::path& folder, ExitCode code, const std::string& hint) {
    const Image image = gray_image(200, 200, 0.3f);
    const std::vector<std::pair<std::string, std::function<void(const fs::path&)>>> writers = {
        {"a.exr", [&](const fs::path& file) { write_exr(file, image, {}); }},
        {"a.png", [&](const fs::path& file) { write_png(file, image, 0.0f, ViewTransform::Filmic); }},
        {"a.json", [&](const fs::path& file) { write_text(file, std::string(1 << 20, 'x')); }},
    };
    for (const auto& writer : writers) {
        const std::string& name = writer.first;
        const Error error = error_of([&] { writer.second(folder / name); });
        EXPECT_EQ(error.code(), code) << name;
        EXPECT_NE(std::string(error.what()).find((folder / name).string()), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find(hint), std::string::npos) << error.what();
    }
}

TEST(WholeFile, ReplacesWhatWasThereAndLeavesNothingElse) {
    const TemporaryFolder folder;
    write_whole_file(folder / "a.txt", "first");
    write_whole_file(folder / "a.txt", "second");
    EXPECT_EQ(contents(folder / "a.txt"), "second");
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.txt"});
}

TEST(WholeFile, MissingFolderIsNamed) {
    const TemporaryFolder folder;
    expect_all_fail(folder / "absent", ExitCode::CannotCreate, "does not exist");
    EXPECT_TRUE(folder.names().empty());
}

TEST(WholeFile, AFileInPlaceOfTheFolderIsNamed) {
    const TemporaryFolder folder;
    std::ofstream(folder / "file") << "x";
    expect_all_fail(folder / "file", ExitCode::CannotCreate, "is not a folder");
}

TEST(WholeFile, FolderWithoutPermissionIsNamed) {
    const TemporaryFolder folder;
    fs::permissions(folder.path(),
                    fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_read | fs::perms::others_exec);
    const bool as_root = geteuid() == 0;  // whom permissions do not stop
    if (as_root && seteuid(65534) != 0)
        GTEST_SKIP() << "cannot become an ordinary user";
    expect_all_fail(folder.path(), ExitCode::CannotCreate, "no permission");
    EXPECT_EQ(error_of([&] { check_writable(folder / "a.exr"); }).code(), ExitCode::CannotCreate);
    if (as_root) {
        ASSERT_EQ(seteuid(0), 0);
    }
}

TEST(WholeFile, NeverReplacesWhatIsNoFile) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "a.exr");
    EXPECT_EQ(error_of([&] { write_whole_file(folder / "a.exr", "x"); }).code(), ExitCode::CannotCreate);
    EXPECT_EQ(error_of([&] { write_whole_file("/dev/null", "x"); }).code(), ExitCode::CannotCreate);
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(WholeFile, WritesThroughALink) {
    const TemporaryFolder folder;
    write_whole_file(folder / "target.txt", "old");
    fs::create_symlink("target.txt", folder / "link.txt");
    write_whole_file(folder / "link.txt", "new");
    EXPECT_TRUE(fs::is_symlink(folder / "link.txt"));
    EXPECT_EQ(contents(folder / "target.txt"), "new");
}

TEST(WholeFile, LongNamesAreWritten) {
    const TemporaryFolder folder;
    const std::string name = std::string(250, 'n') + ".exr";
    write_whole_file(folder / name, "x");
    EXPECT_EQ(folder.names(), std::vector<std::string>{name});
    EXPECT_EQ(error_of([&] { write_whole_file(folder / std::string(300, 'n'), "x"); }).code(), ExitCode::CannotCreate);
}

TEST(WholeFile, CheckingLeavesNoTrace) {
    const TemporaryFolder folder;
    check_writable(folder / "a.exr");
    EXPECT_TRUE(folder.names().empty());
}

// Limits the size of files while it lives.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit before_{};
    void (*handler_)(int) = nullptr;
};

TEST(WholeFile, AWriteThatFailsHalfWayLeavesTheOldFileAndNothingElse) {
    const TemporaryFolder folder;
    write_whole_file(folder / "a.json", "old");
    {
        const FileSizeLimit limit(100);
        expect_all_fail(folder.path(), ExitCode::OutputFailed, "larger than allowed");
    }
    EXPECT_EQ(folder.names(), std::vector<std::string>{"a.json"});
    EXPECT_EQ(contents(folder / "a.json"), "old");
}

TEST(WholeFile, AFullDiskIsNamedAndLeftClean) {
    const TemporaryFolder folder;
    if (mount("tmpfs", folder.path().c_str(), "tmpfs", 0, "size=16k") != 0)
        GTEST_SKIP() << "not permitted to mount a small file system";
    write_whole_file(folder / "a.json", "old");
    const Error error = error_of([&] { write_text(folder / "a.json", std::string(1 << 20, 'x')); });
    const std::vector<std::string> names = folder.names();
    const std::string old = contents(folder / "a.json");
    umount(folder.path().c_str());
    EXPECT_EQ(error.code(), ExitCode::OutputFailed);
    EXPECT_NE(std::string(error.what()).find("no space left"), std::string::npos) << error.what();
    EXPECT_EQ(names, std::vector<std::string>{"a.json"});
    EXPECT_EQ(old, "old");
}

// The name of the temporary file that a process of this machine writes `file` under.
std::string temporary_of(const fs::path& folder, const std::string& file, pid_t process) {
    char host[65] = {};
    gethostname(host, sizeof host - 1);
    const fs::path name(file);
    return folder / fmt::format(".{}.{}.{}.tmp{}", name.stem().string(), host, process, name.extension().string());
}

pid_t process_that_has_ended() {
    const pid_t child = fork();
    if (child == 0)
        _exit(0);
    waitpid(child, nullptr, 0);
    return child;
}

TEST(WholeFile, LeftoversOfKilledProcessesAreRemovedAndNoOthers) {
    const TemporaryFolder folder;
    const pid_t ended = process_that_has_ended();
    const std::vector<std::string> kept = {
        temporary_of(folder.path(), "state.bin", getpid()),  // under way
        temporary_of(folder.path(), "state.bin", 1),         // alive, and another user's
        temporary_of(folder.path(), "other.bin", ended),
        temporary_of(folder.path(), "state", ended),
        temporary_of(folder.path(), "state.bin.bin", ended),
        temporary_of(folder.path(), "state.bin", ended) + "x",
        folder / fmt::format(".state.elsewhere.{}.tmp.bin", ended),
    };
    for (const std::string& name : kept)
        std::ofstream(name) << "x";
    std::ofstream(temporary_of(folder.path(), "state.bin", ended)) << "half a check";
    remove_leftovers(folder / "state.bin");
    for (const std::string& name : kept)
        EXPECT_TRUE(fs::exists(name)) << name;
    EXPECT_EQ(folder.names().size(), kept.size());
    remove_leftovers(folder / "absent" / "state.bin");  // nothing to do, and no error
}

// However slow the machine: a child is killed once its unfinished file is seen, and not after a fixed time.
void wait_for_unfinished_file(const TemporaryFolder& folder) {
    const auto unfinished = [](const std::string& name) { return name != "a.txt"; };
    for (int wait = 0; wait < 60000 && std::ranges::none_of(folder.names(), unfinished); ++wait)
        usleep(1000);
}

TEST(WholeFile, LeftoversOfAKilledWriteAreRemoved) {
    const TemporaryFolder folder;
    bool whole = false;
    const auto leftovers = [&] {
        whole = fs::exists(folder / "a.txt");
        return folder.names().size() > (whole ? 1u : 0u);
    };
    for (int round = 0; round < 20 && !leftovers(); ++round) {
        const pid_t child = fork();
        if (child == 0) {
            const std::string much(64 << 20, 'x');
            for (;;)
                write_whole_file(folder / "a.txt", much);
        }
        wait_for_unfinished_file(folder);
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
    }
    EXPECT_TRUE(leftovers()) << "never killed while it wrote";
    remove_leftovers(folder / "a.txt");
    EXPECT_EQ(folder.names(), whole ? std::vector<std::string>{"a.txt"} : std::vector<std::string>{});
}

TEST(WholeFile, AnInterruptedWriteLeavesNothing) {
    const TemporaryFolder folder;
    for (int round = 0; round < 5; ++round) {
        const pid_t child = fork();
        if (child == 0) {
            std::signal(SIGALRM, [](int) {
                remove_unfinished_files();
                _exit(0);
            });
            ualarm(static_cast<useconds_t>(20000 + 7000 * round), 0);
            const std::string much(64 << 20, 'x');
            for (;;)
                write_whole_file(folder / "a.txt", much);
        }
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    }
    for (const std::string& name : folder.names())
        EXPECT_EQ(name, "a.txt");
    if (fs::exists(folder / "a.txt")) {
        EXPECT_EQ(fs::file_size(folder / "a.txt"), std::uintmax_t{64} << 20);
    }
}

}  // namespace
}  // namespace brisance
