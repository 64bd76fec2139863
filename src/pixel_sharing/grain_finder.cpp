#include "pixel_sharing/grain_finder.h"

#include <algorithm>
#include <utility>

#include "pixel_sharing/share_light.h"

namespace brisance {

namespace {

// Of what its pixel shows without it, and of what half of those around show: from there on a sample is a grain.
constexpr float kStandsOut = 0.5f;

// Pixels to each side that are looked at.
constexpr int kPixelsAround = 3;

}  // namespace

// Pixels around, by how many show the same surface, and what all of them show.
struct GrainFinder::Around {
    std::vector<float> luminances;
    float of_surface = 0.0f;
    float median() {
        const auto middle = luminances.begin() + std::ptrdiff_t(luminances.size() / 2);
        std::ranges::nth_element(luminances, middle);
        return luminances.empty() ? 0.0f : *middle;
    }
};

GrainFinder::GrainFinder(std::span<const SurfaceSample> samples, std::vector<Shown> shown, int width,
                         const SharedBounce* shared, DividedGrains& grains)
    : samples_(samples),
      shown_(std::move(shown)),
      width_(static_cast<std::size_t>(width)),
      shared_(shared),
      grains_(grains) {
    if (samples.empty())
        return;
    origin_ = samples.front().pixel / width_ * width_;
    pixels_.resize(((samples.back().pixel - origin_) / width_ + 1) * width_);
    for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
        Pixel& p = pixels_[samples[begin].pixel - origin_];
        p = {samples[begin].beside, begin, begin};
        DividedGrains::Surface first = surface(begin);
        first.share = 0.0f;
        for (; end < samples.size() && samples[end].pixel == samples[begin].pixel; ++end) {
            p.luminance += shown_[end].luminance;
            first.share += samples[end].share;
            if (first.normal == vec3(0.0f))
                first.normal = shown_[end].normal;
        }
        p.end = end;
        grains.show(samples[begin].pixel, first);
    }
}

DividedGrains::Surface GrainFinder::surface(std::size_t sample) const {
    const SurfaceSample& s = samples_[sample];
    return {vec3(s.ray.origin + s.hit.distance * s.ray.direction), shown_[sample].normal, s.hit.mesh, s.share};
}

GrainFinder::Around GrainFinder::around(std::size_t sample) const {
    const auto at = static_cast<int>(samples_[sample].pixel - origin_), width = static_cast<int>(width_);
    const int px = at % width, py = at / width, height = static_cast<int>(pixels_.size()) / width;
    const DividedGrains::Surface own = surface(sample);
    Around of_surface, of_all;
    for (int y = std::max(py - kPixelsAround, 0); y <= std::min(py + kPixelsAround, height - 1); ++y)
        for (int x = std::max(px - kPixelsAround, 0); x <= std::min(px + kPixelsAround, width - 1); ++x) {
            const Pixel& p = pixels_[std::size_t(y) * width_ + std::size_t(x)];
            if ((x == px && y == py) || p.end == p.begin)
                continue;
            of_all.luminances.push_back(p.luminance);
            for (std::size_t i = p.begin; i < p.end; ++i)
                if (DividedGrains::on_one_surface(own, surface(i))) {
                    of_surface.luminances.push_back(p.luminance);
                    of_surface.of_surface += 1.0f;
                    break;
                }
        }
    return of_surface.luminances.empty() ? of_all : of_surface;
}

// Of a grain: over what the pixels around show, or its own without it. 0: it is none. `noise`: what of its luminance no
// other sample tells, where so many pixels show its surface.
template <class Noise>
float GrainFinder::excess(std::size_t sample, const Noise& noise) const {
    const float all = noise(1.0f), beside = pixels_[samples_[sample].pixel - origin_].luminance - all;
    // In this order what is not a number stays where it is.
    if (!(all > kStandsOut * beside))
        return 0.0f;
    Around near = around(sample);
    const float alone = noise(1.0f + near.of_surface), least = std::max(near.median(), beside);
    if (near.luminances.empty() || !(alone > kStandsOut * least))
        return 0.0f;
    return all / std::max(least, 1e-6f * all);
}

bool GrainFinder::take(std::size_t sample, float stands_for, const CellSum& found,
                       std::span<SharedBounce::Sample* const> left) {
    const float share = stands_for * samples_[sample].share;
    DividedGrains::Grain grain{samples_[sample].pixel, surface(sample), 0.0f, {}};
    grain.excess = excess(sample, [&](float pixels) {
        float sum = share * luminance(found);
        for (const SharedBounce::Sample* s : left)
            if (s)
                sum += stands_for * luminance(s->shown()) / std::min(pixels, shared_->pixels_within(*s, s->closeness));
        return sum;
    });
    if (!(grain.excess > 0.0f))
        return false;
    CellSum all;
    all.add(found, Rgb(share));
    for (SharedBounce::Sample* s : left)
        if (s) {
            all.add(shown_by_cell(*s), Rgb(stands_for));
            s->light = Rgb(0.0f);
            s->apart = {};
        }
    for (std::size_t k = 0; k < grain.light.size(); ++k)
        grain.light[k] = all.at(DividedGrains::kOfSurfaces[k]);
    grains_.add(grain);
    return true;
}

}  // namespace brisance
