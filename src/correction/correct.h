// Puts back what unbiased samples find that a picture by many lights misses.
//
// Samples are camera rays with all their paths, as the reference traces them. The difference R - I of each from the
// picture has the mean of the picture's residual. It is far noisier than the picture is wrong, but a picture by many
// lights errs alike over many pixels: smooth_residual() blurs the differences as much as their noise demands, and what
// is left of them is added to the picture. Each cell of the ledger that lattices light, and that has a layer, is
// corrected by its own light, and cells still add up. What is seen directly (V, A) is measured and left as it is, and
// what is sampled at surfaces (SS, SA) is left to its own noise; SV and SM have the errors of lattices, too.
//
// Pixels are drawn by a survey (certificate/pixel_survey.h) in proportion to the root of the light that is corrected:
// between even, which a smooth residual wants, and in proportion to it, as the noise of bright pixels wants. Black
// pixels stay black. The expected error falls with every sample, and the correction vanishes where the samples say
// nothing: of noise, or of a picture that is right. A certificate draws samples of its own, and judges it as any other
// picture.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "certificate/certificate.h"
#include "certificate/estimated_layers.h"
#include "certificate/pixel_survey.h"
#include "core/progress.h"
#include "correction/residual_pyramid.h"
#include "film/image.h"
#include "reference/moment_tracers.h"

namespace brisance {

struct CorrectedLayer {
    std::string name;                 // empty: the picture
    std::vector<ResidualBand> bands;  // those of SmoothResidual
    double square = 0.0;              // sum of its own squares before the correction
    bool corrected = true;            // false: measured, and left as it is
    // The error before the correction, as the samples measured it.
    CertifiedError before() const;
    // The part of it that is above zero in each band.
    double found() const;
    // What should be left of an error of the layer, relative to it, or would be with so many times the samples. Few
    // samples hardly tell which bands have it: without them it is taken to be alike in all octaves of wavelength, give
    // or take as much, and what they measured counts by its variance beside that. Gains are those that there are; with
    // more samples, those that such a residual would have. What was not found is in bands of which little is known, and
    // stays.
    double left(double error, double samples = 1.0) const;
};

struct Correction {
    std::uint64_t samples = 0, not_finite = 0;  // the latter are left out
    // The cells but for SS and SA, or the beauty where there are no layers of cells; empty without samples.
    std::vector<CorrectedLayer> layers;
    const CorrectedLayer* of(const std::string& cell) const;
};

// The relative error that can be believed of a layer before its correction; empty: all that its samples say.
using BelievableError = std::function<double(const CorrectedLayer&)>;

class Corrector {
public:
    // Keeps references. `surroundings`: that of the tracers, whether there is one.
    Corrector(Image& image, const MomentTracers& tracers, bool surroundings);

    // About as many samples more; none of a black picture. The bits do not depend on the number of threads.
    void sample(std::size_t samples, Progress& progress);
    // What they would do.
    Correction measured(const BelievableError& believable = {}) const;
    // Does it, once.
    Correction correct(const BelievableError& believable = {});

    // What it needs besides the picture, of which it corrects so many layers.
    static std::uint64_t bytes_of(int width, int height, std::size_t layers, std::size_t samples);

private:
    void survey(std::size_t samples, const std::function<void(std::size_t)>& drawn);
    void add(const PixelSurvey::Draw& draw, bool second, const PathSum& found);
    Believable believable_square(std::size_t layer, const BelievableError& believable) const;
    CorrectedLayer of(std::size_t layer, std::vector<ResidualBand> bands) const;

    Image& image_;
    const MomentTracers& tracers_;
    std::vector<EstimatedLayer> layers_;
    std::vector<double> squares_;      // of the layers, summed
    std::vector<NoisyResidual> sums_;  // of the layers, times the number of samples
    std::uint64_t samples_ = 0, not_finite_ = 0, surveys_ = 0;
};

}  // namespace brisance
