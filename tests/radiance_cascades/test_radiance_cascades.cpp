// Light that a source function in the medium sends to its nodes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/parallel.h"
#include "fixtures/estimate.h"
#include "fixtures/media.h"
#include "radiance_cascades/radiance_cascades.h"
#include "scattering/balance.h"

namespace brisance {
namespace {

using namespace testing;

std::vector<std::uint8_t> smoke_nodes(const Medium& medium) {
    std::vector<std::uint8_t> mask;
    for (const float e : medium.extinction)
        mask.push_back(e > 0.0f);
    return mask;
}

std::vector<float> source_of(const Medium& medium, const std::function<Rgb(const ivec3&)>& at) {
    std::vector<float> source;
    for (std::size_t i = 0; i < medium.extinction.size(); ++i) {
        const Rgb s = at(medium.lattice.node(i));
        source.insert(source.end(), {s.x, s.y, s.z});
    }
    return source;
}

struct Errors {
    double mean = 0.0, root_mean_square = 0.0;
};

// Of the fluence over what rays say, at the nodes in smoke.
Errors errors_against_rays(const Lit& lit, const Gathered& light) {
    std::vector<ivec3> nodes;
    std::vector<std::size_t> index;
    for (std::size_t i = 0; i < lit.medium.extinction.size(); ++i)
        if (lit.medium.extinction[i] > 0.0f) {
            nodes.push_back(lit.medium.lattice.node(i));
            index.push_back(i);
        }
    const std::vector<float> expected = collision_probabilities(lit.pyramid, nodes, 0, 1024);
    Errors e;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
        const double error = light.fluence[index[k]] / (4.0 * kPi64 * expected[k]) - 1.0;
        e.mean += error / double(nodes.size());
        e.root_mean_square += error * error / double(nodes.size());
    }
    e.root_mean_square = std::sqrt(e.root_mean_square);
    return e;
}

TEST(RadianceCascades, Explore) {
    for (const float depth : {0.5f, 2.0f, 8.0f}) {
        const Lit lit(make_medium(glowing_ball(12, depth)));
        for (const bool meets : {false, true})
            for (const float near : {1.0f, 2.0f, 4.0f})
                for (const int side : {4, 8})
                    for (const int finer : {0, 1, 2}) {
                        CascadeSettings s;
                        s.side = side;
                        s.near = near;
                        s.meets_probes = meets;
                        s.finer = finer;
                        RadianceCascades c(lit.pyramid, smoke_nodes(lit.medium), s);
                        const auto src = source_of(lit.medium, [](const ivec3&) { return Rgb(1.0f); });
                        const Errors e = errors_against_rays(lit, c.gather(src, 3));
                        std::printf("depth %g meets %d near %g side %d finer %d: mean %.4f rms %.4f\n", depth, meets,
                                    near, side, finer, e.mean, e.root_mean_square);
                    }
    }
}

}  // namespace
}  // namespace brisance
