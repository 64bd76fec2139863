// What a damaged file makes a library do happens in a child process, and ends there.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <vector>

#include "core/parallel.h"
#include "temp_folder.h"
#include "volume/child/child_process.h"

namespace brisance {
namespace {

constexpr ChildLimits kSmall{std::uint64_t{64} << 20, 1};

ChildEnd end_of(const std::function<void(const Line&)>& body) {
    ChildProcess child(kSmall, body);
    return child.wait();
}

// What the child sends last.
int answer_of(const std::function<int()>& body) {
    ChildProcess child(kSmall, [&](const Line& line) {
        const int answer = body();
        line.send(&answer, sizeof(answer));
    });
    int answer = -1;
    EXPECT_TRUE(child.line().receive(&answer, sizeof(answer)));
    return answer;
}

TEST(ChildProcess, ThatReturnsHasFinished) {
    EXPECT_EQ(end_of([](const Line&) {}), ChildEnd::Finished);
}

TEST(ChildProcess, ThatOverwritesMemoryHasCrashed) {
    EXPECT_EQ(end_of([](const Line&) {
                  volatile int* volatile nowhere = nullptr;
                  *nowhere = 1;
              }),
              ChildEnd::Crashed);
    EXPECT_EQ(end_of([](const Line&) { std::abort(); }), ChildEnd::Crashed);
    EXPECT_EQ(end_of([](const Line&) { throw 1; }), ChildEnd::Crashed);
}

TEST(ChildProcess, IsKilledWhenNobodyWaitsForIt) {
    {
        ChildProcess child(kSmall, [](const Line& line) {
            char nothing = 0;
            line.receive(&nothing, 1);
        });
    }
    EXPECT_EQ(end_of([](const Line&) {}), ChildEnd::Finished);  // the next one is not mistaken for it
}

TEST(ChildProcess, ThatRunsForEverRunsOutOfTime) {
    EXPECT_EQ(end_of([](const Line&) {
                  for (volatile int i = 0; i == 0;) {
                  }
              }),
              ChildEnd::OutOfTime);
}

TEST(ChildProcess, GetsNoMoreMemoryThanItsLimit) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "sanitizers allocate by themselves";
#endif
    EXPECT_EQ(answer_of([] {
                  try {
                      std::vector<char> large(std::size_t{256} << 20, 1);
                      return static_cast<int>(large[5]);
                  } catch (const std::bad_alloc&) {
                      return 77;
                  }
              }),
              77);
}

TEST(ChildProcess, RunsParallelLoopsOnItsOneThread) {
    std::vector<int> before(1000);
    parallel_for(before.size(), [&](std::size_t i) { before[i] = 1; });  // starts threads that the child lacks
    EXPECT_EQ(answer_of([] {
                  std::vector<int> values(1000);
                  parallel_for(values.size(), [&](std::size_t i) { values[i] = 1; });
                  int sum = 0;
                  for (const int value : values)
                      sum += value;
                  return sum;
              }),
              1000);
}

TEST(ChildProcess, WritesNoFileAndReachesNoNetwork) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "system calls are not filtered with sanitizers";
#endif
    const TempFolder folder;
    const std::string file = folder / "written";
    EXPECT_EQ(answer_of([&] { return open(file.c_str(), O_WRONLY | O_CREAT, 0600) < 0 ? errno : 0; }), EPERM);
    EXPECT_EQ(answer_of([] { return socket(AF_INET, SOCK_STREAM, 0) < 0 ? errno : 0; }), EPERM);
    EXPECT_EQ(answer_of([] { return fork() < 0 ? errno : 0; }), EPERM);
    EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(ChildProcess, PrintsNothing) {
    testing::internal::CaptureStderr();
    end_of([](const Line&) { static_cast<void>(!write(STDERR_FILENO, "hello", 5)); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace brisance
