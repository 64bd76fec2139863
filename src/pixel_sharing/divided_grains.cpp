#include "pixel_sharing/divided_grains.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pixel_sharing/share_light.h"

namespace brisance {

namespace {

// Of what its pixel shows without it, and of what half of those around show: from there on a sample is a grain.
constexpr float kStandsOut = 0.5f;

// Pixels to each side.
constexpr int kPixelsAround = 3;

// Less pixels are too few to divide a grain among.
constexpr std::size_t kFew = 8;

// On one surface, normals have at least this cosine, and leave the plane by less than this part of the distance.
constexpr float kNormalOfSurface = 0.9f, kPlaneOfSurface = 0.1f;

dvec3 position(const SurfaceSample& sample) {
    return sample.ray.origin + sample.hit.distance * sample.ray.direction;
}

}  // namespace

DividedGrains::DividedGrains(std::span<const SurfaceSample> samples, std::vector<Shown> shown, int width,
                             const SharedBounce* shared)
    : samples_(samples), shown_(std::move(shown)), width_(static_cast<std::size_t>(width)), shared_(shared) {
    if (samples.empty())
        return;
    origin_ = samples.front().pixel / width_ * width_;
    pixels_.resize(((samples.back().pixel - origin_) / width_ + 1) * width_);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        Pixel& p = pixels_[samples[i].pixel - origin_];
        if (p.end == 0) {
            p.begin = i;
            p.luminance = samples[i].beside;
        }
        p.end = i + 1;
        p.luminance += shown_[i].luminance;
    }
}

bool DividedGrains::on_one_surface(std::size_t sample, std::size_t other) const {
    const vec3& normal = shown_[sample].normal;
    const vec3 apart(position(samples_[other]) - position(samples_[sample]));
    return glm::dot(shown_[other].normal, normal) > kNormalOfSurface &&
           std::abs(glm::dot(apart, normal)) <= kPlaneOfSurface * glm::length(apart);
}

DividedGrains::Around DividedGrains::around(std::size_t sample) const {
    const auto at = static_cast<int>(samples_[sample].pixel - origin_), width = static_cast<int>(width_);
    const int px = at % width, py = at / width, height = static_cast<int>(pixels_.size()) / width;
    Around out;
    for (int y = std::max(py - kPixelsAround, 0); y <= std::min(py + kPixelsAround, height - 1); ++y)
        for (int x = std::max(px - kPixelsAround, 0); x <= std::min(px + kPixelsAround, width - 1); ++x) {
            const Pixel& p = pixels_[std::size_t(y) * width_ + std::size_t(x)];
            if (x == px && y == py)
                continue;
            std::size_t of_surface = p.end, of_mesh = p.end, any = p.end;
            for (std::size_t i = p.end; i-- > p.begin;) {
                if (!(samples_[i].share > 0.0f))
                    continue;
                any = i;
                if (samples_[i].hit.mesh != samples_[sample].hit.mesh)
                    continue;
                of_mesh = i;
                if (on_one_surface(sample, i))
                    of_surface = i;
            }
            if (of_surface < p.end)
                out.surface.push_back(of_surface);
            else if (of_mesh < p.end)
                out.mesh.push_back(of_mesh);
            else if (any < p.end)
                out.others.push_back(any);
        }
    return out;
}

// Who takes a part of a sample, itself among them; none: it is no grain. `noise`: what of its luminance no other sample
// tells, where so many pixels show its surface.
template <class Noise>
std::vector<std::size_t> DividedGrains::receivers(std::size_t sample, const Noise& noise) const {
    const float all = noise(1.0f), beside = pixel_of(sample).luminance - all;
    // In this order what is not a number stays where it is.
    if (!(all > kStandsOut * beside))
        return {};
    Around near = around(sample);
    const float alone = noise(float(1 + near.surface.size()));
    std::vector<std::size_t> among = std::move(near.surface);
    for (const std::vector<std::size_t>& more : {near.mesh, near.others})
        if (among.size() < kFew)
            among.insert(among.end(), more.begin(), more.end());
    if (among.empty())
        return {};
    std::vector<float> luminances;
    for (const std::size_t i : among)
        luminances.push_back(pixel_of(i).luminance);
    const auto middle = luminances.begin() + std::ptrdiff_t(luminances.size() / 2);
    std::ranges::nth_element(luminances, middle);
    if (!(alone > kStandsOut * std::max(*middle, beside)))
        return {};
    among.push_back(sample);
    return among;
}

bool DividedGrains::divide(std::size_t sample, float stands_for, const CellSum& found,
                           std::span<SharedBounce::Sample* const> left, std::vector<CellSum>& light) const {
    const float share = stands_for * samples_[sample].share;
    const std::vector<std::size_t> among = receivers(sample, [&](float pixels) {
        float sum = share * luminance(found);
        for (const SharedBounce::Sample* s : left)
            if (s)
                sum += stands_for * luminance(s->shown()) / std::min(pixels, shared_->pixels_within(*s, s->closeness));
        return sum;
    });
    if (among.empty())
        return false;
    CellSum all;
    all.add(found, Rgb(share));
    for (SharedBounce::Sample* s : left)
        if (s) {
            all.add(shown_by_cell(*s), Rgb(stands_for));
            s->light = Rgb(0.0f);
            s->apart = {};
        }
    for (const std::size_t i : among)
        light[i].add(all, Rgb(1.0f / (float(among.size()) * samples_[i].share)));
    return true;
}

}  // namespace brisance
