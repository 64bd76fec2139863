#include "pixel_sharing/shared_bounce.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/parallel.h"
#include "pixel_sharing/noise_bands.h"

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

// Neighbours share nothing where their normals have one less this cosine, for a lobe of width 1, or where their planes
// lie apart by this part of the radius.
constexpr float kOtherNormal = 0.2f, kOtherPlane = 0.1f;

float square(float x) {
    return x * x;
}

// What a normal may turn by, for a lobe of that width: a reflection turns twice as far.
float turned(float lobe) {
    return lobe < 1.0f ? 0.5f * lobe : lobe;
}

}  // namespace

SharedBounce::SharedBounce(int width, int height, double radius, int rays, std::vector<Apart> told, bool calms)
    : radius_(float(radius * std::pow(double(kUsualRays) / std::max(rays, 1), 1.0 / 6.0))),
      told_(std::move(told)),
      calms_(calms),
      map_(width, height) {
    light_.kinds = kinds();
}

// Lists that grow hold up to twice what is in them. Sharing makes radii and new light beside; where noise is taken
// away, its squares and what is left.
std::uint64_t SharedBounce::bytes_of(int width, int height, std::size_t told) {
    constexpr std::uint64_t kLobes = 2, kGrowth = 2;
    const std::uint64_t light = (kGrowth + 1) * sizeof(HalvedLight::Halves) + 2 * sizeof(Rgb) + 2 * sizeof(float);
    const std::uint64_t patch = kGrowth * sizeof(Patch) + (kGrowth + 2) * sizeof(float) + (1 + told) * light;
    return std::uint64_t(width) * std::uint64_t(height) * (sizeof(std::uint32_t) + sizeof(Rgb) + kLobes * patch);
}

bool SharedBounce::add(const Sample& s) {
    std::vector<Patch>& patches = map_.patches;
    std::uint32_t* at = &map_.first[s.pixel];
    for (int others = 0; *at != PatchMap::kNone; ++others) {
        const Patch& p = patches[*at];
        const vec3 normal = glm::normalize(p.normal);
        const float off_plane = std::abs(glm::dot(s.position - p.position / p.samples, normal));
        if (glm::dot(s.normal, normal) > kSameNormal && off_plane < kSamePlane * s.pixel_size &&
            alike(s.lobe, p.lobe / p.samples) > 0.0f)
            break;
        if (others + 1 == kMostPatches)
            return false;
        at = &patches[*at].next;
    }
    const std::size_t found = *at == PatchMap::kNone ? patches.size() : *at;
    if (*at == PatchMap::kNone) {
        *at = static_cast<std::uint32_t>(found);
        patches.emplace_back();  // may move what `at` points to
        light_.lights.resize(light_.lights.size() + light_.kinds);
        light_.first.push_back(0.0f);
    }
    Patch& p = patches[found];
    // Neighbours begin with different halves: pixels may have one sample.
    const std::size_t half = (s.pixel + s.pixel / std::uint32_t(map_.width) + std::uint32_t(p.samples)) % 2;
    HalvedLight::Halves* const lights = &light_.lights[found * light_.kinds];
    lights[0][half] += s.light;
    for (std::size_t t = 0; t < told_.size(); ++t)
        lights[1 + t][half] += s.of(told_[t]);
    light_.first[found] += half == 0 ? 1.0f : 0.0f;
    p.position += s.position;
    p.normal += s.normal;
    p.pixel_size += s.pixel_size;
    p.area += s.area;
    p.lobe += s.lobe;
    p.weight += s.weight;
    p.closeness += s.closeness;
    p.met += s.closeness > 0.0f ? 1.0f : 0.0f;
    p.samples += 1.0f;
    p.rays += s.rays;
    return true;
}

void SharedBounce::take_means() {
    for (std::size_t k = 0; k < map_.patches.size(); ++k) {
        Patch& p = map_.patches[k];
        const float each = 1.0f / p.samples;
        p.position *= each;
        p.normal = glm::normalize(p.normal);
        p.pixel_size *= each;
        p.area *= each;
        p.lobe *= each;
        p.closeness *= each;
        p.met *= each;
        const float in_half[2] = {light_.first[k], p.samples - light_.first[k]};
        // A half without samples takes the other's light.
        for (std::size_t i = k * light_.kinds; i < (k + 1) * light_.kinds; ++i) {
            HalvedLight::Halves& light = light_.lights[i];
            const HalvedLight::Halves sums = light;
            for (std::size_t h = 0; h < 2; ++h) {
                const std::size_t from = in_half[h] > 0.0f ? h : 1 - h;
                light[h] = sums[from] / in_half[from];
            }
        }
        light_.first[k] *= each;
    }
}

template <class Take>
void SharedBounce::for_neighbours(std::size_t pixel, const Patch& patch, float radius, int step,
                                  const Take& take) const {
    const int reach = std::min(kReach, int(radius / (patch.pixel_size * float(step))) + 1);
    const float inverse = 1.0f / radius, least_facing = 1.0f - kOtherNormal * square(turned(patch.lobe));
    map_.for_around(pixel, reach, step, [&](std::uint32_t k, int, int) {
        const Patch& other = map_.patches[k];
        const vec3 offset = (other.position - patch.position) * inverse;
        const float far = glm::dot(offset, offset), facing = glm::dot(other.normal, patch.normal);
        const float off_plane = glm::dot(offset, patch.normal) / kOtherPlane;
        if (far >= 1.0f || facing <= least_facing || off_plane * off_plane >= 1.0f)
            return;
        if (const float same_lobe = alike(patch.lobe, other.lobe); same_lobe > 0.0f)
            take(k, other.area * other.rays * square(1.0f - far) * (1.0f - off_plane * off_plane) * same_lobe *
                        (facing - least_facing));
    });
}

