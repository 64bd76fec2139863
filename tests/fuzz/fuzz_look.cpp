// First looks, what is told of them, and the shots that they become.
#include "first_look/look_file.h"
#include "shot/read_shot.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace brisance;
    const std::string text(fuzz::text_of(data, size));
    fuzz::expect_answer([&] {
        const Look look = look_from_json(text, "look");
        describe_look(look);
        look_from_json(look_to_json(look), "written");
        parse_shot(shot_of_look(look, {}).dump(), "shot", {}, {{}, {"volume.file=a.vdb"}});
    });
    return 0;
}
