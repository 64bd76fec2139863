// Film strips: a few frames of a still, in which all that a method draws at random or divides into voxels changes as it
// does in a sequence, while the true picture stays the same. What changes from frame to frame is flicker.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "film/image.h"
#include "measure_runs.h"
#include "metrics/comparison.h"
#include "page_pictures.h"
#include "reference.h"
#include "report.h"
#include "shot/shot.h"
#include "volume/frame_path.h"

namespace brisance {

// The shot of a strip's frame, from 0, which is the shot itself. For each further one everything that has a place,
// and the camera, lies (3, 5, 7) voxels farther, and every seed is another. `voxel` [m]: 0 where there is no volume,
// and then nothing moves. `shot.camera_given` must be set.
Shot frame_of_strip(const Shot& shot, int frame, double voxel);

// The change from frame to frame of pictures that ought to be the same, relative to the reference:
//
//   sqrt(mean over n of ||I_n - I_(n-1)||^2 / 2) / ||R||
//
// over all pixels that are finite in every frame. Noise that is new in each frame has its own rRMSE, an error that
// stands still has none. ||R||^2 is the sum of A B where the reference has two halves. NaN without light, and with
// fewer than two frames. All of one size.
double flicker_of(std::span<const Picture> frames, const Reference& reference);

// The same of each pixel, on the scale of relative_error_map.
Plane flicker_map(std::span<const Picture> frames, const Reference& reference);

// The frames of every method's first step, in the cells that it owns and that hold light.
class FilmStrips {
public:
    void add_frame(const Method& method, const Image& image, const ReportReference& reference);

    // By cell; the frames in the order in which they were added. Empty where the method has none.
    const std::map<std::string, std::vector<Picture>>& of(const Method& method) const;

private:
    std::map<std::string, std::map<std::string, std::vector<Picture>>> frames_;  // by label
};

struct StripRequest {
    int frames = 3;      // with those that `strips` holds already
    double voxel = 0.0;  // as of frame_of_strip [m]
    FrameFile file;
};

// Renders the frames that `strips` lacks, for the methods of `report`, and adds their flicker to it and the strips to
// `pictures`. A frame that fails becomes a failure of its method. `shot`: of the report, its camera given.
void measure_strips(const StripRequest& request, const Shot& shot, const std::vector<PlannedMethod>& methods,
                    const ReportReference& reference, FilmStrips& strips, Report& report, PagePictures& pictures,
                    Progress& progress);

}  // namespace brisance
