#include "medium_lighting/lit_lattice.h"

#include <algorithm>

#include "core/parallel.h"
#include "gathering/escape_probability.h"
#include "lighting_grid/voxel_lights.h"
#include "medium/phase.h"
#include "medium_lighting/levels/light_of_detail.h"
#include "medium_lighting/surface_occluders.h"
#include "scattering/coarse_operator.h"

namespace brisance {

namespace {

// Level of the pyramid that rays out of the smoke march: how much of all light escapes needs no finer one.
constexpr int kEscapeRayLevel = 2;
// And rays from a surface to the parts of a fire. Which part sends how much of what a doorway lets through depends on
// the gaps in the smoke: with voxels four times as wide, a wall behind one was up to a quarter too bright.
constexpr int kPartsRayLevel = 0;
// Levels above the medium's own on which light is gathered first.
constexpr int kLitLevels = 3;

// Settings count levels from the medium's own lattice.
MediumLightingInput with_levels_above(MediumLightingInput input, int level) {
    if (int& levels = input.lighting.levels; levels > 0)
        levels = std::max(1, levels - level);
    if (int& scattering = input.scattering.lattice_level; scattering >= 0)
        scattering = std::max(0, scattering - level);
    return input;
}

std::unique_ptr<Medium> medium_on(const Medium& fine, int level) {
    return level > 0 ? std::make_unique<Medium>(medium_to_light(fine, level)) : nullptr;
}

// Mean radiance over directions.
std::vector<Rgb> mean_radiance(const Gathered& g, std::size_t n) {
    std::vector<Rgb> mean(n);
    for (std::size_t i = 0; i < n; ++i)
        for (int c = 0; c < 3; ++c)
            mean[i][c] = g.fluence[c * n + i] / (4.0f * kPi);
    return mean;
}

// Skies reach all smoke, and so do suns, but for what dense smoke shades. Lamps and shadows of a set may leave haze to
// be lit by dense smoke alone, as fire does.
LitBy lit_by(const MediumLightingInput& input) {
    if (input.fire || !input.emitters_on_medium || !input.surroundings || input.surroundings->has_surfaces())
        return LitBy::Fire;
    const Emitters& emitters = input.surroundings->emitters();
    bool sky = false;
    for (std::size_t part = 0; part < emitters.choices(); ++part) {
        if (!emitters.is_far(part))
            return LitBy::Fire;
        sky = sky || emitters.is_sky(part);
    }
    return sky ? LitBy::Skies : LitBy::Fire;
}

}  // namespace

std::vector<std::uint8_t> nodes_beside_extinction(const Medium& medium) {
    constexpr int kWide = BrickLattice::kSize + 2;
    std::vector<std::uint8_t> needed(medium.lattice.node_count(), 0);
    parallel_for(medium.lattice.brick_count(), [&](std::size_t b) {
        std::vector<float> box(kWide * kWide * kWide);
        copy_box(medium.lattice, medium.extinction, 1, medium.lattice.first_node(b) - 1, ivec3(kWide), box);
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const ivec3 p = BrickLattice::node_in_brick(n);
            bool any = false;
            for (int k = 0; k < 27 && !any; ++k)
                any = box[((p.x + k / 9) * kWide + p.y + k / 3 % 3) * kWide + p.z + k % 3] > 0.0f;
            needed[b * BrickLattice::kNodes + n] = any;
        }
    });
    return needed;
}

LitLattice::LitLattice(const MediumLightingInput& input, int level)
    : input_(with_levels_above(input, level)),
      level_(level),
      coarse_(medium_on(input.medium, level)),
      pyramid_(medium(), ExtinctionPyramid::kMaxLevels),
      needed_(nodes_beside_extinction(medium())),
      depths_(pyramid_, kEscapeRayLevel),
      depths_of_parts_(pyramid_, kPartsRayLevel) {
    if (input.surroundings && input.surroundings->has_surfaces()) {
        surfaces_ = std::make_unique<SurfaceOccluders>(input.surroundings->intersector(), input.medium.spacing);
        if (surfaces_reach_into(input.surroundings, medium()))
            pyramid_.set_occluders(surfaces_.get());
    }
    if (input.single || input.multiple)
        thin_medium_ = ThinMedium(medium(), depths_, needed_, {input.eye, input.directional}, input.lighting.error,
                                  pyramid_.occluders(), lit_by(input));
    if (!thin_medium_.empty())
        pyramid_.set_homogeneous_bricks(&thin_medium_.homogeneous_bricks());
    interpolation_ = tolerated_interpolation(medium(), input.lighting);
}

