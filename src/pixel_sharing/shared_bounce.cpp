#include "pixel_sharing/shared_bounce.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr int kUsualRays = 16;
constexpr float kLeastPixels = 1.5f;  // of a base's radius
constexpr int kReach = 4;             // neighbours to each side, in steps
constexpr int kSteps[] = {1, 4, 16};  // [pixels]
constexpr float kMostPixels = float(kReach * 16);
constexpr int kMostPatches = 4;  // of a pixel

// A sample belongs to a patch whose normal has at least this cosine to its own, and whose plane is nearer than this
// many pixels.
constexpr float kSameNormal = 0.9f, kSamePlane = 2.0f;

// Neighbours share nothing where their normals have one less this cosine, for a lobe of width 1, where their planes lie
// apart by this part of the radius, or where the widths of their lobes differ by this part.
constexpr float kOtherNormal = 0.2f, kOtherPlane = 0.1f, kOtherLobe = 0.2f;

// 1 for lobes of the same width, 0 for others.
float alike(float lobe, float other) {
    const float apart = (lobe - other) / (kOtherLobe * std::max(lobe, other));
    return std::max(0.0f, 1.0f - apart * apart);
}

float square(float x) {
    return x * x;
}

// What a normal may turn by, for a lobe of that width: a reflection turns twice as far.
float turned(float lobe) {
    return lobe < 1.0f ? 0.5f * lobe : lobe;
}

}  // namespace

SharedBounce::SharedBounce(int width, int height, double radius, int rays, std::vector<Apart> told)
    : width_(width),
      height_(height),
      radius_(float(radius * std::pow(double(kUsualRays) / std::max(rays, 1), 1.0 / 6.0))),
      told_(std::move(told)),
      first_(std::size_t(width) * height, kNone) {}

// Lists that grow hold up to twice what is in them. Sharing makes radii and new light beside.
std::uint64_t SharedBounce::bytes_of(int width, int height, std::size_t told) {
    constexpr std::uint64_t kLobes = 2, kGrowth = 2;
    const std::uint64_t apart = told * (kGrowth + 1) * sizeof(Rgb);
    const std::uint64_t patch = kGrowth * sizeof(Patch) + sizeof(float) + sizeof(Rgb) + apart;
    return std::uint64_t(width) * std::uint64_t(height) * (sizeof(std::uint32_t) + sizeof(Rgb) + kLobes * patch);
}

bool SharedBounce::add(const Sample& s) {
    std::uint32_t* at = &first_[s.pixel];
    for (int patches = 0; *at != kNone; ++patches) {
        const Patch& p = patches_[*at];
        const vec3 normal = glm::normalize(p.normal);
        const float off_plane = std::abs(glm::dot(s.position - p.position / p.samples, normal));
        if (glm::dot(s.normal, normal) > kSameNormal && off_plane < kSamePlane * s.pixel_size &&
            alike(s.lobe, p.lobe / p.samples) > 0.0f)
            break;
        if (patches + 1 == kMostPatches)
            return false;
        at = &patches_[*at].next;
    }
    const std::size_t found = *at == kNone ? patches_.size() : *at;
    if (*at == kNone) {
        *at = static_cast<std::uint32_t>(found);
        patches_.emplace_back();  // may move what `at` points to
        apart_.resize(apart_.size() + told_.size(), Rgb(0.0f));
    }
    for (std::size_t t = 0; t < told_.size(); ++t)
        apart_[found * told_.size() + t] += s.of(told_[t]);
    Patch& p = patches_[found];
    p.position += s.position;
    p.normal += s.normal;
    p.pixel_size += s.pixel_size;
    p.area += s.area;
    p.lobe += s.lobe;
    p.light += s.light;
    p.weight += s.weight;
    p.closeness += s.closeness;
    p.met += s.closeness > 0.0f ? 1.0f : 0.0f;
    p.samples += 1.0f;
    return true;
}

void SharedBounce::take_means() {
    for (std::size_t k = 0; k < apart_.size(); ++k)
        apart_[k] /= patches_[k / told_.size()].samples;
    for (Patch& p : patches_) {
        const float each = 1.0f / p.samples;
        p.position *= each;
        p.normal = glm::normalize(p.normal);
        p.pixel_size *= each;
        p.area *= each;
        p.lobe *= each;
        p.light *= each;
        p.closeness *= each;
        p.met *= each;
    }
}

template <class Visit>
void SharedBounce::for_each_patch(const Visit& visit) const {
    parallel_for(
        first_.size(),
        [&](std::size_t pixel) {
            for (std::uint32_t k = first_[pixel]; k != kNone; k = patches_[k].next)
                visit(pixel, k);
        },
        256);
}

