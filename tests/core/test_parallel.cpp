// Parallel loops: every index once, fixed blocks, exceptions that reach the caller, and results that do not depend on
// threads.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <mutex>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/parallel.h"
#include "core/rng.h"

namespace brisance {
namespace {

constexpr int kThreads[] = {1, 2, 7};
constexpr std::size_t kCounts[] = {0, 1, 2, 63, 64, 65, 10'007};

TEST(ParallelFor, CallsEveryIndexOnce) {
    for (const int threads : kThreads) {
        const ThreadLimit limit(threads);
        for (const std::size_t n : kCounts)
            for (const std::size_t grain : {0, 1, 16, 100'000}) {
                std::vector<std::atomic<int>> calls(n);
                std::atomic<bool> outside{false};
                parallel_for(
                    n,
                    [&](std::size_t i) {
                        if (i < n)
                            ++calls[i];
                        else
                            outside = true;
                    },
                    grain);
                EXPECT_FALSE(outside);
                for (std::size_t i = 0; i < n; ++i)
                    ASSERT_EQ(calls[i], 1) << i << " of " << n << ", grain " << grain << ", " << threads << " threads";
            }
    }
}

TEST(ParallelBlocks, AreFixedRangesThatTileAll) {
    using Range = std::pair<std::size_t, std::size_t>;
    for (const int threads : kThreads) {
        const ThreadLimit limit(threads);
        for (const std::size_t n : kCounts)
            for (const std::size_t block : {1, 7, 64, 20'000}) {
                std::multiset<Range> expected, found;
                for (std::size_t begin = 0; begin < n; begin += block)
                    expected.insert({begin, std::min(n, begin + block)});
                std::mutex guard;
                parallel_blocks(n, block, [&](std::size_t begin, std::size_t end) {
                    const std::lock_guard lock(guard);
                    found.insert({begin, end});
                });
                EXPECT_EQ(found, expected) << n << " in blocks of " << block << ", " << threads << " threads";
            }
    }
}

// Sums of floats show the order they were added in: blocks keep it.
TEST(ParallelBlocks, SumTheSameForAnyNumberOfThreads) {
    constexpr std::size_t kCount = 100'003, kBlock = 1000;
    std::vector<float> values(kCount);
    Rng rng(Stream::Points, 3);
    for (float& v : values)
        v = std::exp(20.0f * rng.next());
    const auto sum = [&] {
        std::vector<float> parts((kCount + kBlock - 1) / kBlock);
        parallel_blocks(kCount, kBlock, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                parts[begin / kBlock] += values[i];
        });
        float whole = 0.0f;
        for (const float part : parts)
            whole += part;
        return whole;
    };
    std::set<float> sums;
    for (const int threads : kThreads) {
        const ThreadLimit limit(threads);
        for (int run = 0; run < 10; ++run)
            sums.insert(sum());
    }
    EXPECT_EQ(sums.size(), 1u);
}

TEST(ParallelLoops, RethrowWhatABodyThrows) {
    for (const int threads : kThreads) {
        const ThreadLimit limit(threads);
        try {
            parallel_for(1000, [](std::size_t i) {
                if (i == 617)
                    throw Error(ExitCode::BadData, "body 617");
            });
            ADD_FAILURE() << "nothing was thrown";
        } catch (const Error& error) {
            EXPECT_STREQ(error.what(), "body 617");
        }
        EXPECT_THROW(parallel_blocks(100, 3,
                                     [](std::size_t begin, std::size_t) {
                                         if (begin == 99)
                                             throw std::out_of_range("the last block");
                                     }),
                     std::out_of_range);
        // And the next loop is whole.
        std::atomic<int> calls{0};
        parallel_for(100, [&](std::size_t) { ++calls; });
        EXPECT_EQ(calls, 100);
    }
}

TEST(ParallelLoops, MayStandInOneAnother) {
    std::vector<std::atomic<int>> calls(40 * 50);
    parallel_for(40, [&](std::size_t i) { parallel_for(50, [&](std::size_t j) { ++calls[50 * i + j]; }); });
    for (const std::atomic<int>& count : calls)
        ASSERT_EQ(count, 1);
}

TEST(ThreadLimits, LastAsLongAsTheObject) {
    const int all = thread_count();
    EXPECT_GE(all, 1);
    {
        const ThreadLimit one(1);
        EXPECT_EQ(thread_count(), 1);
        // One thread works in order: nothing else is there to take an index.
        std::vector<std::size_t> order;
        parallel_for(100, [&](std::size_t i) { order.push_back(i); });
        ASSERT_EQ(order.size(), 100u);
    }
    EXPECT_EQ(thread_count(), all);
    {
        const ThreadLimit seven(7);
        EXPECT_EQ(thread_count(), 7);
    }
    const ThreadLimit none(0);
    EXPECT_EQ(thread_count(), all);
}

}  // namespace
}  // namespace brisance
