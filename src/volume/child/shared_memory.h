// Memory that a child process fills and its parent reads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <string>
#include <type_traits>

namespace brisance {

// Pages take memory only once they are written.
class SharedMemory {
public:
    // At most `bytes`; less where the process may not map as much. Throws std::bad_alloc when there is none.
    explicit SharedMemory(std::uint64_t bytes);
    ~SharedMemory();
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;

    std::span<std::byte> bytes() const { return {data_, size_}; }

private:
    std::byte* data_ = nullptr;
    std::uint64_t size_;
};

// Takes pieces of a range of bytes one after the other.
class Pieces {
public:
    explicit Pieces(std::span<std::byte> bytes) : bytes_(bytes) {}

    // Null when they do not fit.
    std::byte* take(std::uint64_t count, std::uint64_t size) {
        constexpr std::uint64_t alignment = 16;
        if (count > (bytes_.size() - used_) / size)
            return nullptr;
        std::byte* const at = bytes_.data() + used_;
        used_ += (count * size + alignment - 1) / alignment * alignment;
        used_ = used_ < bytes_.size() ? used_ : bytes_.size();
        return at;
    }

private:
    std::span<std::byte> bytes_;
    std::uint64_t used_ = 0;
};

// Writes values one after the other. Throws std::bad_alloc when the memory is full.
class SharedWriter {
public:
    explicit SharedWriter(std::span<std::byte> bytes) : pieces_(bytes) {}

    template <class T>
    T* array(std::uint64_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        std::byte* const at = pieces_.take(count, sizeof(T));
        if (at == nullptr)
            throw std::bad_alloc();
        return reinterpret_cast<T*>(at);
    }
    template <class T>
    void put(const T& value) {
        *array<T>(1) = value;
    }
    void put_text(const std::string& text);

private:
    Pieces pieces_;
};

// Reads what a SharedWriter wrote, in the same order. A child that read a damaged file may have written anything: what
// lies beyond the end throws std::out_of_range.
class SharedReader {
public:
    explicit SharedReader(std::span<std::byte> bytes) : pieces_(bytes) {}

    template <class T>
    std::span<const T> array(std::uint64_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::byte* const at = pieces_.take(count, sizeof(T));
        if (at == nullptr)
            throw_beyond();
        return {reinterpret_cast<const T*>(at), count};
    }
    template <class T>
    T get() {
        return array<T>(1)[0];
    }
    std::string get_text();

private:
    [[noreturn]] static void throw_beyond();

    Pieces pieces_;
};

}  // namespace brisance
