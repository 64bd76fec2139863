// The path tracer's picture: passes over all pixels until the error is small enough.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string>

#include "camera/camera.h"
#include "core/progress.h"
#include "emitters/surroundings.h"
#include "film/image.h"
#include "film/settings.h"
#include "reference/moment_tracers.h"
#include "reference/path_film.h"
#include "statistics/statistics.h"

namespace brisance {

// The file that keeps the state of a long render, and the key of that render.
struct Checkpoint {
    std::filesystem::path file;  // empty: none is kept
    std::string key;             // everything that decides the bits
};

// The traced scene, by reference, and the layers to write.
struct TracedScene {
    const Medium& medium;
    const Camera& camera;
    const Surroundings* surroundings = nullptr;  // null: none
    TracingSettings tracing;
    int bounces = -1;  // the most scatterings of a path; -1: all
    CellSet needed;    // ledger cells that can be other than zero
    OutputSettings output;
    std::span<const Moment> moments = {};  // of the shutter; empty: nothing moves
};

struct TracedPicture {
    Image image;
    std::array<Image, 2> halves;  // independent; their mean is `image`
    double samples_per_pixel = 0.0;
};

// The camera ray of a path, in local space. The same seed, pixel and number give the same position in the pixel.
Ray sample_ray(const Camera& camera, int seed, std::size_t pixel, std::uint64_t sample);

// Traces one path of a pixel, the same for the same picture size, seed, pixel, and number. Even numbers belong to the
// first half. The light of its vertices is weighted by the pixel's filter as the sum is.
PathSum trace_sample(const PathTracer& tracer, const Camera& camera, std::size_t pixel, std::uint64_t sample,
                     PathStatistics& statistics);

// The number of the moment at which that path is traced, of `moments`: evenly spread over the paths of a pixel.
std::size_t moment_of_sample(int seed, std::size_t pixel, std::uint64_t sample, const MomentTracers& moments);

// Continues from the checkpoint if there is one. The layers are those of render_picture, all 32 bit, and "variance":
// the variance of each pixel's mean, from the spread of its paths. Stratification makes the true one smaller. With
// tracing.denoising_radius all of them are filtered (film/noise_filter.h). Throws
// Error BadData when the checkpoint does not belong to this render.
TracedPicture trace_picture(const TracedScene& scene, const Checkpoint& checkpoint, Statistics& statistics,
                            Progress& progress);

}  // namespace brisance
