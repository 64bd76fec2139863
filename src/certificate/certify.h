// The error of a finished picture against the truth, from a small and stated number of unbiased samples:
// rays of the camera with all their paths.
//
// Squared error without bias: two independent samples at a pixel bring x and y, both with the pixel's true value R as
// their mean, so that (I - x)(I - y) has the mean (I - R)^2: independent noise multiplies to nothing. Averaged over all
// pairs of a pixel's samples and summed over the picture by a survey of its pixels, that is the numerator of
//     error^2 = sum (I - R)^2 / sum R^2,
// and as R^2 = I^2 - 2 I (I - R) + (I - R)^2, the same numbers correct the picture's own sum of squares to the
// denominator. The interval of the ratio is Fieller's (Some Problems in Interval Estimation, 1954).
//
// The samples are of a stream of their own: independent of all that made the picture.
#pragma once

#include "camera/camera.h"
#include "certificate/certificate.h"
#include "certificate/settings.h"
#include "core/progress.h"
#include "emitters/surroundings.h"
#include "film/image.h"
#include "tracking/settings.h"

namespace brisance {

// What the picture shows, by reference.
struct CertifiedScene {
    const Medium& medium;
    const Camera& camera;
    const Surroundings* surroundings = nullptr;  // null: none
    TracingSettings tracing;
    int bounces = -1;    // the most scatterings of a path; -1: all
    bool shines = true;  // there is fire, or there are emitters
};

// Of a picture by any method: its beauty, and the ledger cells it has layers of. The estimators are those of
// scene.tracing. The same bits for any number of threads. Warns of pixels and samples that are not finite, and when few
// pixels decide.
//
// What it cannot see: light that none of its samples met, and errors that hide in few pixels. A share s of the pixels
// that is wrongly dark goes unnoticed with probability (1 - s)^(draws / 5); one that is wrongly bright hardly ever.
Certificate certify(const Image& image, const CertifiedScene& scene, const CertifySettings& settings,
                    Progress& progress);

}  // namespace brisance