// How far each patch shares [m]; 0 where the camera touches the surface. Distances to surfaces around are noisy
// themselves and are averaged first. Rays that meet none bring no light, and say nothing of how it changes.
std::vector<float> SharedBounce::radii() const {
    std::vector<float> radius(map_.patches.size(), 0.0f);
    map_.for_each([&](std::size_t pixel, std::uint32_t k) {
        const Patch& p = map_.patches[k];
        if (!(p.pixel_size > 0.0f))
            return;
        float closeness = 0.0f, met = 0.0f;
        for_neighbours(pixel, p, kReach * p.pixel_size, 1, [&](std::uint32_t j, float w) {
            closeness += w * map_.patches[j].closeness;
            met += w * map_.patches[j].met;
        });
        const float least = p.lobe == 1.0f ? kLeastPixels * p.pixel_size : 0.0f, most = kMostPixels * p.pixel_size;
        radius[k] = closeness > 0.0f ? std::clamp(radius_ * p.lobe * met / closeness, least, most) : most;
    });
    return radius;
}

void SharedBounce::share(const std::vector<float>& radius, int step) {
    HalvedLight out = light_;
    map_.for_each([&](std::size_t pixel, std::uint32_t k) {
        const Patch& p = map_.patches[k];
        // What is nearer than a step has been shared by the step before.
        if (radius[k] <= (step > 1 ? float(step) * p.pixel_size : 0.0f))
            return;
        MeanOfHalves mean(light_);
        for_neighbours(pixel, p, std::min(radius[k], float(kReach * step) * p.pixel_size), step,
                       [&](std::uint32_t j, float w) {
                           // Nor farther than the neighbour shares: beside things its light changes quickly.
                           const vec3 offset = map_.patches[j].position - p.position;
                           const float within = 1.0f - glm::dot(offset, offset) / square(radius[j]);
                           if (j == k || within > 0.0f)
                               mean.add(j, w * (j == k ? 1.0f : square(within)));
                       });
        if (mean.any())
            mean.put(out, k);
    });
    light_ = std::move(out);
}

std::vector<Rgb> SharedBounce::take_pixels() {
    take_means();
    const std::vector<float> radius = radii();
    for (const int step : kSteps)
        share(radius, step);
    square_errors_.assign(kinds(), 0.0);
    if (calms_) {
        take_noise();
        return pixels(0);
    }
    calm_.resize(light_.lights.size());
    for (std::size_t i = 0; i < calm_.size(); ++i)
        calm_[i] = light_.mean(i / kinds(), i % kinds());
    return pixels(0);
}

void SharedBounce::take_noise() {
    CalmLight calm = without_noise(map_, std::move(light_));
    calm_ = std::move(calm.lights);
    for (std::size_t i = 0; i < calm_.size(); ++i) {
        const Rgb& weight = map_.patches[i / kinds()].weight;
        square_errors_[i % kinds()] += double(glm::dot(weight, weight)) / 3.0 * double(calm.square_errors[i]);
    }
}

std::vector<Rgb> SharedBounce::pixels(std::size_t kind) const {
    std::vector<Rgb> out(map_.first.size(), Rgb(0.0f));
    if (kind < kinds())
        map_.for_each([&](std::size_t pixel, std::uint32_t k) {
            out[pixel] += map_.patches[k].weight * calm_[k * kinds() + kind];
        });
    return out;
}

std::size_t SharedBounce::kind_of(Apart which) const {
    return 1 + static_cast<std::size_t>(std::find(told_.begin(), told_.end(), which) - told_.begin());
}

bool SharedBounce::tells(Apart which) const {
    return kind_of(which) < kinds();
}

std::vector<Rgb> SharedBounce::told_pixels(Apart which) const {
    return pixels(kind_of(which));
}

double SharedBounce::square_error(Apart which) const {
    return tells(which) ? square_errors_[kind_of(which)] : 0.0;
}

// The weights of share() are 1 - r^2 twice squared, less what normals and planes take: a fifth of the circle.
float SharedBounce::pixels_within(const Sample& s, float closeness) const {
    constexpr float kOfCircle = 0.2f * std::numbers::pi_v<float>;
    const float most = kMostPixels * s.pixel_size;
    const float radius = closeness > 0.0f ? std::min(radius_ * s.lobe / closeness, most) : most;
    return s.area > 0.0f ? std::max(1.0f, kOfCircle * square(radius) / s.area) : 1.0f;
}

// Where noise is told from light and light is smooth, the variance falls by ten at least besides, until blurs end.
float SharedBounce::pixels_sharing(const Sample& s, float closeness) const {
    constexpr float kOfBands = 10.0f, kMostOfBands = 1000.0f;
    const float shared = pixels_within(s, closeness);
    return calms_ ? std::max(shared, std::min(kOfBands * shared, kMostOfBands)) : shared;
}

}  // namespace brisance