template <class Take>
void SharedBounce::for_neighbours(std::size_t pixel, const Patch& patch, float radius, int step,
                                  const Take& take) const {
    const int x = int(pixel % std::size_t(width_)), y = int(pixel / std::size_t(width_));
    const int reach = std::min(kReach, int(radius / (patch.pixel_size * float(step))) + 1);
    const float inverse = 1.0f / radius, least_facing = 1.0f - kOtherNormal * square(turned(patch.lobe));
    for (int dy = -reach; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
            const int u = x + dx * step, v = y + dy * step;
            if (u < 0 || u >= width_ || v < 0 || v >= height_)
                continue;
            for (std::uint32_t k = first_[std::size_t(v) * width_ + u]; k != kNone; k = patches_[k].next) {
                const Patch& other = patches_[k];
                const vec3 offset = (other.position - patch.position) * inverse;
                const float far = glm::dot(offset, offset), facing = glm::dot(other.normal, patch.normal);
                const float off_plane = glm::dot(offset, patch.normal) / kOtherPlane;
                if (far >= 1.0f || facing <= least_facing || off_plane * off_plane >= 1.0f)
                    continue;
                if (const float same_lobe = alike(patch.lobe, other.lobe); same_lobe > 0.0f)
                    take(k, other.area * other.samples * square(1.0f - far) * (1.0f - off_plane * off_plane) *
                                same_lobe * (facing - least_facing));
            }
        }
}

// How far each patch shares [m]; 0 where the camera touches the surface. Distances to surfaces around are noisy
// themselves and are averaged first. Rays that meet none bring no light, and say nothing of how it changes.
std::vector<float> SharedBounce::radii() const {
    std::vector<float> radius(patches_.size(), 0.0f);
    for_each_patch([&](std::size_t pixel, std::uint32_t k) {
        const Patch& p = patches_[k];
        if (!(p.pixel_size > 0.0f))
            return;
        float closeness = 0.0f, met = 0.0f;
        for_neighbours(pixel, p, kReach * p.pixel_size, 1, [&](std::uint32_t j, float w) {
            closeness += w * patches_[j].closeness;
            met += w * patches_[j].met;
        });
        const float least = p.lobe == 1.0f ? kLeastPixels * p.pixel_size : 0.0f, most = kMostPixels * p.pixel_size;
        radius[k] = closeness > 0.0f ? std::clamp(radius_ * p.lobe * met / closeness, least, most) : most;
    });
    return radius;
}

void SharedBounce::share(const std::vector<float>& radius, int step) {
    std::vector<Rgb> light(patches_.size()), apart(apart_);
    const std::size_t told = told_.size();
    for_each_patch([&](std::size_t pixel, std::uint32_t k) {
        const Patch& p = patches_[k];
        light[k] = p.light;
        // What is nearer than a step has been shared by the step before.
        if (radius[k] <= (step > 1 ? float(step) * p.pixel_size : 0.0f))
            return;
        Rgb sum(0.0f);
        Aparts sums{};
        float weights = 0.0f;
        for_neighbours(pixel, p, std::min(radius[k], float(kReach * step) * p.pixel_size), step,
                       [&](std::uint32_t j, float w) {
                           // Nor farther than the neighbour shares: beside things its light changes quickly.
                           const vec3 offset = patches_[j].position - p.position;
                           const float within = 1.0f - glm::dot(offset, offset) / square(radius[j]);
                           if (j != k && !(within > 0.0f))
                               return;
                           w *= j == k ? 1.0f : square(within);
                           sum += w * patches_[j].light;
                           weights += w;
                           for (std::size_t t = 0; t < told; ++t)
                               sums[t] += w * apart_[j * told + t];
                       });
        if (!(weights > 0.0f))
            return;
        light[k] = sum / weights;
        for (std::size_t t = 0; t < told; ++t)
            apart[k * told + t] = sums[t] / weights;
    });
    apart_.swap(apart);
    for (std::size_t k = 0; k < patches_.size(); ++k)
        patches_[k].light = light[k];
}

std::vector<Rgb> SharedBounce::take_pixels() {
    take_means();
    const std::vector<float> radius = radii();
    for (const int step : kSteps)
        share(radius, step);
    std::vector<Rgb> out(first_.size(), Rgb(0.0f));
    for_each_patch([&](std::size_t pixel, std::uint32_t k) { out[pixel] += patches_[k].weight * patches_[k].light; });
    return out;
}

bool SharedBounce::tells(Apart which) const {
    return std::find(told_.begin(), told_.end(), which) != told_.end();
}

std::vector<Rgb> SharedBounce::told_pixels(Apart which) const {
    std::vector<Rgb> out(first_.size(), Rgb(0.0f));
    const auto at = static_cast<std::size_t>(std::find(told_.begin(), told_.end(), which) - told_.begin());
    if (at < told_.size())
        for_each_patch([&](std::size_t pixel, std::uint32_t k) {
            out[pixel] += patches_[k].weight * apart_[k * told_.size() + at];
        });
    return out;
}

// The weights of share() are 1 - r^2 twice squared, less what normals and planes take: a fifth of the circle.
float SharedBounce::pixels_sharing(const Sample& s, float closeness) const {
    constexpr float kOfCircle = 0.2f * std::numbers::pi_v<float>;
    const float most = kMostPixels * s.pixel_size;
    const float radius = closeness > 0.0f ? std::min(radius_ * s.lobe / closeness, most) : most;
    return s.area > 0.0f ? std::max(1.0f, kOfCircle * square(radius) / s.area) : 1.0f;
}

}  // namespace brisance
