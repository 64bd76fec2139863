// What every fuzz target offers: one call with the bytes of one input. It may throw Error, and nothing else may happen.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/printable.h"

// libFuzzer's name.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data,
                                      std::size_t size);  // NOLINT(readability-identifier-naming)

namespace brisance::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

// A file of this process that holds `bytes` and keeps its name from input to input; in memory where there is such a
// folder.
std::filesystem::path file_with(std::string_view bytes, const std::string& extension);

// Calls `read`; an Error is a good answer, and is one line as it is printed.
template <class Read>
void expect_answer(const Read& read) {
    try {
        read();
    } catch (const Error& error) {
        if (printable_line(error.what()).find('\n') != std::string::npos)
            __builtin_trap();
    }
}

}  // namespace brisance::fuzz
