// What was decided for all frames of a sequence, as a text that another process can take over.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "shot/shot.h"

namespace brisance {

// Settings that were decided, and what was said of them.
struct KeptChoice {
    Shot shot;  // with them
    std::optional<float> exposure_stops;
    std::vector<std::pair<std::string, std::string>> said;  // code, empty for a notice, and line
};

std::string to_text(const KeptChoice& choice);

// The choice put into `shot`; nothing where the text is not one for it.
std::optional<KeptChoice> kept_choice(const std::string& text, const Shot& shot);

}  // namespace brisance
