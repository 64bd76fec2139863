// A vector for large arrays of plain values that are read at random, such as shadow maps.
//
// New elements hold no particular value: whoever fills them in parallel has their memory set up in parallel, too. Where
// the system has large pages, the array lies in them. A system that has none for it gives small ones.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace brisance {

inline constexpr std::size_t kLargePage = std::size_t{2} << 20, kLeastInLargePages = 2 * kLargePage;

// To be freed by std::free(). Null: there is no memory.
inline void* allocate_in_large_pages(std::size_t bytes) {
    const std::size_t whole = (bytes + kLargePage - 1) / kLargePage * kLargePage;
    void* const memory = whole >= bytes ? std::aligned_alloc(kLargePage, whole) : nullptr;
    if (memory)
        madvise(memory, whole, MADV_HUGEPAGE);  // a wish: what comes of it changes nothing but the time
    return memory;
}

template <class T>
class LargeAllocator : public std::allocator<T> {
public:
    template <class U>
    struct rebind {
        using other = LargeAllocator<U>;
    };

    T* allocate(std::size_t count) {
        if (count * sizeof(T) < kLeastInLargePages)
            return std::allocator<T>::allocate(count);
        if (void* const memory = allocate_in_large_pages(count * sizeof(T)))
            return static_cast<T*>(memory);
        throw std::bad_alloc();
    }

    void deallocate(T* memory, std::size_t count) {
        if (count * sizeof(T) < kLeastInLargePages)
            std::allocator<T>::deallocate(memory, count);
        else
            std::free(memory);
    }

    template <class U, class... Args>
    void construct(U* at, Args&&... args) {
        if constexpr (sizeof...(Args) == 0)
            ::new (static_cast<void*>(at)) U;
        else
            ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
    }

private:
    static_assert(std::is_trivially_default_constructible_v<T>);
};

template <class T>
using LargeVector = std::vector<T, LargeAllocator<T>>;

}  // namespace brisance
