#include "medium_lighting/stages/emitter_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "medium/lattice/local_bounds.h"
#include "medium/phase.h"
#include "medium/sh.h"
#include "medium_lighting/stages/lamp_in_voxel.h"
#include "medium_lighting/surface_occluders.h"
#include "optical_depths/cone_depths.h"

namespace brisance {

namespace {

// Points on the emitters for a node. Surfaces give all light edges: each light at infinity, and all lamps together,
// take an equal part of kPoints. Without surfaces lamps alone need as many, since the next ones shine unevenly.
constexpr double kPoints = 24.0, kOnUnhiddenFar = 8.0;
// Nodes take most where the camera sees them, and this share of it where smoke hides them. A node's variance counts by
// the square of the transmittance T to the camera, so that for the least error at equal cost their number is in
// proportion to T.
constexpr float kLeastShare = 0.25f, kSharePerTransmittance = 1.5f;
// Width of the cones in which smoke before the camera is looked at for this: it decides about noise alone.
constexpr float kSeenCone = 0.05f;
// Width of the cone in which smoke is averaged, over that of the solid angle that a sample stands for. With 0.5 smoke
// under a sky is 0.8 % too dark, with 0.2 by less than its noise; the time hardly differs.
constexpr float kConeShare = 0.1f;

// A line from a node to an emitter that it sees past all surfaces.
struct NodeRay {
    std::size_t node;
    ConeDepths::Segment segment;
    vec3 direction;  // of travel, unit
    Rgb light;       // irradiance perpendicular to it, before any smoke [W/m^2]
    float widening;  // of the cone that it stands for
};

// The radical inverse in a prime base. Of Halton's sequence, which has one for each dimension, the first n points are
// spread evenly for every n.
double radical_inverse(int base, int k) {
    double sum = 0.0, digit = 1.0 / base;
    for (; k > 0; k /= base, digit /= base)
        sum += k % base * digit;
    return sum;
}

double turned(double x, double by) {
    return x + by - std::floor(x + by);
}

class NodeSampler {
public:
    NodeSampler(const Surroundings& surroundings, const Medium& medium)
        : surroundings_(surroundings),
          medium_(medium),
          // Larger than any distance within the medium.
          beyond_(2.0f * local_bounds(medium).diagonal()) {
        const Emitters& emitters = surroundings.emitters();
        for (std::size_t part = 0; part < emitters.choices(); ++part)
            parts_.push_back({points_on(emitters, part), cones_across(emitters.width_of_choice(part), medium.spacing)});
    }

    // Appends the rays of a node at `p`. A light without extent has one ray, however often it was sampled. `share`: of
    // the most points, in (0, 1]. Their number need not be whole: the last of a part counts for what is left, so that
    // light is continuous in it.
    void sample(std::size_t node, const vec3& p, float share, std::vector<NodeRay>& rays) const {
        for (std::size_t part = 0; part < parts_.size(); ++part)
            sample_part(part, node, p, share, rays);
    }

private:
    // Each light at infinity, and all others together.
    struct Part {
        double points;  // on it, at most
        double cones;   // in which smoke before it differs
    };

    double points_on(const Emitters& emitters, std::size_t part) const {
        if (surroundings_.has_surfaces())
            return kPoints / double(emitters.choices());
        return emitters.is_far(part) ? kOnUnhiddenFar : kPoints;
    }

    // How many cones of a voxel's width a light fills, seen from the middle of the medium. Within less smoke is the
    // same.
    double cones_across(double width, float spacing) const {
        const double voxels = width * 0.25 * double(beyond_) / double(spacing);
        return std::max(1.0, voxels * voxels);
    }

