#include "reference/develop_film.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace brisance {

namespace {

const std::vector<std::string> kColour = {"R", "G", "B"};

Rgb beauty(const PathFilm& film, std::size_t pixel, int half) {
    dvec3 sum(0.0);
    for (int which = 0; which < film.order_sums(); ++which)
        for (int c = 0; c < 3; ++c)
            sum[c] += film.sum(pixel, half, which, c);
    return Rgb(sum / double(std::max<std::uint64_t>(film.work.passes, 1)));
}

// Writes the film's sums into the layers of pictures.
class Developer {
public:
    Developer(const PathFilm& film, const Image& sampled, const CellSet& needed, const OutputSettings& output)
        : film_(film), sampled_(sampled), needed_(needed), output_(output) {}

    // half 0 or 1, or -1 for their mean.
    Image picture(int half) const {
        Image image;
        image.width = film_.width();
        image.height = film_.height();
        Layer& colour = add(image, "", {"R", "G", "B", "A"});
        const Layer& alpha = sampled_.layer("");
        for (std::size_t p = 0; p < pixels(); ++p) {
            const Rgb c = mean(p, half, 0, film_.order_sums());
            float* out = &colour.pixels[4 * p];
            out[0] = c.x, out[1] = c.y, out[2] = c.z, out[3] = alpha.pixels[4 * p + 3];
        }
        if (output_.cell_layers)
            add_cells(image, half);
        add_orders(image, half);
        if (half < 0)
            add_variance(image);
        for (const char* name : {"Z", "albedo"})
            image.layers.push_back(sampled_.layer(name));
        return image;
    }

private:
    std::size_t pixels() const { return std::size_t(film_.width()) * film_.height(); }

    Layer& add(Image& image, const std::string& name, const std::vector<std::string>& channels) const {
        image.layers.push_back({name, channels, true, std::vector<float>(pixels() * channels.size())});
        return image.layers.back();
    }

    Rgb mean(std::size_t pixel, int half, int first, int last) const {
        dvec3 sum(0.0);
        for (int h = 0; h < 2; ++h)
            for (int which = first; which < last && (half < 0 || half == h); ++which)
                for (int c = 0; c < 3; ++c)
                    sum[c] += film_.sum(pixel, h, which, c);
        return Rgb(sum / (double(film_.work.passes) * (half < 0 ? 2.0 : 1.0)));
    }

    void fill(Image& image, const std::string& name, int half, int first, int last) const {
        Layer& layer = add(image, name, kColour);
        for (std::size_t p = 0; p < pixels(); ++p) {
            const Rgb c = mean(p, half, first, last);
            for (int k = 0; k < 3; ++k)
                layer.pixels[3 * p + k] = c[k];
        }
    }

    void add_cells(Image& image, int half) const {
        if (film_.sums() > film_.order_sums()) {
            for (int cell = 0; cell < kCells; ++cell)
                if (needed_[cell])
                    fill(image, kCellNames[cell], half, film_.order_sums() + cell, film_.order_sums() + cell + 1);
            return;
        }
        fill(image, "V", half, 0, 1);
        if (needed_.contains(Cell::MV))
            fill(image, "MV", half, 1, 2);
        if (needed_.contains(Cell::MM))
            fill(image, "MM", half, 2, film_.order_sums());
    }

    void add_orders(Image& image, int half) const {
        const bool once = needed_.contains(Cell::MV) || needed_.contains(Cell::SV) || needed_.contains(Cell::SA) ||
                          needed_.contains(Cell::MA);
        const bool twice = needed_.contains(Cell::MM) || needed_.contains(Cell::SS);
        if (!output_.bounce_layers || !once)
            return;
        fill(image, "bounce1", half, 1, 2);
        for (int order = 2; twice && order < kPathOrders; ++order) {
            const bool last = order + 1 == kPathOrders;
            fill(image, last ? "bounces_beyond" + std::to_string(order - 1) : "bounce" + std::to_string(order), half,
                 order, order + 1);
        }
    }

    void add_variance(Image& image) const {
        Layer& layer = add(image, "variance", kColour);
        constexpr double most = std::numeric_limits<float>::max();  // the square of a light of 1e20 is beyond it
        const double n = 2.0 * film_.work.passes;
        for (std::size_t p = 0; p < pixels(); ++p) {
            const Rgb m = mean(p, -1, 0, film_.order_sums());
            for (int c = 0; c < 3; ++c)
                layer.pixels[3 * p + c] = static_cast<float>(
                    std::clamp((film_.square(p, c) / n - double(m[c]) * m[c]) / std::max(n - 1.0, 1.0), 0.0, most));
        }
    }

    const PathFilm& film_;
    const Image& sampled_;
    const CellSet& needed_;
    const OutputSettings& output_;
};

}  // namespace

double relative_standard_error(const PathFilm& film) {
    double noise = 0.0, norm = 0.0;
    for (std::size_t p = 0; p < std::size_t(film.width()) * film.height(); ++p) {
        const dvec3 a(beauty(film, p, 0)), b(beauty(film, p, 1));
        noise += glm::dot(a - b, a - b) / 4.0;
        norm += glm::dot(a + b, a + b) / 4.0;
    }
    return norm > 0.0 ? std::sqrt(noise / norm) : 0.0;
}

double relative_error_of_mean(const PathFilm& film) {
    double a = 0.0, b = 0.0;
    for (std::size_t p = 0; p < std::size_t(film.width()) * film.height(); ++p) {
        a += luminance(beauty(film, p, 0));
        b += luminance(beauty(film, p, 1));
    }
    return a + b > 0.0 ? std::abs(a - b) / (a + b) : 0.0;
}

Image develop(const PathFilm& film, int half, const Image& sampled, const CellSet& needed,
              const OutputSettings& output) {
    return Developer(film, sampled, needed, output).picture(half);
}

}  // namespace brisance
