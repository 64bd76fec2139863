// The pictures of the page: PNGs at several exposures, and maps of errors.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "film/settings.h"
#include "metrics/picture.h"

namespace brisance {

struct PagePictureSettings {
    int most_width = 480;                        // wider pictures are reduced to this [pixels]
    std::vector<double> exposures = {-3, 0, 3};  // beside `base_exposure` [stops]
    double base_exposure = 0.0;                  // [stops]
    ViewTransform view = ViewTransform::Filmic;
    int strip_width = 48;  // of the frames of film strips, at most [pixels]
};

class PagePictures {
public:
    explicit PagePictures(const PagePictureSettings& settings) : settings_(settings) {}

    // `id` is a run's, or "reference".
    void add_picture(const std::string& id, const std::string& layer, const Picture& picture);

    // Maps of |I - R| / (|R| + epsilon), mean of the channels, and of FLIP's errors. Both pictures of one size.
    void add_errors(const std::string& id, const std::string& layer, const Picture& image, const Picture& reference,
                    double epsilon, const Plane& flip);

    // A film strip (film_strip.h): its frames, and the map of what changes between them.
    void add_strip(const std::string& id, const std::string& cell, std::span<const Picture> frames, const Plane& change,
                   double exposure);

    nlohmann::ordered_json to_json() const;

private:
    using ByLayer = std::map<std::string, nlohmann::ordered_json>;

    PagePictureSettings settings_;
    int width_ = 0, height_ = 0;  // as shown
    std::map<std::string, ByLayer> images_, relative_, flip_, strips_;
};

// Relative errors on the logarithmic scale of the map: 0 for 0.1 % and less, 1 for 100 % and more, or not finite.
Plane relative_error_map(const Picture& image, const Picture& reference, double epsilon);

// The exposure [stops] at which the picture's bright parts are just below white.
double exposure_for(const Picture& picture);

// Means over equal areas, so that the result is at most `most_width` wide; unchanged when it is already.
Picture reduced(const Picture& picture, int most_width);
Plane reduced(const Plane& plane, int most_width);

}  // namespace brisance
