// Renders one frame, from the file to the picture.
#pragma once

#include <filesystem>

#include "core/progress.h"
#include "diagnostics/light_pictures.h"
#include "emitters/surroundings.h"
#include "film/image.h"
#include "medium/medium.h"
#include "shot/shot.h"
#include "statistics/statistics.h"

namespace brisance {

struct KeptInputs;

struct RenderedFrame {
    Image image;
    std::vector<Image> halves;                    // method path: two independent ones, whose mean is `image`
    std::optional<LightPictures> light_pictures;  // if output.virtual_lights is set and there are lights
    ImageMetadata metadata;
    Statistics statistics;
};

// `volume` is the resolved .vdb file of this frame; empty where the shot has none. Throws Error. The shot may leave
// camera and exposure to be chosen (frame_input.h). The same shot gives the same bits, whatever the number of threads.
// `checkpoint` (method path): the file that stores the state of a long render, and from which it resumes; empty: none.
// `kept`: what frames of a sequence hand on (kept_inputs.h); without, each is loaded by itself.
RenderedFrame render_frame(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& progress,
                           const std::filesystem::path& checkpoint = {}, KeptInputs* kept = nullptr);

// The same for a medium that is already loaded.
RenderedFrame render_medium(const Shot& shot, const Medium& medium, Progress& progress,
                            const Surroundings* surroundings = nullptr);

// The plan without rendering: the cells that are computed, and those that are skipped with the reason. Reads the files.
Statistics plan_frame(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& progress);

}  // namespace brisance
