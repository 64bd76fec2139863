// What `brisance inspect` says of velocity: where it is, in which form, and what its unit may be.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace brisance {

struct InspectedVelocity {
    std::string mapping;  // the grids in words; empty: there is none
    std::string form;     // class and type, and outliers
    std::string unit;     // as fitted to neighbouring frames, or why it cannot be
};

// `pattern` and `frames`: the sequence on disk that the file belongs to; empty where it stands alone. Reads a few
// frames of it. What cannot be read is said in words.
InspectedVelocity inspect_velocity(const std::filesystem::path& file, const std::string& pattern,
                                   const std::vector<int>& frames);

std::string velocity_text(const InspectedVelocity& velocity);

}  // namespace brisance
