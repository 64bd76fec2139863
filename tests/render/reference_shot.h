// The shots of another renderer's reference pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "render/render_frame.h"

namespace brisance::testing {

struct ReferenceShot {
    Shot shot;
    std::filesystem::path volume;
    std::string pictures;  // path and name, without order, half and suffix
};

// `name` of those below the folder `data`, described in JSON beside its pictures.
ReferenceShot reference_shot(const std::filesystem::path& data, const std::string& name);

// The pixels' radiance in a picture of one channel.
std::vector<float> read_luminance(const std::string& file);

}  // namespace brisance::testing
