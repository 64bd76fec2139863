// What the bound of virtual point lights does to the light between surfaces (SS) of each pixel: T = T_b + T_r made
// visible (virtual_lights/kinds/bounded_geometry.h).
#pragma once

#include <cstdint>
#include <vector>

#include "virtual_lights/bounded_light.h"

namespace brisance {

// Not thread-safe.
class BoundAccount {
public:
    explicit BoundAccount(std::size_t pixels) : residual_(pixels, Rgb(0.0f)), shown_(pixels, 0.0), lost_(pixels, 0.0) {}

    // What a sample found out; the pixel shows light times weight.
    void add(std::uint32_t pixel, const BoundTally& tally, const Rgb& weight) {
        residual_[pixel] += weight * tally.residual;
        shown_[pixel] += luminance(weight) * tally.shown;
        lost_[pixel] += luminance(weight) * tally.lost;
        costs_ += tally;
    }
    void add_residual(std::uint32_t pixel, const Rgb& shown) { residual_[pixel] += shown; }
    void add_residual(const std::vector<Rgb>& pixels) {
        for (std::size_t p = 0; p < pixels.size(); ++p)
            residual_[p] += pixels[p];
    }

    // Of each pixel: what compensation has brought [W/(m^2 sr)], and the luminance of the lights that its samples have
    // asked, as bounded and as taken away by the bound.
    const std::vector<Rgb>& residual() const { return residual_; }
    const std::vector<double>& shown() const { return shown_; }
    const std::vector<double>& lost() const { return lost_; }
    // Its seconds alone.
    BoundTally& costs() { return costs_; }

private:
    std::vector<Rgb> residual_;
    std::vector<double> shown_, lost_;
    BoundTally costs_;
};

}  // namespace brisance
