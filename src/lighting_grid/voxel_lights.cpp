#include "lighting_grid/voxel_lights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr int kWide = BrickLattice::kSize + 2;  // a brick and one node all round
constexpr int kPlane = kWide * kWide * kWide;

constexpr int at(int x, int y, int z) {
    return (x * kWide + y) * kWide + z;
}

// The two Gauss points of the unit interval: weights of its ends.
constexpr float kGauss[2][2] = {{0.78867513459481288225f, 0.21132486540518711775f},
                                {0.21132486540518711775f, 0.78867513459481288225f}};
constexpr int kStride[3] = {at(0, 0, 1), at(0, 1, 0), at(1, 0, 0)};

using Box = std::array<float, kPlane>;
using GaussBoxes = std::array<Box, 8>;  // one value per voxel at each of its Gauss points

// Node values at the Gauss points of all voxels, one axis after the other. A voxel is known by its lowest node. Voxels
// that begin at the last node of a row read the next row: they add to nodes of the margin only, which no one reads.
void to_gauss_points(const float* nodes, GaussBoxes& points) {
    std::copy_n(nodes, kPlane, points[0].begin());
    for (int a = 0; a < 3; ++a)
        for (int g = 0; g < 1 << a; ++g) {
            Box &low = points[g], &high = points[g | 1 << a];
            for (int i = 0; i < kPlane - kStride[a]; ++i) {
                const float begin = low[i], end = low[i + kStride[a]];
                high[i] = kGauss[1][0] * begin + kGauss[1][1] * end;
                low[i] = kGauss[0][0] * begin + kGauss[0][1] * end;
            }
        }
}

// The transpose: values of voxels at their Gauss points, as sums at the nodes. Uses `points` up.
void from_gauss_points(GaussBoxes& points, float* nodes) {
    for (int a = 2; a >= 0; --a)
        for (int g = 0; g < 1 << a; ++g) {
            Box &low = points[g], &high = points[g | 1 << a];
            Box sum;
            sum.fill(0.0f);
            for (int i = 0; i < kPlane - kStride[a]; ++i)
                sum[i] = kGauss[0][0] * low[i] + kGauss[1][0] * high[i];
            for (int i = 0; i < kPlane - kStride[a]; ++i)
                sum[i + kStride[a]] += kGauss[0][1] * low[i] + kGauss[1][1] * high[i];
            low = sum;
        }
    std::copy(points[0].begin(), points[0].end(), nodes);
}

std::span<const float> flat(const std::vector<Rgb>& field) {
    return {reinterpret_cast<const float*>(field.data()), field.size() * 3};
}

bool dark(std::span<const float> box) {
    return std::all_of(box.begin(), box.end(), [](float v) { return v == 0.0f; });
}

// Integrals over a brick and its margin of hat * (extinction * factor + emission), in units of a voxel's volume.
struct BrickProjection {
    Box extinction;
    std::array<float, 3 * kPlane> factor, emission, sum;
    GaussBoxes sigma, value, emitted;

    void run() {
        const bool scatters = !dark(extinction) && !dark(factor), emits = !dark(emission);
        sum.fill(0.0f);
        if (scatters)
            to_gauss_points(extinction.data(), sigma);
        for (int c = 0; c < 3 && (scatters || emits); ++c) {
            const int plane = c * kPlane;
            if (scatters)
                to_gauss_points(&factor[plane], value);
            if (emits)
                to_gauss_points(&emission[plane], emitted);
            for (int g = 0; g < 8; ++g)
                for (int i = 0; i < kPlane; ++i)
                    value[g][i] =
                        0.125f * ((scatters ? sigma[g][i] * value[g][i] : 0.0f) + (emits ? emitted[g][i] : 0.0f));
            from_gauss_points(value, &sum[plane]);
        }
    }
};

std::vector<Rgb> project(const Medium& medium, const std::vector<Rgb>& factor, const std::vector<Rgb>& emission) {
    const BrickLattice& lattice = medium.lattice;
    std::vector<Rgb> lights(lattice.node_count(), Rgb(0.0f));
    parallel_blocks(lattice.brick_count(), 16, [&](std::size_t begin, std::size_t end) {
        const auto box = std::make_unique<BrickProjection>();
        for (std::size_t b = begin; b < end; ++b) {
            const ivec3 low = lattice.first_node(b) - 1;
            const auto copy = [&](std::span<const float> field, int channels, std::span<float> to) {
                if (field.empty())
                    std::fill(to.begin(), to.end(), 0.0f);
                else
                    copy_box(lattice, field, channels, low, ivec3(kWide), to);
            };
            copy(medium.extinction, 1, box->extinction);
            copy(flat(factor), 3, box->factor);
            copy(flat(emission), 3, box->emission);
            box->run();
            for (int n = 0; n < BrickLattice::kNodes; ++n) {
                const ivec3 p = BrickLattice::node_in_brick(n) + 1;
                for (int a = 0; a < 3; ++a)
                    lights[b * BrickLattice::kNodes + n][a] =
                        medium.voxel_volume * box->sum[a * kPlane + at(p.x, p.y, p.z)];
            }
        }
    });
    return lights;
}

}  // namespace

