#include "thin_media/thin_medium.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "gathering/escape_probability.h"
#include "medium/voxel_size.h"
#include "thin_media/brick_points.h"
#include "thin_media/seen_share.h"
#include "thin_media/unresolved_lights.h"

namespace brisance {

namespace {

// Mean transmittance to the outside: hollows in the smoke have less, and are not thin media.
constexpr float kHollow = 0.02f, kOpen = 0.1f;
// Distance from the camera, in bricks, below which the direction to it turns too fast to be interpolated.
constexpr float kAroundCamera = 4.0f;

// Largest optical depth across a brick of which light does not change much from one side to the other, as long as what
// lights it is not beside it.
constexpr float kThinAcross = 0.2f;

using LightPoints = BrickPoints<2>;
using OpenPoints = BrickPoints<1>;
static_assert(LightPoints::kCount <= 2 * Receivers::kGroup);

// The part of diffuse light that a half-space of smoke sends back, of albedo a and mean cosine g (H. C. van de Hulst,
// Multiple Light Scattering, 1980).
float reflected_by_smoke(float a, float g) {
    const float s = std::sqrt(std::max(0.0f, (1.0f - a) / (1.0f - g * a)));
    return (1.0f - s) * (1.0f - 0.139f * s) / (1.0f + 1.17f * s);
}

// The part of the light in haze that comes from smoke, at most, where suns and skies light all. They light haze as they
// light the dense smoke beside it. That fills half of the view from the haze, and sends a part of the light back.
float share_of_smoke_in_haze(const Medium& medium) {
    double scattering = 0.0, extinction = 0.0;
    for (std::size_t i = 0; i < medium.extinction.size(); ++i) {
        scattering += double(medium.extinction[i]) * double(luminance(medium.albedo_at(i)));
        extinction += medium.extinction[i];
    }
    const float albedo = extinction > 0.0 ? float(scattering / extinction) : 0.0f;
    const float from_smoke = 0.5f * reflected_by_smoke(albedo, medium.mean_cosine);
    return from_smoke / (1.0f + from_smoke);
}

// Per node: how far it needs lights for receivers outside; empty: nowhere.
std::vector<float> thinness(const Medium& medium, const PointDepths& depths, const std::vector<std::uint8_t>& needed,
                            const vec3& eye, float error, LitBy lit_by) {
    UnresolvedLights lights = unresolved_lights(medium);
    for (std::size_t i = 0; i < needed.size(); ++i)
        if (!needed[i])
            lights.weight[i] = lights.lost[i] = 0.0f;
    float lost = seen_share(medium, depths, lights.lost, eye);
    if (lost > 0.0f && lit_by == LitBy::Skies)
        lost *= share_of_smoke_in_haze(medium);
    const float counts = glm::smoothstep(0.5f * error, error, lost);
    if (counts == 0.0f)
        return {};
    for (float& weight : lights.weight)
        weight *= counts;
    return std::move(lights.weight);
}

bool glows(const Medium& medium, std::size_t node) {
    return (!medium.emission.empty() && medium.emission[node] != Rgb(0.0f)) ||
           (!medium.source.empty() && medium.source[node] != Rgb(0.0f) && medium.extinction[node] > 0.0f);
}

struct ThinBricks {
    std::vector<std::uint8_t> wholly, in_part;  // per brick; `in_part`: whether light there is to be replaced
};

ThinBricks thin_bricks(const Medium& medium, const std::vector<float>& thin) {
    const float fullest = *std::max_element(thin.begin(), thin.end());
    const float most = kThinAcross / (BrickLattice::kSize * longest_edge(medium));
    const std::size_t count = medium.lattice.brick_count();
    ThinBricks out{std::vector<std::uint8_t>(count), std::vector<std::uint8_t>(count)};
    parallel_for(
        count,
        [&](std::size_t b) {
            const std::size_t first = b * BrickLattice::kNodes;
            out.wholly[b] = true;
            for (std::size_t i = first; i < first + BrickLattice::kNodes; ++i) {
                out.wholly[b] &= thin[i] == fullest || medium.extinction[i] <= most;
                out.wholly[b] &= !glows(medium, i);
                out.in_part[b] |= thin[i] > 0.0f;
            }
        },
        64);
    return out;
}

}  // namespace

ThinMedium::ThinMedium(const Medium& medium, const PointDepths& depths, const std::vector<std::uint8_t>& needed,
                       const Viewer& viewer, float error, const Occluders* surfaces, LitBy lit_by)
    : viewer_(viewer) {
    const std::vector<float> thin = thinness(medium, depths, needed, viewer.eye, error, lit_by);
    if (thin.empty())
        return;
    find_even_bricks(medium, thin, surfaces);
    look_outside(medium, depths, thin);
    weight_.resize(thin.size());
    nodes_.resize(thin.size());
    for (std::size_t i = 0; i < thin.size(); ++i) {
        weight_[i] = thin[i] * glm::smoothstep(kHollow, kOpen, open_[i]);
        nodes_[i] = weight_[i] > 0.0f;
    }
    single_ = nodes_;
    for (std::size_t k = 0; k < even_.size(); ++k)
        for (int n = 0; n < BrickLattice::kNodes; ++n)
            if (even_smoke_[k].contains(BrickLattice::node_in_brick(n)))
                single_[std::size_t(even_[k]) * BrickLattice::kNodes + n] = 0;
}

// Finds the bricks that contain no dense smoke and have none around them.
void ThinMedium::find_even_bricks(const Medium& medium, const std::vector<float>& thin, const Occluders* surfaces) {
    const BrickLattice& lattice = medium.lattice;
    const auto [wholly, in_part] = thin_bricks(medium, thin);
    homogeneous_bricks_ = HomogeneousBricks(lattice, medium.reference_node, wholly);
    const float edge = BrickLattice::kSize * medium.spacing;
    std::vector<std::optional<BrickPart>> smoke(lattice.brick_count());  // of even bricks
    parallel_for(
        smoke.size(),
        [&, &in_part = in_part](std::size_t b) {
            const vec3 middle = medium.local_of_node(lattice.first_node(b) + BrickLattice::kSize / 2);
            const bool slow = !viewer_.directional || glm::distance(viewer_.eye, middle) > kAroundCamera * edge;
            if (!in_part[b] || !slow || !homogeneous_bricks_.at(lattice.brick(b) - (medium.reference_node >> 3)))
                return;
            // Points beyond a wall would bring its other side's light to the smoke before it.
            const bool beside =
                surfaces && surfaces->any_within(middle, 0.5f * BrickLattice::kSize * longest_diagonal(medium));
            smoke[b] = beside ? unparted_smoke(*surfaces, medium, b) : BrickPart{};
        },
        16);
    for (std::uint32_t b = 0; b < smoke.size(); ++b)
        if (smoke[b]) {
            even_.push_back(b);
            even_smoke_.push_back(*smoke[b]);
        }
}

void ThinMedium::look_outside(const Medium& medium, const PointDepths& depths, const std::vector<float>& thin) {
    open_.assign(thin.size(), -1.0f);
    std::vector<std::uint8_t> even(medium.lattice.brick_count(), 0);
    for (const std::uint32_t b : even_)
        even[b] = 1;
    parallel_for(
        even.size(),
        [&](std::size_t b) {
            const ivec3 first = medium.lattice.first_node(b);
            const std::size_t base = b * BrickLattice::kNodes;
            float corners[OpenPoints::kCount];
            for (int p = 0; even[b] && p < OpenPoints::kCount; ++p)
                corners[p] =
                    mean_transmittance_outside(medium, depths, medium.local_of_node(first + OpenPoints::node(p)));
            for (int n = 0; n < BrickLattice::kNodes; ++n)
                if (thin[base + n] > 0.0f)
                    open_[base + n] =
                        even[b] ? OpenPoints::at(corners, n)
                                : mean_transmittance_outside(
                                      medium, depths, medium.local_of_node(first + BrickLattice::node_in_brick(n)));
        },
        4);
}

std::vector<float> ThinMedium::rest() const {
    std::vector<float> rest(weight_.size());
    std::transform(weight_.begin(), weight_.end(), rest.begin(), [](float w) { return 1.0f - w; });
    return rest;
}

std::size_t ThinMedium::node_count() const {
    return static_cast<std::size_t>(std::count(nodes_.begin(), nodes_.end(), std::uint8_t{1}));
}

std::size_t ThinMedium::point_count() const {
    return even_.size() * LightPoints::kCount +
           static_cast<std::size_t>(std::count(single_.begin(), single_.end(), std::uint8_t{1}));
}

Gathered ThinMedium::gather(const LightField& field, const GridLevel& bottom, const LightField* of_thin,
                            const LatticeRequest& request, std::vector<LevelCost>& costs, Progress& progress) const {
    const Medium& medium = field.pyramid->medium();
    LatticeRequest single = request;
    single.needed = &single_;
    Gathered out = gather_at_nodes(field, single, costs, progress);
    if (of_thin)
        out.add(gather_at_nodes(*of_thin, single, costs, progress));
    Receivers receivers;
    for (std::size_t k = 0; k < even_.size(); ++k) {
        std::vector<vec3> points, directions;
        for (int p = 0; p < LightPoints::kCount; ++p) {
            const ivec3 node = glm::clamp(LightPoints::node(p), even_smoke_[k].low, even_smoke_[k].high);
            points.push_back(medium.local_of_node(medium.lattice.first_node(even_[k]) + node));
            if (request.eye)
                directions.push_back(direction_toward(*request.eye, points.back()));
        }
        receivers.add_block(points, directions);
    }
    Gathered few = gather_at_points(field, bottom, receivers, request.mean_cosine, costs, progress,
                                    ReceiverKind::Medium, request.moments);
    if (of_thin)
        few.add(gather_at_points(*of_thin, {}, receivers, request.mean_cosine, costs, progress, ReceiverKind::Medium,
                                 request.moments));
    const std::size_t nodes = nodes_.size(), receiver_count = receivers.size();
    const auto spread = [&](const std::vector<float>& from, std::vector<float>& to) {
        parallel_for(even_.size(), [&](std::size_t k) {
            const std::size_t first_point = receivers.blocks()[k].first_group * Receivers::kGroup;
            const std::size_t first = std::size_t(even_[k]) * BrickLattice::kNodes;
            for (std::size_t plane = 0; plane * nodes < to.size(); ++plane)
                for (int n = 0; n < BrickLattice::kNodes; ++n)
                    if (even_smoke_[k].contains(BrickLattice::node_in_brick(n)))
                        to[plane * nodes + first + n] = LightPoints::at(&from[plane * receiver_count + first_point], n);
        });
    };
    spread(few.fluence, out.fluence);
    spread(few.scattered, out.scattered);
    spread(few.moments, out.moments);
    return out;
}

void ThinMedium::mix(const Gathered& of_thin, Gathered& all) const {
    const std::size_t n = weight_.size();
    const auto mix_planes = [&](const std::vector<float>& from, std::vector<float>& to) {
        parallel_for(to.size() / n, [&](std::size_t plane) {
            for (std::size_t i = 0, k = plane * n; i < n; ++i, ++k)
                to[k] += weight_[i] * (from[k] - to[k]);
        });
    };
    mix_planes(of_thin.fluence, all.fluence);
    mix_planes(of_thin.scattered, all.scattered);
    mix_planes(of_thin.moments, all.moments);
}

}  // namespace brisance
