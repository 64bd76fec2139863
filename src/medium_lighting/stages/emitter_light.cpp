#include "medium_lighting/stages/emitter_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/parallel.h"
#include "gathering/cone_depths.h"
#include "gathering/sh.h"
#include "medium/lattice/local_bounds.h"
#include "medium/phase.h"

namespace brisance {

namespace {

// Points on the emitters for a node: most where the camera sees it, least where smoke hides it. A node's variance
// counts by the square of the transmittance T to the camera, so that for the least error at equal cost their number is
// in proportion to T.
constexpr float kMost = 32.0f, kLeast = 8.0f, kMostPerTransmittance = 1.5f;
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

// Random number of a node that turns its choices, apart from those of its samples.
constexpr std::uint64_t kTurn = ~std::uint64_t{0};

// Van der Corput's sequence: the first n of its points are spread evenly, for every n.
double radical_inverse(int k) {
    double sum = 0.0, digit = 0.5;
    for (; k > 0; k /= 2, digit *= 0.5)
        sum += k % 2 * digit;
    return sum;
}

class NodeSampler {
public:
    NodeSampler(const Surroundings& surroundings, const Medium& medium)
        : surroundings_(surroundings),
          // Larger than any distance within the medium.
          beyond_(2.0f * local_bounds(medium).diagonal()) {}

    // Appends the rays of a node at `p`. A light without extent has one ray, however often it was sampled. Each light
    // at infinity, and all others together, take an equal part of `samples`. That need not be a whole number: the last
    // sample of a part counts for what is left, so that light is continuous in it.
    void sample(std::size_t node, const vec3& p, float samples, std::vector<NodeRay>& rays) const {
        const std::size_t first = rays.size(), parts = surroundings_.emitters().choices();
        const double of_part = std::max(1.0, double(samples) / double(parts));
        const double turned = Rng(Stream::NodeEmitter, node, kTurn).next_double();
        const LitPoint point{dvec3(p), dvec3(0.0), LitPoint::Kind::Medium};
        for (std::size_t part = 0; part < parts; ++part)
            for (int k = 0; k < of_part; ++k) {
                Rng rng(Stream::NodeEmitter, node, std::uint64_t{part} << 32 | static_cast<std::uint64_t>(k));
                const double at = turned + radical_inverse(k), choice = (double(part) + at - std::floor(at)) / parts;
                const auto found = surroundings_.emitters().sample(point, choice, rng);
                if (found)
                    add(ray_to(*found, node, p, std::min(1.0, of_part - k) / (of_part * parts)), first, rays);
            }
        const auto hidden = [&](const NodeRay& ray) { return is_hidden(ray); };
        rays.erase(std::remove_if(rays.begin() + static_cast<std::ptrdiff_t>(first), rays.end(), hidden), rays.end());
    }

private:
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
    float beyond_;
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

// Samples of the nodes of one brick; 0 where no light is needed. `most`: where nothing hides them.
std::array<float, BrickLattice::kNodes> samples_of_brick(const ConeDepths& depths, const Medium& medium,
                                                         const LatticeRequest& request, std::size_t brick,
                                                         const vec3& eye, float most) {
    std::array<float, BrickLattice::kNodes> samples{};
    std::array<ConeDepths::Segment, ConeDepths::kCones> segments;
    std::array<float, ConeDepths::kCones> depth;
    for (int first = 0; first < BrickLattice::kNodes; first += ConeDepths::kCones) {
        for (int k = 0; k < ConeDepths::kCones; ++k)
            segments[k] = {medium.local_of_node(medium.lattice.node(brick * BrickLattice::kNodes + first + k)), eye};
        depths.along(segments, ConeDepths::kCones, 0.0f, depth);
        for (int k = 0; k < ConeDepths::kCones; ++k)
            if ((*request.needed)[brick * BrickLattice::kNodes + first + k])
                samples[first + k] =
                    std::max(kLeast, most * std::min(1.0f, kMostPerTransmittance * std::exp(-depth[k])));
    }
    return samples;
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
    const float most = std::lerp(kLeast, kMost, seen);
    parallel_for(
        medium.lattice.brick_count(),
        [&](std::size_t b) {
            std::vector<NodeRay> rays;
            const auto samples = samples_of_brick(depths, medium, request, b, eye, most);
            for (int n = 0; n < BrickLattice::kNodes; ++n)
                if (const std::size_t node = b * BrickLattice::kNodes + n; samples[n] > 0.0f)
                    sampler.sample(node, medium.local_of_node(medium.lattice.node(node)), samples[n], rays);
            add_rays(depths, rays, sum);
        },
        1);
    return out;
}

}  // namespace brisance
