// Patterns of numbered files and lists of frames: the first line is the list, the second the pattern.
#include "target.h"
#include "volume/frame_path.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace brisance;
    const std::string text(fuzz::text_of(data, size));
    const std::size_t end = text.find('\n');
    const std::string list = text.substr(0, end);
    const std::string pattern = end == std::string::npos ? text : text.substr(end + 1);
    fuzz::expect_answer([&] { parse_frames(list); });
    fuzz::expect_answer([&] {
        has_frame_token(pattern);
        expand(pattern, -17);
        expand(pattern, 1001);
    });
    fuzz::expect_answer([&] {
        frame_number_of(pattern);
        pattern_of(pattern);
    });
    return 0;
}
