// Shares of a sequence: each frame in exactly one.
#include <gtest/gtest.h>

#include <numeric>

#include "farm/frame_chunk.h"
#include "volume/temp_folder.h"

namespace brisance {
namespace {

std::vector<int> some_frames(std::size_t count) {
    std::vector<int> frames(count);
    for (std::size_t i = 0; i < count; ++i)
        frames[i] = 1001 + 3 * static_cast<int>(i);
    return frames;
}

TEST(FrameChunk, AllTasksTogetherAreTheFramesInTheirOrder) {
    for (std::size_t count = 0; count < 40; ++count)
        for (int tasks = 1; tasks < 50; ++tasks) {
            const std::vector<int> frames = some_frames(count);
            std::vector<int> together;
            for (int task = 0; task < tasks; ++task) {
                const std::vector<int> part = frame_chunk(frames, task, tasks);
                together.insert(together.end(), part.begin(), part.end());
            }
            ASSERT_EQ(together, frames) << count << " frames, " << tasks << " tasks";
        }
}

TEST(FrameChunk, PartsDifferByOneFrameAtMost) {
    for (std::size_t count = 0; count < 40; ++count)
        for (int tasks = 1; tasks < 50; ++tasks)
            for (int task = 0; task < tasks; ++task) {
                const std::size_t part = frame_chunk(some_frames(count), task, tasks).size();
                const std::size_t least = count / static_cast<std::size_t>(tasks);
                ASSERT_TRUE(part == least || (part == least + 1 && count % static_cast<std::size_t>(tasks) != 0));
            }
}

TEST(FrameChunk, WhatIsOutOfRangeIsOneLine) {
    const std::vector<int> frames = some_frames(5);
    for (const auto& [index, count] : {std::pair(-1, 3), std::pair(3, 3), std::pair(0, 0), std::pair(0, -2)}) {
        const Failure failure = failure_of([&] { frame_chunk(frames, index, count); });
        EXPECT_EQ(failure.code, ExitCode::Usage);
        EXPECT_FALSE(contains(failure.message, "\n"));
    }
    EXPECT_TRUE(contains(failure_of([&] { frame_chunk(frames, 3, 3); }).message, "from 0 to 2"));
}

TEST(FrameChunk, TasksOfAFewFramesEach) {
    EXPECT_EQ(tasks_for(24, 5), 5);
    EXPECT_EQ(tasks_for(25, 5), 5);
    EXPECT_EQ(tasks_for(26, 5), 6);
    EXPECT_EQ(tasks_for(1, 100), 1);
}

}  // namespace
}  // namespace brisance