const std::vector<LitLevel>& LitLattice::coarser_levels() const {
    if (coarser_levels_.empty())
        coarser_levels_ =
            make_lit_levels(pyramid_, needed_, thin_medium_.rest(), {input_.eye, input_.pixel_angle}, kLitLevels);
    return coarser_levels_;
}

LatticeRequest LitLattice::request() const {
    const bool moments = input_.multiple && input_.directional;
    const std::optional<vec3> eye = input_.directional ? std::optional<vec3>(input_.eye) : std::nullopt;
    LatticeRequest request{&needed_, eye, moments, medium().mean_cosine};
    request.own_share = own_share_of(input_.lighting, medium().mean_cosine);
    return request;
}

LatticeRequest LitLattice::last_request() const {
    LatticeRequest request = this->request();
    request.moments = false;
    return request;
}

Gathered LitLattice::dark() const {
    Gathered none;
    none.resize(needed_.size(), input_.directional, input_.multiple && input_.directional);
    return none;
}

std::vector<Rgb> LitLattice::fire_lights() const {
    if (level_ == 0)
        return voxel_lights(input_.medium);
    ScatteredLight coarse = restricted({voxel_lights_unsharpened(input_.medium), {}}, input_.medium.lattice, level_);
    coarse.sharpen(medium().lattice);
    return std::move(coarse.intensity);
}

NodeWeights LitLattice::escape_likelihood_of(const std::vector<Rgb>& intensity) const {
    return escape_likelihood(medium(), depths_, intensity, &likelihood_);
}

const Medium& LitLattice::finer() const {
    if (level_ > 1 && !finer_)
        finer_ = medium_on(input_.medium, level_ - 1);
    return finer_ ? *finer_ : input_.medium;
}

const CornersSeen* LitLattice::corners_seen(const Medium& to, int level) const {
    if (!pyramid_.occluders())
        return nullptr;
    return &corners_seen_.try_emplace({&to, level}, to, level, *pyramid_.occluders()).first->second;
}

std::vector<Rgb> LitLattice::at_medium_nodes(const std::vector<Rgb>& radiance, const Gathered& gathered,
                                             LightOrigin origin) const {
    const BrickLattice& nodes = medium().lattice;
    if (origin == LightOrigin::Smoke)
        return light_at_fine_nodes(nodes, radiance, level_, input_.medium.lattice, corners_seen(input_.medium, level_));
    const Medium& finer = this->finer();
    const bool toward_eye = !gathered.scattered.empty();
    const CornersSeen* const seen = corners_seen(finer, 1);
    std::vector<Rgb> light = light_at_fine_nodes(nodes, radiance, 1, finer.lattice, seen);
    std::vector<Rgb> mean;  // empty: that of `light`
    if (toward_eye)
        mean = light_at_fine_nodes(nodes, mean_radiance(gathered, needed_.size()), 1, finer.lattice, seen);
    const LightBeforeDetail before{medium(), toward_eye ? mean : light, origin == LightOrigin::Fire,
                                   toward_eye ? std::optional<vec3>(input_.eye) : std::nullopt};
    add_light_of_detail(finer, before, nodes_beside_extinction(finer), light);
    return finer_ ? light_at_fine_nodes(finer.lattice, light, level_ - 1, input_.medium.lattice,
                                        corners_seen(input_.medium, level_ - 1))
                  : light;
}

std::vector<Rgb> LitLattice::source_function(const Gathered& g, LightOrigin origin) const {
    const std::size_t n = needed_.size();
    std::vector<Rgb> radiance(n, Rgb(0.0f));
    parallel_for(
        n,
        [&](std::size_t i) {
            if (!needed_[i])
                return;
            for (int c = 0; c < 3; ++c)
                radiance[i][c] = g.scattered.empty() ? g.fluence[c * n + i] / (4.0f * kPi) : g.scattered[c * n + i];
        },
        4096);
    if (level_ > 0)
        radiance = at_medium_nodes(radiance, g, origin);
    parallel_for(
        radiance.size(), [&](std::size_t i) { radiance[i] *= input_.medium.albedo_at(i); }, 4096);
    return radiance;
}

}  // namespace brisance
