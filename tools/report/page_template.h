// The page that a report fills: made by page/build.mjs, part of the program.
#pragma once

#include <string_view>

namespace brisance {

// HTML with the marker <!--DATA--> once, where the data goes.
std::string_view page_template();

}  // namespace brisance
