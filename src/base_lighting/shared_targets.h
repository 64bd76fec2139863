// Points of the medium toward which neighbouring receivers test together whether surfaces hide it.
//
// To sample such points, in proportion to the light that each sends (visibility_ratio.h), costs more than the shadow
// rays toward them. Where they are asked only whether anything is hidden, receivers that lie close together on one side
// of a surface share them: the light that they see comes from the same places.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "base_lighting/shared_receivers.h"
#include "medium/lattice/local_bounds.h"
#include "medium_lighting/exterior/visibility_ratio.h"

namespace brisance {

constexpr std::size_t kTargetsDrawn = 2 * VisibilityRatio::kDraws;

// Numbers 0, 1, ... in proportion to their weights.
class WeightedNumbers {
public:
    void add(float weight) { passed_.push_back(sum_ += weight); }
    float sum() const { return sum_; }
    std::size_t at(float u) const;  // u in [0, 1); the sum is above zero

private:
    std::vector<float> passed_;  // running sum
    float sum_ = 0.0f;
};

// Points drawn for a place, to be chosen in proportion to the light from them.
class WeightedTargets {
public:
    void add(std::span<const VisibilityRatio::Draw> draws);
    bool empty() const { return points_.empty(); }
    const vec3& at(float u) const { return points_[numbers_.at(u)]; }  // u in [0, 1); not empty

private:
    std::vector<vec3> points_;
    WeightedNumbers numbers_;
};

// Points drawn for a place in batches, of which receivers around take some each, in an order of their own.
//
// The part of the light that arrives, f, has the least variance where half of the points are drawn, in proportion to
// the light from each, from those that are hidden, and half from the others: the variance of a ratio of sums of w V and
// w is the integral of w^2 (V - f)^2 over the density, least where that is in proportion to w |V - f|. A batch is
// therefore resampled from more candidates, of which the place itself knows the transmittance and whether surfaces hide
// them (J. Talbot, D. Cline and P. Egbert, Importance Resampling for Global Illumination, EGSR 2005). Where others see
// what the place does not, their points count at most about twice as much as without. As candidates cost what points
// cost, there are more of them only where several receivers take a batch.
//
// All batches together are stratified, and so are the candidates of each. What receivers of one pool err in common
// falls with the number of all candidates.
class TargetPool {
public:
    using Reaches = std::function<bool(const vec3& point)>;
    // For `receivers` that draw so many batches in all, and at most `most` each. Keeps a reference to the ratio. There
    // must be voxels that glow. `reaches`: whether no surface is between a point and the place. `seed`: of its numbers.
    TargetPool(const VisibilityRatio& ratio, const SurfaceReceiver& first, Reaches reaches, std::size_t batches,
               std::size_t most, std::pair<std::uint64_t, std::uint64_t> seed);

    // The batch with this number in the order that begins at `start`, in [0, 1). It is drawn when it is first asked
    // for.
    const VisibilityRatio::Targets& batch(float start, std::size_t number);

private:
    VisibilityRatio::Targets draw(std::size_t at) const;

    const VisibilityRatio& ratio_;
    LitPoint first_;
    Reaches reaches_;
    std::pair<std::uint64_t, std::uint64_t> seed_;
    std::vector<std::optional<VisibilityRatio::Targets>> batches_;  // a power of two
    std::size_t candidates_;                                        // of a batch, in batches
    LightFront around_;
};

// Receivers in a few pixels of one row of the picture, close together and facing alike.
class Neighbourhoods {
public:
    // `pixel_of`: of each receiver, ascending. `width`: of the picture, in pixels. Neighbourhoods end at multiples of
    // kPixels in the row, so that a row's do not depend on where the receivers begin.
    Neighbourhoods(const Medium& medium, const SharedReceivers& receivers, std::span<const std::uint32_t> pixel_of,
                   std::uint32_t width);

    static constexpr std::uint32_t kPixels = 32;
    std::size_t count() const { return first_.size() - 1; }
    // Ascending; at least one.
    std::span<const std::uint32_t> receivers_of(std::size_t neighbourhood) const {
        return std::span(receivers_).subspan(first_[neighbourhood], first_[neighbourhood + 1] - first_[neighbourhood]);
    }

private:
    std::vector<std::uint32_t> first_, receivers_;  // `first_` has one more than there are, as an end
};

// Draws so many points for a receiver. Empty where nothing can be sampled.
WeightedTargets draw_targets(const VisibilityRatio& ratio, const LightFront& around, const SurfaceReceiver& receiver,
                             Rng& rng);

}  // namespace brisance
