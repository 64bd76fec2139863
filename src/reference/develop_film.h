// From the sums of a film to the layers of a picture.
#pragma once

#include "film/image.h"
#include "film/settings.h"
#include "reference/path_film.h"

namespace brisance {

// The root of the summed squares of half the halves' difference, over that of their mean.
double relative_standard_error(const PathFilm& film);
// The standard error of the picture's mean luminance over that mean. One pair of halves gives its order of magnitude.
double relative_error_of_mean(const PathFilm& film);

// `half`: 0 or 1, or -1 for their mean, which also has the layer "variance". `sampled`: a picture with alpha, Z and
// albedo; `needed`: the cells that have layers.
Image develop(const PathFilm& film, int half, const Image& sampled, const CellSet& needed,
              const OutputSettings& output);

}  // namespace brisance