    void sample_part(std::size_t part, std::size_t node, const vec3& p, float share, std::vector<NodeRay>& rays) const {
        const auto [most, cones] = parts_[part];
        const double all = double(parts_.size());
        const auto counted_cones = std::size_t(std::ceil(std::min(cones, kPoints)));
        const bool far = surroundings_.emitters().is_far(part);
        // Surfaces may hide a part of a light before which smoke is the same.
        const double points = std::max(1.0, share * (surroundings_.has_surfaces() ? most : std::min(most, cones)));
        Rng rng(Stream::NodeEmitter, node, part);
        const double by[3] = {rng.next_double(), rng.next_double(), rng.next_double()};
        const LitPoint point{dvec3(p), dvec3(0.0), LitPoint::Kind::Medium};
        const std::size_t first = rays.size();
        std::array<std::size_t, std::size_t(kPoints)> ray_of_cone{};  // plus 1; 0: none
        for (int k = 0; k < points; ++k) {
            const double choice = (double(part) + turned(radical_inverse(2, k), by[0])) / all;
            // Suns and skies know two dimensions, lamps a third: which of them.
            const glm::dvec2 on{turned(radical_inverse(far ? 2 : 3, k), by[1]),
                                turned(radical_inverse(far ? 3 : 5, k), by[2])};
            const auto found = surroundings_.emitters().sample(point, choice, on);
            if (!found)
                continue;
            const NodeRay ray = ray_to(*found, node, p, std::min(1.0, points - k) / (points * all));
            const bool has_extent = ray.widening > 0.0f;  // else it is tested once, below
            if (has_extent && is_hidden(ray))
                continue;
            std::size_t& of_cone = ray_of_cone[std::size_t(k) % counted_cones];
            if (has_extent && cones < points && of_cone > 0) {
                rays[of_cone - 1].light += ray.light;
                continue;
            }
            add(ray, first, rays);
            of_cone = rays.size();
        }
        const auto hidden = [&](const NodeRay& ray) { return ray.widening == 0.0f && is_hidden(ray); };
        rays.erase(std::remove_if(rays.begin() + static_cast<std::ptrdiff_t>(first), rays.end(), hidden), rays.end());
        average_near_lamps(first, rays);
    }

    // Beside a lamp a node has the light of its voxel. What has no direction comes from the six directions of the axes:
    // their means up to degree 3 are those of all.
    void average_near_lamps(std::size_t first, std::vector<NodeRay>& rays) const {
        for (std::size_t i = first, count = rays.size(); i < count; ++i) {
            const vec3 from_lamp = rays[i].segment.from - rays[i].segment.to;
            if (rays[i].widening > 0.0f || glm::length(from_lamp) > kBesideLamp * medium_.spacing)
                continue;
            const LampInVoxel lamp = lamp_in_voxel(medium_.local_from_index, from_lamp);
            const double depth = lamp.farther * double(medium_.extinction[rays[i].node]);
            const Rgb light = rays[i].light * float(lamp.fluence * transmittance_within(depth));
            const float along = float(glm::length(lamp.along));
            NodeRay around = rays[i];
            rays[i].light = along * light;
            if (along > 0.0f)
                rays[i].direction = lamp.along / along;
            around.light = (1.0f - along) / 6.0f * light;
            for (int axis = 0; axis < 3; ++axis)
                for (const float way : {-1.0f, 1.0f}) {
                    around.direction = vec3(0.0f);
                    around.direction[axis] = way;
                    rays.push_back(around);
                }
        }
    }

    static void add(const NodeRay& ray, std::size_t first, std::vector<NodeRay>& rays) {
        NodeRay* const same = ray.widening == 0.0f ? same_delta(rays, first, ray) : nullptr;
        if (same)
            same->light += ray.light;
        else
            rays.push_back(ray);
    }

    // `share`: of the sample among the node's.
    NodeRay ray_to(const EmitterSample& found, std::size_t node, const vec3& p, double share) const {
        const dvec3 end = std::isfinite(found.distance) ? found.end : dvec3(p) + double(beyond_) * found.direction;
        const double solid_angle = found.pdf > 0.0 ? share / found.pdf : 0.0;
        const double width = 2.0 * std::sqrt(solid_angle / std::numbers::pi);
        return {node,
                {p, vec3(end)},
                -vec3(found.direction),
                found.weight * float(share),
                kConeShare * static_cast<float>(std::min(width, 2.0))};
    }

    static NodeRay* same_delta(std::vector<NodeRay>& rays, std::size_t first, const NodeRay& ray) {
        for (std::size_t i = first; i < rays.size(); ++i)
            if (rays[i].widening == 0.0f && rays[i].segment.to == ray.segment.to)
                return &rays[i];
        return nullptr;
    }

    bool is_hidden(const NodeRay& ray) const {
        const dvec3 from(ray.segment.from), toward = dvec3(ray.segment.to) - from;
        const double distance = glm::length(toward);
        return !(distance > 0.0) || (surroundings_.has_surfaces() &&
                                     surroundings_.intersector().occluded({from, toward / distance}, distance));
    }

    const Surroundings& surroundings_;
    const Medium& medium_;
    float beyond_;
    std::vector<Part> parts_;
};

// Adds the light of single rays to the planes of nodes.
class NodeSum {
public:
    NodeSum(const Medium& medium, const LatticeRequest& request, Gathered& out)
        : request_(request), out_(out), nodes_(medium.lattice.node_count()) {}

