// Settings that limit the cost of a certificate.
#pragma once

namespace brisance {

struct CertifySettings {
    bool enabled = false;   // estimate the finished frame's error
    int samples = 1 << 19;  // camera rays with their paths, in the whole picture, whatever its size
    int seed = 0;           // other seeds choose other pixels and other samples
};

}  // namespace brisance
