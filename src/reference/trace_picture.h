// The path tracer's picture: passes over all pixels until enough is known.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "camera/camera.h"
#include "core/progress.h"
#include "film/image.h"
#include "reference/path_film.h"
#include "render/plan.h"
#include "shot/shot.h"
#include "statistics/statistics.h"

namespace brisance {

// Where the state of a long render is kept, and what it belongs to.
struct Checkpoint {
    std::filesystem::path file;  // empty: none is kept
    std::string key;             // everything that decides the bits
};

struct TracedPicture {
    Image image;
    std::array<Image, 2> halves;  // independent; their mean is `image`
    double samples_per_pixel = 0.0;
};

// The camera's ray of a path, in local space: where in the pixel it lies is the same for the same seed, pixel and
// number.
Ray sample_ray(const Camera& camera, int seed, std::size_t pixel, std::uint64_t sample);

// One path of a pixel, the same for the same picture size, seed, pixel, and number. Even numbers belong to the first
// half. What its vertices gathered is weighted by the pixel's filter as the sum is.
PathSum trace_sample(const PathTracer& tracer, const Camera& camera, std::size_t pixel, std::uint64_t sample,
                     PathStatistics& statistics);

// Goes on from the checkpoint where there is one. Layers as render_picture's, all 32 bit, and "variance": of each
// pixel's mean, by the spread of its paths; stratification makes the true one smaller.
// Throws Error BadData when the checkpoint does not belong to this render.
TracedPicture trace_picture(const Shot& shot, const Plan& plan, const Medium& medium, const Surroundings* surroundings,
                            const Camera& camera, const Checkpoint& checkpoint, Statistics& statistics,
                            Progress& progress);

}  // namespace brisance
