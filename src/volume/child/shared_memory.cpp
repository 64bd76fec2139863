#include "volume/child/shared_memory.h"

#include <sys/mman.h>

#include <algorithm>
#include <stdexcept>

namespace brisance {

namespace {

constexpr std::uint64_t kLeast = std::uint64_t{1} << 24;

}  // namespace

SharedMemory::SharedMemory(std::uint64_t bytes) : size_(std::max(bytes, kLeast)) {
    for (;; size_ /= 2) {
        void* const at =
            mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
        if (at != MAP_FAILED) {
            data_ = static_cast<std::byte*>(at);
            return;
        }
        if (size_ / 2 < kLeast)
            throw std::bad_alloc();
    }
}

SharedMemory::~SharedMemory() {
    munmap(data_, size_);
}

void SharedWriter::put_text(const std::string& text) {
    put<std::uint64_t>(text.size());
    std::copy(text.begin(), text.end(), array<char>(text.size()));
}

std::string SharedReader::get_text() {
    const std::span<const char> text = array<char>(get<std::uint64_t>());
    return {text.begin(), text.end()};
}

void SharedReader::throw_beyond() {
    throw std::out_of_range("the child process wrote something else");
}

}  // namespace brisance
