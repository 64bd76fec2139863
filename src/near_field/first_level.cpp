#include "near_field/first_level.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <tuple>

#include "core/parallel.h"
#include "medium/lattice/brick_masks.h"
#include "near_field/first_level_kernels.h"

namespace brisance {

namespace {

constexpr int kParities = 8;
constexpr int kLongestReach = 14;  // nodes; a cubic lattice needs 9 at twice the spacing as the radius

// Nodes per axis between a receiver and a vertex whose light may reach it.
ivec3 reach_of(const mat3& local_from_index, float radius) {
    const mat3 rows = glm::transpose(glm::inverse(local_from_index));
    ivec3 reach;
    for (int a = 0; a < 3; ++a)
        reach[a] = 1 + static_cast<int>(std::min(2.0f * radius * glm::length(rows[a]), 1e6f));
    return reach;
}

// The longest shift of a light from its vertex: a node per axis [m].
float longest_shift(const mat3& local_from_index) {
    float longest = 0.0f;
    for (int k = 0; k < 4; ++k)
        longest =
            std::max(longest, glm::length(local_from_index * vec3(1.0f, k & 1 ? 1.0f : -1.0f, k & 2 ? 1.0f : -1.0f)));
    return longest;
}

}  // namespace

bool FirstLevel::is_small(const mat3& local_from_index, float radius) {
    const ivec3 reach = reach_of(local_from_index, radius);
    return std::max({reach.x, reach.y, reach.z}) <= kLongestReach;
}

FirstLevel::FirstLevel(const mat3& local_from_index, float radius)
    : radius_(radius), longest_reach_(2.0f * radius + longest_shift(local_from_index)) {
    const ivec3 reach = reach_of(local_from_index, radius), cells = (reach + 1) / 2 + 1;
    const float shift = longest_reach_ - 2.0f * radius;
    parallel_for(kParities, [&](std::size_t p) {
        for (int x = -cells.x; x <= cells.x; ++x)
            for (int y = -cells.y; y <= cells.y; ++y)
                for (int z = -cells.z; z <= cells.z; ++z) {
                    const ivec3 vertex(x, y, z), node = 2 * vertex - parity(int(p));
                    const vec3 to_vertex = local_from_index * vec3(node);
                    const float d = glm::length(to_vertex);
                    if (d < longest_reach_ && d > 0.5f * radius - shift)
                        separations_[p].push_back({vertex, to_vertex, false, {}});
                }
    });
    for (int p = 0; p < kParities; ++p)
        parallel_for(separations_[p].size(), [&](std::size_t i) {
            Separation& s = separations_[p][i];
            const ivec3 node = 2 * s.vertex - parity(p);
            s.own = node == ivec3(0);
            s.taps =
                s.own ? std::vector<ShiftedTap>{{ivec3(0), 1.0f, vec3(0.0f)}} : shifted_taps(node, local_from_index);
        });
    for (const auto& of_parity : separations_)
        for (const Separation& s : of_parity)
            for (int a = 0; a < 3; ++a)
                margin_ = std::max(margin_, std::abs(s.vertex[a]) + 1);
}

namespace {

constexpr int kSize = BrickLattice::kSize, kCells = FirstLevelBlock::kCells;

// Intensity and shift from its vertex of each light, six per node of the lights' lattice.
std::vector<float> lights_at_vertices(const FirstLevel::Input& in) {
    const GridLevel& lights = *in.lights;
    std::vector<float> out(lights.lattice.node_count() * 6, 0.0f);
    parallel_for(
        lights.size(),
        [&](std::size_t i) {
            float* const to = &out[std::size_t(lights.node[i]) * 6];
            const vec3 shift = lights.position[i] - in.local_of_node(2 * lights.vertex[i]);
            for (int a = 0; a < 3; ++a) {
                to[a] = lights.intensity[i][a];
                to[3 + a] = shift[a];
            }
        },
        1024);
    return out;
}

std::vector<float> directions_at_vertices(const GridLevel& lights) {
    std::vector<float> out(lights.directional.empty() ? 0 : lights.lattice.node_count() * 24, 0.0f);
    for (std::size_t i = 0; !out.empty() && i < lights.size(); ++i)
        std::copy_n(&lights.directional[i * 24], 24, &out[std::size_t(lights.node[i]) * 24]);
    return out;
}

// Light is gathered in blocks of 8^3 cells, with the memory of one thread.
class BlockGather {
public:
    BlockGather(const FirstLevel& level, const FirstLevel::Input& in, const FirstLevel::Targets& targets, Gathered& out)
        : in_(in),
          targets_(targets),
          out_(out),
          radius_(level.radius()),
          margin_(level.margin()),
          wide_(kSize + 2 * margin_),
          plane_(std::size_t(wide_) * wide_ * wide_),
          light_(lights_at_vertices(in)),
          directional_(directions_at_vertices(*in.lights)),
          parities_(targets.every_second ? 1 : kParities) {
        for (int p = 0; p < parities_; ++p)
            separations_.push_back(flatten(level, p, wide_));
    }

