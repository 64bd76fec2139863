#include "medium_lighting/stages/emitter_light.h"

#include <array>
#include <cmath>

#include "core/parallel.h"
#include "gathering/point_depths.h"
#include "gathering/sh.h"
#include "medium/lattice/local_bounds.h"
#include "medium/phase.h"

namespace brisance {

namespace {

constexpr int kRays = PointDepths::kRays;
constexpr int kBatches = 2;  // of kRays each

// Light of kRays points on the emitters at one node: irradiances perpendicular to their directions [W/m^2].
struct Arriving {
    std::array<vec3, kRays> direction;  // of travel
    std::array<Rgb, kRays> light;
};

class NodeGather {
public:
    NodeGather(const Surroundings& surroundings, const ExtinctionPyramid& pyramid)
        : surroundings_(surroundings), depths_(pyramid, 0) {
        // Larger than any distance within the medium.
        beyond_ = 2.0f * local_bounds(pyramid.medium()).diagonal();
    }

    Arriving sample_batch(std::size_t node, const vec3& p, int batch) const {
        Arriving out;
        std::array<vec3, kRays> ends;
        std::array<float, kRays> depth;
        for (int k = 0; k < kRays; ++k)
            ends[k] = end_of_ray(node, p, batch * kRays + k, out.direction[k], out.light[k]);
        depths_.between(p, ends.data(), depth.data());
        for (int k = 0; k < kRays; ++k)
            out.light[k] *= std::exp(-depth[k]) / float(kRays * kBatches);
        return out;
    }

private:
    // The end of ray `number` of a node; sets its direction of travel, and its light before any smoke.
    vec3 end_of_ray(std::size_t node, const vec3& p, int number, vec3& direction, Rgb& light) const {
        Rng rng(Stream::NodeEmitter, node, static_cast<std::uint64_t>(number));
        const auto sample = surroundings_.emitters().sample({dvec3(p), dvec3(0.0), LitPoint::Kind::Medium},
                                                            (number + 0.5) / (kRays * kBatches), rng);
        direction = vec3(0.0f, 0.0f, 1.0f);
        light = Rgb(0.0f);
        if (!sample)
            return p;
        direction = -vec3(sample->direction);
        const bool near = std::isfinite(sample->distance);
        const dvec3 end = near ? sample->end : dvec3(p) + double(beyond_) * sample->direction;
        const double distance = near ? glm::distance(end, dvec3(p)) : sample->distance;
        if (!(distance > 0.0))
            return p;
        const dvec3 direction_to_end = near ? (end - dvec3(p)) / distance : sample->direction;
        if (!surroundings_.intersector().occluded({dvec3(p), direction_to_end}, distance))
            light = sample->weight;
        return vec3(end);
    }

    const Surroundings& surroundings_;
    PointDepths depths_;
    float beyond_;
};

}  // namespace

Gathered gather_from_emitters(const Surroundings& surroundings, const ExtinctionPyramid& pyramid,
                              const LatticeRequest& request) {
    const Medium& medium = pyramid.medium();
    const std::size_t nodes = medium.lattice.node_count();
    Gathered out;
    out.resize(nodes, request.eye.has_value(), request.moments);
    const NodeGather gather(surroundings, pyramid);
    const auto add = [&](std::size_t node, const vec3& toward_camera, const vec3& direction, const Rgb& light) {
        const float phase =
            request.eye ? henyey_greenstein(glm::dot(direction, toward_camera), request.mean_cosine) : 0.0f;
        const auto basis = sh_basis(direction);
        for (int c = 0; c < 3; ++c) {
            out.fluence[c * nodes + node] += light[c];
            if (request.eye)
                out.scattered[c * nodes + node] += phase * light[c];
            for (int m = 0; request.moments && m < kShMoments; ++m)
                out.moments[(3 * m + c) * nodes + node] += light[c] * basis[m];
        }
    };
    parallel_for(
        nodes,
        [&](std::size_t node) {
            if (!(*request.needed)[node])
                return;
            const vec3 p = medium.local_of_node(medium.lattice.node(node));
            const vec3 toward_camera = request.eye ? direction_toward(*request.eye, p) : vec3(0.0f);
            for (int batch = 0; batch < kBatches; ++batch) {
                const Arriving a = gather.sample_batch(node, p, batch);
                for (int k = 0; k < kRays; ++k)
                    if (a.light[k] != Rgb(0.0f))
                        add(node, toward_camera, a.direction[k], a.light[k]);
            }
        },
        64);
    return out;
}

}  // namespace brisance
