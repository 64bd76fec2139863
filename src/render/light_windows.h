// Windows of frames whose virtual lights share their positions, so that a camera that moves does not show their noise
// move, and smoke that changes does not place them anew.
//
// Window k has its middle at frame k W, where W is virtual_lights.window, and reaches W frames to both sides. A frame
// lies in two windows at most. The shares of their lights fade linearly with the distance from the middle and add up
// to 1. Positions are placed by the paths of cameras at five times of the window, through the smoke and the set of its
// middle. All of that follows from frame numbers and from the files on disk, never from which frames are rendered.
#pragma once

#include <vector>

#include "render/input/frame_input.h"
#include "render/input/kept_inputs.h"
#include "virtual_lights/placed_lights.h"

namespace brisance {

struct LightWindow {
    int number = 0;      // its middle is this many widths from frame 0
    double share = 1.0;  // of its lights, in (0, 1]
};
// `width`: of at least 1 frame.
std::vector<LightWindow> light_windows(int frame, int width);

// Whether the frames of a shot may share positions: it has surfaces and virtual lights, and is a sequence.
bool may_share_lights(const Shot& shot);

// The frame whose smoke and set stand for a window: its middle, or the nearest that shows the sequence. Throws Error as
// covering_frames.
int frame_of_window(const Shot& shot, const LightWindow& window);

// The positions for a frame; none where each frame has its own. `input`: of the frame. Reads the files of other frames.
// A window whose files cannot be used is left out with a warning. `kept`: keeps positions for the next frame.
std::vector<SharedPositions> shared_positions(const Shot& shot, int frame, const FrameInput& input, KeptInputs* kept,
                                              Statistics& statistics, Progress& progress);

}  // namespace brisance
