// Parallel loops whose results cannot depend on the number of threads. The only door to oneTBB.
#pragma once

#include <cstddef>
#include <functional>

namespace brisance {

// Limits every later loop to `threads` threads; 0 means all processors. Lives as long as the object does.
class ThreadLimit {
public:
    explicit ThreadLimit(int threads);
    ~ThreadLimit();
    ThreadLimit(const ThreadLimit&) = delete;
    ThreadLimit& operator=(const ThreadLimit&) = delete;

private:
    void* control_;
};

int thread_count();

// Calls body(i) once for each i in [0, n), in any order and on any thread. An exception thrown by a body is rethrown
// here. `grain` is the least number of consecutive i handed to one task.
void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body, std::size_t grain = 1);

// Calls body(begin, end) over fixed ranges of `block` indices (the last may be shorter). Ranges depend on n and block
// only.
void parallel_blocks(std::size_t n, std::size_t block,
                     const std::function<void(std::size_t begin, std::size_t end)>& body);

}  // namespace brisance