std::vector<Rgb> voxel_lights_unsharpened(const Medium& medium) {
    return medium.emits() ? project(medium, medium.source, medium.emission) : std::vector<Rgb>();
}

std::vector<Rgb> voxel_lights(const Medium& medium) {
    std::vector<Rgb> lights = voxel_lights_unsharpened(medium);
    sharpen_lights(medium.lattice, lights);
    return lights;
}

namespace {

// A brick's values with `margin` nodes all round, and the strides between neighbours.
struct Surrounded {
    int wide;
    std::vector<float> box;
    Surrounded(const BrickLattice& lattice, std::span<const float> field, int channels, std::size_t brick, int margin)
        : wide(BrickLattice::kSize + 2 * margin), box(std::size_t(wide) * wide * wide * channels) {
        copy_box(lattice, field, channels, lattice.first_node(brick) - margin, ivec3(wide), box);
    }
    int stride(int axis) const { return axis == 0 ? wide * wide : (axis == 1 ? wide : 1); }
    int index(const ivec3& p) const { return (p.x * wide + p.y) * wide + p.z; }
};

// The part of its outgoing flux, `share` of each difference, that a node can afford.
float affordable(const float* v, const Surrounded& s, float share) {
    float out = 0.0f;
    for (int a = 0; a < 3; ++a)
        for (int step : {-s.stride(a), s.stride(a)})
            out += share * std::max(0.0f, v[step] - *v);
    return out > *v ? *v / out : 1.0f;
}

}  // namespace

void sharpen_lights(const BrickLattice& lattice, std::vector<Rgb>& intensity, int sharpened_below) {
    const float left = sharpened_below > 0 ? 1.0f - std::exp2(-2.0f * float(sharpened_below)) : 1.0f;
    if (!intensity.empty())
        sharpen_nodes(lattice, {reinterpret_cast<float*>(intensity.data()), intensity.size() * 3}, 3, left / 12.0f);
}

void sharpen_nodes(const BrickLattice& lattice, std::span<float> values_of_nodes, int channels, float share) {
    const std::vector<float> before(values_of_nodes.begin(), values_of_nodes.end());
    parallel_for(lattice.brick_count(), [&](std::size_t b) {
        const Surrounded s(lattice, before, channels, b, 2);
        if (std::all_of(s.box.begin(), s.box.end(), [](float v) { return v == 0.0f; }))
            return;
        const std::size_t plane = std::size_t(s.wide) * s.wide * s.wide;
        std::vector<float> afforded(plane, 1.0f);
        for (int c = 0; c < channels; ++c) {
            const float* values = &s.box[c * plane];
            for (int x = 1; x < s.wide - 1; ++x)
                for (int y = 1; y < s.wide - 1; ++y)
                    for (int z = 1; z < s.wide - 1; ++z)
                        afforded[s.index({x, y, z})] = affordable(values + s.index({x, y, z}), s, share);
            for (int n = 0; n < BrickLattice::kNodes; ++n) {
                const int i = s.index(BrickLattice::node_in_brick(n) + 2);
                float sum = values[i];
                for (int a = 0; a < 3; ++a)
                    for (int k : {i - s.stride(a), i + s.stride(a)}) {
                        const float flux = share * (values[k] - values[i]);  // out of this node where positive
                        sum -= flux * (flux > 0.0f ? afforded[i] : afforded[k]);
                    }
                values_of_nodes[(b * BrickLattice::kNodes + n) * channels + c] = std::max(sum, 0.0f);
            }
        }
    });
}

void sharpen_interpolant(const BrickLattice& lattice, const std::vector<std::uint8_t>& mask, std::span<float> values) {
    const std::vector<float> before(values.begin(), values.end());
    const std::vector<float> masked(mask.begin(), mask.end());
    parallel_for(lattice.brick_count(), [&](std::size_t b) {
        const Surrounded v(lattice, before, 1, b, 1), m(lattice, masked, 1, b, 1);
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const int i = v.index(BrickLattice::node_in_brick(n) + 1);
            if (m.box[i] == 0.0f)
                continue;
            float second = 0.0f;
            for (int a = 0; a < 3; ++a)
                if (m.box[i - v.stride(a)] != 0.0f && m.box[i + v.stride(a)] != 0.0f)
                    second += v.box[i - v.stride(a)] + v.box[i + v.stride(a)] - 2.0f * v.box[i];
            values[b * BrickLattice::kNodes + n] = v.box[i] - second / 12.0f;
        }
    });
}

std::vector<Rgb> project_extinction_times(const Medium& medium, const std::vector<Rgb>& factor) {
    return project(medium, factor, {});
}

dvec3 total(const std::vector<Rgb>& values) {
    dvec3 sum(0.0);
    for (const Rgb& v : values)
        sum += dvec3(v);
    return sum;
}

double total_luminance(const std::vector<Rgb>& values) {
    return luminance(Rgb(total(values)));
}

}  // namespace brisance
