// The input of one frame: its medium, its surroundings, its camera.
#pragma once

#include <filesystem>
#include <memory>

#include "core/progress.h"
#include "emitters/surroundings.h"
#include "medium/medium.h"
#include "render/shutter/animation.h"
#include "shot/shot.h"
#include "statistics/statistics.h"

namespace brisance {

struct KeptInputs;

struct FrameInput {
    Medium medium;                                     // without nodes where the shot has no volume
    std::shared_ptr<const Surroundings> surroundings;  // none where it has no scene; local space as the medium's
    CameraSettings camera;
    Animation animation;  // of files, while the shutter is open; empty where it is not
};

// `volume`: the frame's .vdb file; empty where the shot has none, and then no volume is started.
// The camera is the shot's, else that of a glTF file, else one that sees everything. `kept`: what earlier frames of the
// shot hand on (kept_inputs.h). Throws Error. The shot must outlive the animation.
FrameInput load_frame(const Shot& shot, const std::filesystem::path& volume, int frame, Statistics& statistics,
                      Progress& progress, KeptInputs* kept = nullptr);

// The camera at another time of the shot [frames]: that of `like`, unless an animation of the files moves it.
CameraSettings camera_at(const Shot& shot, double frame, const FrameInput& like);

}  // namespace brisance
