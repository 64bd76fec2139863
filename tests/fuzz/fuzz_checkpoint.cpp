// The state of an interrupted render.
#include <algorithm>

#include "reference/path_film.h"
#include "target.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace brisance;
    PathFilm film(3, 2, false);
    // Changes a sound checkpoint, and begins from nothing.
    std::string changed = film.serialise("key");
    for (std::size_t i = 0; i < std::min(size, changed.size()); ++i)
        changed[i] = static_cast<char>(changed[i] ^ data[i]);
    film.restore(changed, "key");
    film.restore(std::string(fuzz::text_of(data, size)), "key");
    PathFilm orders(1, 1, true, true);
    orders.restore(std::string(fuzz::text_of(data, size)), "key");
    return 0;
}
