// Light of fire and smoke that the Lambert base of surfaces scatters toward the camera (SV and SM).
//
// The lighting grids sum all lights at receivers that samples share, without occlusion by surfaces. What part of it
// arrives is measured by shadow rays toward points of the medium (visibility_ratio.h). The samples of a receiver first
// test one set of such points together (shared_targets.h), a ray for each sample. Where every ray arrives, or none
// does, and it is so for its neighbours in the row of pixels, that is the answer. Elsewhere may be a penumbra: every
// receiver takes points from a pool of its neighbourhood, in batches of sixteen: one for each of its samples, or fewer
// where the batches agree on the part that arrives.
//
// What is missed: with n rays around, a part f of the light that is hidden, or seen, goes unnoticed with probability
// (1 - f)^n, so that the mean is wrong by at most 1 / (e n). n is 144 for pixels of 16 samples.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "base_lighting/panes.h"
#include "base_lighting/shared_receivers.h"
#include "base_lighting/shared_targets.h"
#include "medium_lighting/medium_lighting.h"

namespace brisance {

// A point of a surface that a sample sees.
struct BasePoint {
    const SurfacePoint* surface;  // null: none
    dvec3 toward_viewer;          // unit
    std::uint32_t pixel;
    std::uint64_t number;  // of the sample in its pixel
};

// Scattered toward the viewer [W/(m^2 sr)].
struct BaseLight {
    Rgb from_fire{0.0f}, from_smoke{0.0f};
    Rgb through_panes{0.0f};  // of both
};

class BaseLighting {
public:
    // Keeps references. `through_panes`: light that passes panes is wanted. `width`: of the picture, in pixels.
    // `tolerance`: standard error, over itself, of the light of a receiver in a penumbra, of which it tests no more.
    // Other seeds draw other points.
    BaseLighting(const Medium& medium, const MediumLighting& lighting, const Panes& panes, bool through_panes,
                 int width, float tolerance, std::uint32_t seed = 0);

    // One for each point, in the order in which they were added to the receivers, which are lit. Independent of other
    // rows of the picture.
    std::vector<BaseLight> light(std::span<const BasePoint> points, const SharedReceivers& receivers) const;
    // The same where penumbrae are known to be: no samples test together.
    std::vector<BaseLight> light_penumbrae(std::span<const BasePoint> points, const SharedReceivers& receivers) const {
        return light_alone(points, receivers, points.size());
    }
    // The same by one batch of rays for each receiver and light: enough where a pixel shows many points by chance, as
    // reflected ones are. Whether a part is hidden or not costs the same then, and is not asked before.
    std::vector<BaseLight> light_by_few_rays(std::span<const BasePoint> points,
                                             const SharedReceivers& receivers) const {
        return light_alone(points, receivers, 1);
    }

private:
    // Fire and smoke, of dense smoke and of thin media.
    static constexpr int kLights = 4;
    enum class Seen : std::uint8_t { NoLight, All, Nothing, Part };
    struct SamplesOfReceivers;
    struct Together;
    struct Shares {
        Rgb clear{0.0f}, through_panes{0.0f};  // of a white Lambert surface's reflected light
    };

    class Fronts;
    class Pools;
    class Base;
    using Bases = std::deque<Base>;  // of a receiver's samples
    Together light_together(const SurfaceReceiver& receiver, Fronts& around, std::span<const std::uint32_t> samples,
                            std::span<const BasePoint> points, std::span<BaseLight> out) const;
    bool settled(std::span<const Together> all, std::size_t receiver) const;
    Seen see_together(int light, const SurfaceReceiver& receiver, const WeightedTargets& targets, const Bases& bases,
                      Rng& rng, std::span<BaseLight> out) const;
    // Receivers that look by themselves, each by at most so many batches of rays; then those of one neighbourhood.
    std::vector<BaseLight> light_alone(std::span<const BasePoint> points, const SharedReceivers& receivers,
                                       std::size_t most_batches) const;
    void light_alone(std::span<const std::uint32_t> which, std::size_t most_batches, const SharedReceivers& receivers,
                     const SamplesOfReceivers& samples, std::span<const BasePoint> points,
                     std::span<BaseLight> out) const;
    void light_alone(const SurfaceReceiver& receiver, Pools& around, std::size_t most_batches,
                     std::span<const std::uint32_t> samples, std::span<const BasePoint> points,
                     std::span<BaseLight> out) const;
    void measure(int light, const SurfaceReceiver& receiver, TargetPool& pool, std::size_t most_batches,
                 const Bases& bases, Rng& rng, std::span<BaseLight> out) const;
    Panes::Passage passage(const SurfacePoint& surface, const vec3& light) const;

    const Medium& medium_;
    const Panes& panes_;
    bool through_panes_;
    std::uint32_t width_;
    float tolerance_;
    std::uint64_t seed_;  // above the bits of a pixel's number
    std::array<const VisibilityRatio*, kLights> ratios_;
};

}  // namespace brisance
