// How the reference path tracer samples, and when it stops.
#pragma once

namespace brisance {

enum class EmissionEstimator {
    Line,      // along the whole of every segment
    Collision  // at tentative collisions only: the plain tracker, kept as the baseline
};

enum class FreeFlight {
    Exact,         // inverts the optical depth of each voxel, a polynomial along the ray
    NullCollision  // Woodcock tracking against each brick's majorant
};

enum class TransmittanceEstimator {
    Exact,     // the voxels' own integral
    RayMarch,  // unbiased ray marching (Kettunen et al. 2021)
    Ratio      // ratio tracking
};

struct TracingSettings {
    int seed = 0;                      // other seeds draw other random numbers
    int samples = 64;                  // camera rays per pixel, each with its paths; 0: until `seconds` or `error`
    double seconds = 0.0;              // stop after this time, at the end of a pass; 0: no limit
    double error = 0.0;                // stop at this relative standard error (rRMSE) of the picture; 0: never
    double checkpoint_seconds = 30.0;  // between checkpoints, where one is kept
    EmissionEstimator emission = EmissionEstimator::Line;
    bool light_sampling = true;  // lines toward the fire where smoke is thin, besides those of the phase function
    FreeFlight free_flight = FreeFlight::NullCollision;
    int denoising_radius = 0;  // the finished picture is filtered over so many pixels, a biased baseline; 0: it is not
    TransmittanceEstimator transmittance = TransmittanceEstimator::Exact;  // where nothing burns along a segment
};

}  // namespace brisance
