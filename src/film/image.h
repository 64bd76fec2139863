// Pixels of one finished frame, all float, linear Rec. 709.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/vec.h"

namespace brisance {

// A named layer of `channels.size()` interleaved channels per pixel, rows from the top.
struct Layer {
    std::string name;                   // "" for the beauty, else "V", "MV", "bounce1", ...
    std::vector<std::string> channels;  // {"R","G","B","A"}, {"R","G","B"}, {"Z"}
    bool full_float = false;            // written as 32-bit float instead of half
    std::vector<float> pixels;          // width * height * channels.size()
};

struct Image {
    int width = 0;
    int height = 0;
    std::vector<Layer> layers;                          // the beauty first
    const Layer& layer(const std::string& name) const;  // throws Error when absent
    Layer& layer(const std::string& name) { return const_cast<Layer&>(std::as_const(*this).layer(name)); }
};

// Of all pixels and colours that are finite.
double sum_of_squares(const Layer& layer);

// `next` is picture number `count` of those that `mean` becomes the mean of; all have the same layers.
void add_to_mean(Image& mean, const Image& next, int count);

// What the header of the EXR records.
struct ImageMetadata {
    int frame = 0;
    dmat4 camera_from_world{
        1.0};  // right-handed: x right, y up, looking along -z; converted to the EXR convention on writing
    double vertical_fov_degrees = 0.0;
    double render_seconds = 0.0;
    double samples_per_pixel = 0.0;
    double frames_per_second = 0.0;           // 0: not recorded
    std::string comments;                     // for people; empty: not recorded
    std::map<std::string, std::string> text;  // "brisance/version", "brisance/shot", "brisance/volume", ...
};

}  // namespace brisance
