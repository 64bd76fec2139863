// Textures and environments: PNG, JPEG, and Radiance, by file and from memory.
#include "scene/read_texture.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace brisance;
    constexpr std::uint64_t memory = std::uint64_t{64} << 20;
    fuzz::expect_answer([&] { read_texture(std::span(data, size), "memory", true, memory); });
    const auto file = fuzz::file_with(fuzz::text_of(data, size), ".hdr");
    fuzz::expect_answer([&] { read_texture(file, false, memory); });
    return 0;
}
