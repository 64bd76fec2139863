// Whether the frames of a sequence on disk flicker (metrics/passing_change.h).
#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "compare/motion_source.h"
#include "metrics/picture.h"

namespace brisance {

class Steadiness {
public:
    // Frames in the order of their numbers. Their files are whole.
    void add(int frame, const std::filesystem::path& exr);

    struct OfFrame {
        int frame = 0;
        double change = 0.0;
    };
    // Of frames between two others that are as far before as behind, and whose files tell the motion.
    const std::vector<OfFrame>& frames() const { return frames_; }
    // "change against both neighbours: median 1.2 %, largest 3 % at frame 17"; empty where no frame is known.
    std::string summary() const;

private:
    struct Seen {
        int frame = 0;
        Picture picture;
        MotionSource source;
    };

    std::deque<Seen> last_;
    std::vector<OfFrame> frames_;
};

}  // namespace brisance
