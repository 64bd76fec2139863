// The motion between two frames, from what their files hold.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "film/write_image.h"
#include "metrics/motion.h"

namespace brisance {

// What is needed to follow a frame's points into the next: motion vectors, or depth and camera, or neither.
struct MotionSource {
    std::optional<SeenFrame> seen;
    std::optional<Motion> vectors;
};

// `layer` names the layer of vectors; empty: depth and camera, where the file has them. Throws Error BadData when there
// is no such layer of two channels.
MotionSource motion_source(const std::filesystem::path& file, const Image& image, const ExrMetadata& metadata,
                           const std::string& layer);

// Absent where the files do not tell.
std::optional<Motion> motion_between(const MotionSource& before, const MotionSource& next);

}  // namespace brisance