    std::uint64_t run() {
        const std::vector<ivec3> blocks = blocks_with_targets();
        std::vector<std::uint64_t> evaluations(blocks.size(), 0);
        parallel_for(blocks.size(), [&](std::size_t i) { evaluations[i] = gather(blocks[i]); });
        return std::accumulate(evaluations.begin(), evaluations.end(), std::uint64_t{0});
    }

private:
    struct Memory {
        std::vector<float> nodes, extinction, light, directional, toward_camera, fluence, scattered, moments;
    };

    int nodes_per_cell() const { return targets_.every_second ? 1 : 2; }  // of the targets' lattice

    std::vector<ivec3> blocks_with_targets() const {
        std::vector<ivec3> blocks;
        for (std::size_t b = 0; b < targets_.lattice->brick_count(); ++b)
            if (any_in_brick(*targets_.needed, b))
                blocks.push_back(targets_.every_second ? targets_.lattice->brick(b) : targets_.lattice->brick(b) >> 1);
        std::sort(blocks.begin(), blocks.end(),
                  [](const ivec3& a, const ivec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
        blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
        return blocks;
    }

    // Calls `take` with each cell of a block and the index of its node of one parity, where that is needed.
    template <class Take>
    void for_each_target(const ivec3& block, int parity, const Take& take) const {
        for (int cell = 0; cell < kCells; ++cell) {
            const ivec3 at = block * kSize + BrickLattice::node_in_brick(cell);
            const std::int64_t node = targets_.lattice->find_node(nodes_per_cell() * at + FirstLevel::parity(parity));
            if (node >= 0 && (*targets_.needed)[std::size_t(node)])
                take(cell, std::size_t(node));
        }
    }

    std::vector<FirstLevelBlock::Row> rows_with_targets(const ivec3& block, int parity) const {
        std::array<bool, kSize * kSize> needed{};
        for_each_target(block, parity, [&](int cell, std::size_t) { needed[std::size_t(cell / kSize)] = true; });
        std::vector<FirstLevelBlock::Row> rows;
        for (int k = 0; k < kSize * kSize; ++k)
            if (needed[std::size_t(k)])
                rows.push_back({((k / kSize + margin_) * wide_ + k % kSize + margin_) * wide_ + margin_, k * kSize});
        return rows;
    }

    std::uint64_t gather(const ivec3& block) const {
        thread_local Memory m;
        const ivec3 low = block * kSize - margin_;
        m.light.resize(plane_ * 6);
        copy_box(in_.lights->lattice, light_, 6, low, ivec3(wide_), m.light);
        if (std::all_of(m.light.begin(), m.light.begin() + std::ptrdiff_t(3 * plane_),
                        [](float v) { return v == 0.0f; }))
            return 0;
        part_extinction(low, m);
        if (!directional_.empty()) {
            m.directional.resize(plane_ * 24);
            copy_box(in_.lights->lattice, directional_, 24, low, ivec3(wide_), m.directional);
        }
        std::uint64_t evaluations = 0;
        for (int p = 0; p < parities_; ++p)
            evaluations += gather(block, p, m);
        return evaluations;
    }

    // The extinction of a box by the parities of its nodes.
    void part_extinction(const ivec3& low, Memory& m) const {
        const int nodes = 2 * wide_;
        m.nodes.resize(8 * plane_);
        m.extinction.resize(8 * plane_);
        copy_box(in_.pyramid->lattice(in_.lattice_level()), *in_.extinction, 1, 2 * low, ivec3(nodes), m.nodes);
        const float* from = m.nodes.data();
        for (int x = 0; x < nodes; ++x)
            for (int y = 0; y < nodes; ++y) {
                float* const even = &m.extinction[((x & 1) << 2 | (y & 1) << 1) * plane_ +
                                                  ((x >> 1) * wide_ + (y >> 1)) * std::size_t(wide_)];
                for (int z = 0; z < wide_; ++z) {
                    even[z] = *from++;
                    even[plane_ + z] = *from++;
                }
            }
    }

    std::uint64_t gather(const ivec3& block, int parity, Memory& m) const {
        const std::vector<FirstLevelBlock::Row> rows = rows_with_targets(block, parity);
        if (rows.empty())
            return 0;
        m.fluence.assign(3 * kCells, 0.0f);
        m.scattered.assign(out_.scattered.empty() ? 0 : 3 * kCells, 0.0f);
        m.moments.assign(out_.moments.empty() ? 0 : 24 * kCells, 0.0f);
        FirstLevelBlock b{};
        b.plane = plane_;
        b.extinction = m.extinction.data();
        b.light = m.light.data();
        b.directional = directional_.empty() ? nullptr : m.directional.data();
        b.toward_camera = in_.eye ? directions(block, parity, m) : nullptr;
        b.radius = radius_;
        b.mean_cosine = in_.mean_cosine;
        b.fluence = m.fluence.data();
        b.scattered = m.scattered.empty() ? nullptr : m.scattered.data();
        b.moments = m.moments.empty() ? nullptr : m.moments.data();
        b.rows = rows;
        const std::uint64_t evaluations = gather_first_level(separations_[std::size_t(parity)], b);
        add(block, parity, m.fluence, out_.fluence);
        add(block, parity, m.scattered, out_.scattered);
        add(block, parity, m.moments, out_.moments);
        return evaluations;
    }

    const float* directions(const ivec3& block, int parity, Memory& m) const {
        m.toward_camera.resize(3 * kCells);
        for (int cell = 0; cell < kCells; ++cell) {
            const ivec3 node = 2 * (block * kSize + BrickLattice::node_in_brick(cell)) + FirstLevel::parity(parity);
            const vec3 toward = direction_toward(*in_.eye, in_.local_of_node(node));
            for (int a = 0; a < 3; ++a)
                m.toward_camera[std::size_t(a * kCells + cell)] = toward[a];
        }
        return m.toward_camera.data();
    }

    void add(const ivec3& block, int parity, const std::vector<float>& values, std::vector<float>& out) const {
        const std::size_t nodes = targets_.lattice->node_count();
        for_each_target(block, parity, [&](int cell, std::size_t node) {
            for (std::size_t c = 0; c < values.size() / kCells; ++c)
                out[c * nodes + node] += values[c * kCells + std::size_t(cell)];
        });
    }

    const FirstLevel::Input& in_;
    const FirstLevel::Targets& targets_;
    Gathered& out_;
    float radius_;
    int margin_, wide_;
    std::size_t plane_;
    std::vector<float> light_, directional_;
    int parities_;
    std::vector<FlatSeparations> separations_;
};

}  // namespace

std::uint64_t FirstLevel::gather(const Input& input, const Targets& targets, Gathered& out) const {
    return BlockGather(*this, input, targets, out).run();
}

}  // namespace brisance
