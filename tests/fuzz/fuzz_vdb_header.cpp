// The skeleton of a .vdb file.
#include "target.h"
#include "volume/vdb_header.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace brisance;
    const auto file = fuzz::file_with(fuzz::text_of(data, size), ".vdb");
    fuzz::expect_answer([&] { read_vdb_header(file); });
    return 0;
}
