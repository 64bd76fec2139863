#include "core/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include <algorithm>

#if defined(__SANITIZE_THREAD__)
#include <sanitizer/tsan_interface.h>

// With a short history stacks are lost, and suppressions find nothing to match. OpenVDB's child is forked from threads.
extern "C" const char* __tsan_default_options() {  // NOLINT(readability-identifier-naming,bugprone-*)
    return "history_size=7:die_after_fork=0";
}

// What oneTBB's templates, and OpenVDB's in tests that write files, do to objects that the uninstrumented libraries
// hand from thread to thread, atomics among them, and the memory that oneTBB clears, or that Embree takes, copies and
// frees in its own tasks while it builds a hierarchy; not what our loops' bodies do, nor what Embree calls back. Those
// tasks also compare the names of Embree's settings, in the standard library, whose stack ends there: the last line
// therefore hides a race of any string's characters if one side compares them with a literal.
extern "C" const char* __tsan_default_suppressions() {  // NOLINT(readability-identifier-naming,bugprone-*)
    return "race_top:tbb::detail\nrace_top:oneapi/tbb/\nrace_top:bits/atomic_base.h\ncalled_from_lib:libtbb.so\n"
           "called_from_lib:libembree3.so\nrace:openvdb::\n"
           "race:^std::__cxx11::basic_string<char, std::char_traits<char>, std::allocator<char> >::compare(char "
           "const*)";
}
#define BRISANCE_UNWATCHED __attribute__((no_sanitize("thread")))
#else
#define BRISANCE_UNWATCHED
#endif

namespace brisance {

namespace {

// Debian's oneTBB is not built for the thread sanitizer, which does not see that bodies run after what precedes their
// loop and before what follows it. It is told; two bodies of one loop remain unordered. Nor does it see that a task is
// handed from thread to thread: what a task reads of itself (BRISANCE_UNWATCHED) is not checked, what the body does is.
struct LoopOrder {
#if defined(__SANITIZE_THREAD__)
    LoopOrder() {
        __tsan_release(&begun);
    }
    ~LoopOrder() {
        __tsan_acquire(&ended);
    }
    void enter() {
        __tsan_acquire(&begun);
    }
    void leave() {
        __tsan_release(&ended);
    }
    char begun = 0, ended = 0;
#else
    void enter() const {}
    void leave() const {}
#endif
};

}  // namespace

ThreadLimit::ThreadLimit(int threads) : control_(nullptr) {
    if (threads > 0)
        control_ =
            new tbb::global_control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(threads));
}

ThreadLimit::~ThreadLimit() {
    delete static_cast<tbb::global_control*>(control_);
}

int thread_count() {
    return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(std::size_t n, const std::function<void(std::size_t)>& body, std::size_t grain) {
    LoopOrder order;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, std::max<std::size_t>(grain, 1)),
                      [&](const tbb::blocked_range<std::size_t>& range) BRISANCE_UNWATCHED {
                          order.enter();
                          for (std::size_t i = range.begin(); i != range.end(); ++i)
                              body(i);
                          order.leave();
                      });
}

void parallel_blocks(std::size_t n, std::size_t block, const std::function<void(std::size_t, std::size_t)>& body) {
    const std::size_t count = (n + block - 1) / block;
    parallel_for(count, [&](std::size_t b) { body(b * block, std::min(n, (b + 1) * block)); });
}

}  // namespace brisance