    void add(const NodeRay& ray, float transmittance) {
        const Rgb light = transmittance * ray.light;
        const float phase =
            request_.eye ? henyey_greenstein(glm::dot(ray.direction, direction_toward(*request_.eye, ray.segment.from)),
                                             request_.mean_cosine)
                         : 0.0f;
        const auto basis = sh_basis(ray.direction);
        for (int c = 0; c < 3; ++c) {
            out_.fluence[c * nodes_ + ray.node] += light[c];
            if (request_.eye)
                out_.scattered[c * nodes_ + ray.node] += phase * light[c];
            for (int m = 0; request_.moments && m < kShMoments; ++m)
                out_.moments[(3 * m + c) * nodes_ + ray.node] += light[c] * basis[m];
        }
    }

private:
    const LatticeRequest& request_;
    Gathered& out_;
    std::size_t nodes_;
};

// Cones of like width are computed together.
void add_rays(const ConeDepths& depths, std::vector<NodeRay>& rays, NodeSum& sum) {
    std::stable_sort(rays.begin(), rays.end(),
                     [](const NodeRay& a, const NodeRay& b) { return a.widening < b.widening; });
    std::array<ConeDepths::Segment, ConeDepths::kCones> segments;
    std::array<float, ConeDepths::kCones> depth;
    for (std::size_t i = 0; i < rays.size(); i += ConeDepths::kCones) {
        const int count = static_cast<int>(std::min(rays.size() - i, std::size_t{ConeDepths::kCones}));
        for (int k = 0; k < count; ++k)
            segments[k] = rays[i + k].segment;
        depths.along(segments, count, rays[i].widening, depth);
        for (int k = 0; k < count; ++k)
            sum.add(rays[i + k], std::exp(-depth[k]));
    }
}

// The share of the most samples that nodes of one brick take; 0 where no light is needed. `most`: where nothing hides
// them.
std::array<float, BrickLattice::kNodes> shares_of_brick(const ConeDepths& depths, const Medium& medium,
                                                        const LatticeRequest& request, std::size_t brick,
                                                        const vec3& eye, float most) {
    std::array<float, BrickLattice::kNodes> shares{};
    std::array<ConeDepths::Segment, ConeDepths::kCones> segments;
    std::array<float, ConeDepths::kCones> depth;
    for (int first = 0; first < BrickLattice::kNodes; first += ConeDepths::kCones) {
        const auto* needed = &(*request.needed)[brick * BrickLattice::kNodes + first];
        if (std::none_of(needed, needed + ConeDepths::kCones, [](std::uint8_t n) { return n != 0; }))
            continue;
        for (int k = 0; k < ConeDepths::kCones; ++k)
            segments[k] = {medium.local_of_node(medium.lattice.node(brick * BrickLattice::kNodes + first + k)), eye};
        depths.along(segments, ConeDepths::kCones, kSeenCone, depth);
        for (int k = 0; k < ConeDepths::kCones; ++k)
            if (needed[k])
                shares[first + k] =
                    std::max(kLeastShare, most * std::min(1.0f, kSharePerTransmittance * std::exp(-depth[k])));
    }
    return shares;
}

}  // namespace

Gathered gather_from_emitters(const Surroundings& surroundings, const ExtinctionPyramid& pyramid,
                              const LatticeRequest& request, const vec3& eye, float seen) {
    const Medium& medium = pyramid.medium();
    Gathered out;
    out.resize(medium.lattice.node_count(), request.eye.has_value(), request.moments);
    const ConeDepths depths(pyramid);
    const NodeSampler sampler(surroundings, medium);
    NodeSum sum(medium, request, out);
    const float most = std::lerp(kLeastShare, 1.0f, seen);
    parallel_for(
        medium.lattice.brick_count(),
        [&](std::size_t b) {
            std::vector<NodeRay> rays;
            const auto place = [&](std::size_t node) {
                return medium.local_of_node(medium.lattice.node(node)) + medium.spacing * kBesidePlanes;
            };
            const auto shares = shares_of_brick(depths, medium, request, b, eye, most);
            for (int n = 0; n < BrickLattice::kNodes; ++n)
                if (const std::size_t node = b * BrickLattice::kNodes + n; shares[n] > 0.0f)
                    sampler.sample(node, place(node), shares[n], rays);
            add_rays(depths, rays, sum);
        },
        1);
    return out;
}

}  // namespace brisance
