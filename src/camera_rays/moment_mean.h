// The mean of pictures of several moments.
#pragma once

#include "film/image.h"

namespace brisance {

// Pictures with the same layers, of equal weight. Layers are averaged; Z is weighted by the opacity of its picture and
// stays what it is where nothing is visible.
class MomentMean {
public:
    void add(Image picture);
    Image take();  // of at least one picture

private:
    Image sum_;
    std::vector<float> depth_, opacity_;  // per pixel: sums of A Z and of A
    int count_ = 0;
};

}  // namespace brisance
