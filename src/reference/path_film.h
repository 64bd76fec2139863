// The sums of a picture's paths in two independent halves, and their serialisation for a checkpoint.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reference/path_tracer.h"

namespace brisance {

// Holds sums, not means, in double precision. Adding in the same order gives the same bits wherever it was interrupted.
class PathFilm {
public:
    // With `orders` the film keeps every order of scattering apart, otherwise the ledger's cells V, MV, MM. With
    // `cells`
    // it also keeps all of the ledger's cells, after them.
    PathFilm(int width, int height, bool orders, bool cells = false);

    // Adds the radiance of one camera ray to a pixel's half (0 or 1). Two threads must not add to the same pixel.
    // Returns false for a value that is not finite, which is left out.
    bool add(std::size_t pixel, int half, const PathSum& path);

    int width() const { return width_; }
    int height() const { return height_; }
    int sums() const { return sums_; }          // per pixel and half: orders and cells
    int order_sums() const { return orders_; }  // 3, or kPathOrders; what they add up to is everything
    double sum(std::size_t pixel, int half, int which, int channel) const {
        return values_[(pixel * 2 + half) * sums_ * 3 + which * 3 + channel];
    }
    // Sum of the squared radiance of single paths over both halves.
    double square(std::size_t pixel, int channel) const { return squares_[pixel * 3 + channel]; }

    // A checkpoint: the work's state, the sums, and the `key` of what was rendered.
    std::string serialise(const std::string& key) const;
    // Restores the state in `bytes`. Returns an empty string, or else the reason why they cannot be used; the film is
    // then unchanged.
    std::string restore(const std::string& bytes, const std::string& key);

    // Progress: passes finished (one camera ray in each half of each pixel), rows finished of the pass under way.
    struct Work {
        std::uint64_t passes = 0;
        std::uint64_t rows = 0;
        std::uint64_t paths = 0;
        std::uint64_t scatterings = 0;
        std::uint64_t not_finite = 0;
        std::uint64_t bad_pixel = 0;  // of the first path that was not finite, ...
        std::uint64_t bad_sample = 0;
        double seconds = 0.0;
    };
    Work work;

    std::uint64_t bytes() const { return (values_.size() + squares_.size()) * sizeof(double); }

private:
    int width_, height_, orders_, sums_;
    std::vector<double> values_, squares_;
};

}  // namespace brisance
