// Sums the light of hierarchy levels at receivers: maps first, as far as memory allows or receivers ask, then light.
#pragma once

#include <span>
#include <vector>

#include "gathering/far_kernels.h"
#include "gathering/gather.h"

namespace brisance {

// Receivers, and their light.
struct ReceiverSet {
    const Receivers* receivers;
    Gathered* light;  // planar over receivers, to which is added
};

class FarGather {
public:
    // Keeps references. All sets share the maps.
    FarGather(const LightField& field, std::vector<ReceiverSet> sets, float mean_cosine, Progress& progress,
              ReceiverKind kind = ReceiverKind::Medium);

    // Gathers from the levels [first, last) of the field's grid.
    void run_levels(std::size_t first, std::size_t last, std::vector<LevelCost>& costs);
    // From one level. `top`: none is coarser.
    LevelCost run(const GridLevel& level, bool top);

private:
    void gather_batches(const GridLevel& level, FarLights lights, bool maps, std::size_t batch, LevelCost& cost);
    void gather_needed(const GridLevel& level, FarLights lights, std::size_t batch, LevelCost& cost);
    FarLights far_lights(const GridLevel& level, bool top, const ShadowMapLayout& layout, std::size_t first) const;
    bool has_maps(const GridLevel& level) const;
    std::vector<std::uint32_t> needed_lights(const GridLevel& level, const FarLights& lights,
                                             const ShadowMapCache::Level& made) const;
    bool ends_serve(const FarLights& lights) const;
    void use_ends(FarLights& lights, ShadowMapCache::Level& made) const;
    void make_maps(const GridLevel& level, const FarLights& lights, std::span<const std::uint32_t> list,
                   ShadowMapCache::Level& made) const;
    void make_needed_maps(const GridLevel& level, const FarLights& lights, ShadowMapCache::Level& made) const;
    std::uint64_t gather_batch(const GridLevel& level, const FarLights& all, std::size_t count,
                               const ShadowMapCache::Level& made) const;
    std::uint64_t gather_batch(const GridLevel& level, const FarLights& all, std::size_t count,
                               const ShadowMapCache::Level& made, const Receivers& receivers, Gathered& light) const;

    const LightField& field_;
    std::vector<ReceiverSet> sets_;
    float mean_cosine_;
    ReceiverKind kind_;
    Progress& progress_;
    PackedExtinction fine_;
    Box medium_;  // in which smoke may be, local [m]
};

}  // namespace brisance
