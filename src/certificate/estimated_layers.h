// The layers of a picture whose truth unbiased samples tell: the beauty, and cells of the ledger.
#pragma once

#include <vector>

#include "film/image.h"
#include "reference/path_tracer.h"

namespace brisance {

// The most that a picture has.
inline constexpr std::size_t kMostEstimatedLayers = 1 + kCells;

struct EstimatedLayer {
    const Layer* layer;
    int first_order, end_order;
    int cell = -1;  // instead of the orders
    dvec3 pixel(std::size_t p) const {
        const float* v = &layer->pixels[p * layer->channels.size()];
        return {v[0], v[1], v[2]};
    }
    // What a sample shows of it [W/(m^2 sr)].
    dvec3 seen(const PathSum& path) const;
};

// Those that the picture has, the beauty first. `surroundings`: there are some, so that paths are filed by cell.
std::vector<EstimatedLayer> estimated_layers(const Image& image, bool surroundings);

}  // namespace brisance
