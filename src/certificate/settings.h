// Settings that limit the cost of certificates and of believed errors.
#pragma once

namespace brisance {

struct CertifySettings {
    bool enabled = false;   // estimate the finished frame's error
    int samples = 1 << 19;  // camera rays with their paths, in the whole picture, whatever its size
    int seed = 0;           // other seeds choose other pixels and other samples
    // Of a frame's forecast time, what its believed error may cost in samples. 0: it comes from the error model alone.
    double belief = 0.03;
};

}  // namespace brisance
