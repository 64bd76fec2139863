// Pictures in OpenEXR, as references are read.
#include "film/write_image.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace brisance;
    const auto file = fuzz::file_with(fuzz::text_of(data, size), ".exr");
    fuzz::expect_answer([&] { read_exr_metadata(file); });
    fuzz::expect_answer([&] { read_exr(file); });
    return 0;
}
