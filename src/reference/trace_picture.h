// The path tracer's picture: passes over all pixels until enough is known.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "camera/camera.h"
#include "core/progress.h"
#include "emitters/surroundings.h"
#include "film/image.h"
#include "film/settings.h"
#include "reference/path_film.h"
#include "statistics/statistics.h"

namespace brisance {

// Where the state of a long render is kept, and what it belongs to.
struct Checkpoint {
    std::filesystem::path file;  // empty: none is kept
    std::string key;             // everything that decides the bits
};

// What is traced, by reference, and which layers are written.
struct TracedScene {
    const Medium& medium;
    const Camera& camera;
    const Surroundings* surroundings = nullptr;  // null: none
    TracingSettings tracing;
    int bounces = -1;  // the most scatterings of a path; -1: all
    CellSet needed;    // ledger cells that can be other than zero
    OutputSettings output;
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
TracedPicture trace_picture(const TracedScene& scene, const Checkpoint& checkpoint, Statistics& statistics,
                            Progress& progress);

}  // namespace brisance
