// Shots, and what is written of them.
#include "shot/read_shot.h"
#include "shot/scene_differences.h"
#include "shot/write_shot.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace brisance;
    const std::string text(fuzz::text_of(data, size));
    fuzz::expect_answer([&] {
        const Shot shot = parse_shot(text, "shot", {});
        parse_shot(to_json(shot), "written", {});
    });
    fuzz::expect_answer([&] { parse_shot("{}", "shot", {}, {"", {text}}); });
    return 0;
}
