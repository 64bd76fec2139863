// Estimates the error of a finished picture against the truth from a small and stated number of unbiased samples:
// camera rays with all their paths.
//
// The squared error is unbiased. Two independent samples x and y of a pixel both have the pixel's true value R as their
// mean, so the mean of (I - x)(I - y) is (I - R)^2. Averaged over all pairs of a pixel's samples and summed over the
// picture by a survey of its pixels, the result is the numerator of
//     error^2 = sum (I - R)^2 / sum R^2,
// and because R^2 = I^2 - 2 I (I - R) + (I - R)^2, the same samples and the picture's own sum of squares give the
// denominator. The interval of the ratio is Fieller's (Some Problems in Interval Estimation, 1954).
//
// The samples have their own random stream, independent of that of the picture.
#pragma once

#include "camera/camera.h"
#include "certificate/certificate.h"
#include "certificate/settings.h"
#include "core/progress.h"
#include "emitters/surroundings.h"
#include "film/image.h"
#include "reference/moment_tracers.h"
#include "tracking/settings.h"

namespace brisance {

// The scene that the picture shows, by reference.
struct CertifiedScene {
    const Medium& medium;
    const Camera& camera;
    const Surroundings* surroundings = nullptr;  // null: none
    TracingSettings tracing;
    int bounces = -1;                      // the most scatterings of a path; -1: all
    bool shines = true;                    // there is fire, or there are emitters
    std::span<const Moment> moments = {};  // of the shutter; empty: nothing moves
};

// The size of a survey, and the random numbers that it draws.
struct SurveySize {
    std::size_t draws;    // of pixels, some perhaps more than once
    std::size_t samples;  // in all
    int seed;
};

// Certifies a picture by any method: its beauty, and the ledger cells that it has layers of. The estimators are those
// of scene.tracing. The result is the same to the bit for any number of threads. Warns of pixels and samples that are
// not finite, and when few pixels decide.
//
// It cannot detect light that none of its samples found, nor errors in few pixels. If a share s of the pixels is too
// dark, it remains undetected with probability (1 - s)^(draws / 5). Pixels that are too bright are nearly always found.
Certificate certify(const Image& image, const CertifiedScene& scene, const CertifySettings& settings,
                    Progress& progress);

// The same by a survey of the given size, without warnings. `tracers` are of the scene.
Certificate certify(const Image& image, const CertifiedScene& scene, const MomentTracers& tracers,
                    const SurveySize& size, Progress& progress);

MomentTracers tracers_of(const CertifiedScene& scene);

}  // namespace brisance
