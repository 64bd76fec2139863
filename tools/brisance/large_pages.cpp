// Large arrays of the program in large pages of memory, whoever allocates them.
//
// A volume, its light and a picture are arrays of megabytes to gigabytes. In pages of 4 KiB the system spends up to a
// quarter of the program's time on setting them up, and the processor on finding them. So operator new, from some
// megabytes on, asks the system for pages of 2 MiB. It is a wish: what comes of it changes nothing but the time. Not
// under GCC's address sanitizer: its nothrow new stays its own, and delete here would free that memory.
#ifndef __SANITIZE_ADDRESS__

#include <cstddef>
#include <cstdlib>
#include <new>

#include "shadows/large_vector.h"

namespace {

void* allocate(std::size_t bytes) {
    if (bytes < brisance::kLeastInLargePages)
        return std::malloc(bytes > 0 ? bytes : 1);
    return brisance::allocate_in_large_pages(bytes);
}

}  // namespace

void* operator new(std::size_t bytes) {
    for (;;) {
        if (void* const memory = allocate(bytes))
            return memory;
        const std::new_handler handler = std::get_new_handler();
        if (!handler)
            throw std::bad_alloc();
        handler();
    }
}

void operator delete(void* memory) noexcept {
    std::free(memory);
}

void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

#endif
