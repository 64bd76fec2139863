#include "lighting_grid/voxel_lights.h"

#include <algorithm>
#include <array>
#include <span>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr int kWide = BrickLattice::kSize + 2;  // a brick and one node all round
constexpr int kPlane = kWide * kWide * kWide;

constexpr int at(int x, int y, int z) {
    return (x * kWide + y) * kWide + z;
}

constexpr int corner_offset(int k) {
    return at(k >> 2, k >> 1 & 1, k & 1);
}

// Trilinear weights of the eight corners at the eight Gauss points of the unit cell.
std::array<std::array<float, 8>, 8> gauss_weights() {
    constexpr double point[2] = {0.21132486540518711775, 0.78867513459481288225};
    std::array<std::array<float, 8>, 8> w;
    for (int g = 0; g < 8; ++g)
        for (int c = 0; c < 8; ++c) {
            double product = 1.0;
            for (int a = 0; a < 3; ++a) {
                const double t = point[g >> a & 1];
                product *= (c >> (2 - a) & 1) ? t : 1.0 - t;
            }
            w[g][c] = static_cast<float>(product);
        }
    return w;
}

const std::array<std::array<float, 8>, 8> kGauss = gauss_weights();

struct Boxes {
    std::vector<float> extinction = std::vector<float>(kPlane);
    std::vector<float> factor = std::vector<float>(3 * kPlane);
    std::vector<float> emission = std::vector<float>(3 * kPlane);
    std::vector<float> sum = std::vector<float>(3 * kPlane);
};

// Adds one cell's integral of hat * (extinction * factor + emission) to its eight corners, in units of a cell's volume.
void add_cell(Boxes& box, int cell) {
    for (int g = 0; g < 8; ++g) {
        float sigma = 0.0f;
        Rgb q(0.0f), j(0.0f);
        for (int c = 0; c < 8; ++c) {
            const int i = cell + corner_offset(c);
            const float w = kGauss[g][c];
            sigma += w * box.extinction[i];
            for (int a = 0; a < 3; ++a) {
                q[a] += w * box.factor[a * kPlane + i];
                j[a] += w * box.emission[a * kPlane + i];
            }
        }
        const Rgb value = (sigma * q + j) * 0.125f;
        for (int c = 0; c < 8; ++c)
            for (int a = 0; a < 3; ++a)
                box.sum[a * kPlane + cell + corner_offset(c)] += kGauss[g][c] * value[a];
    }
}

bool voxel_is_dark(const Boxes& box, int cell) {
    bool absorbs = false, factor = false, emits = false;
    for (int c = 0; c < 8; ++c) {
        const int i = cell + corner_offset(c);
        absorbs = absorbs || box.extinction[i] != 0.0f;
        for (int a = 0; a < 3; ++a) {
            factor = factor || box.factor[a * kPlane + i] != 0.0f;
            emits = emits || box.emission[a * kPlane + i] != 0.0f;
        }
    }
    return !(absorbs && factor) && !emits;
}

std::span<const float> flat(const std::vector<Rgb>& field) {
    return {reinterpret_cast<const float*>(field.data()), field.size() * 3};
}

std::vector<Rgb> project(const Medium& medium, const std::vector<Rgb>& factor, const std::vector<Rgb>& emission) {
    const BrickLattice& lattice = medium.lattice;
    std::vector<Rgb> lights(lattice.node_count(), Rgb(0.0f));
    parallel_for(lattice.brick_count(), [&](std::size_t b) {
        Boxes box;
        const ivec3 low = lattice.first_node(b) - 1;
        copy_box(lattice, medium.extinction, 1, low, ivec3(kWide), box.extinction);
        if (!factor.empty())
            copy_box(lattice, flat(factor), 3, low, ivec3(kWide), box.factor);
        if (!emission.empty())
            copy_box(lattice, flat(emission), 3, low, ivec3(kWide), box.emission);
        for (int x = 0; x < kWide - 1; ++x)
            for (int y = 0; y < kWide - 1; ++y)
                for (int z = 0; z < kWide - 1; ++z)
                    if (!voxel_is_dark(box, at(x, y, z)))
                        add_cell(box, at(x, y, z));
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const ivec3 p = BrickLattice::node_in_brick(n) + 1;
            for (int a = 0; a < 3; ++a)
                lights[b * BrickLattice::kNodes + n][a] = medium.voxel_volume * box.sum[a * kPlane + at(p.x, p.y, p.z)];
        }
    });
    return lights;
}

}  // namespace

std::vector<Rgb> voxel_lights(const Medium& medium) {
    if (!medium.emits())
        return {};
    std::vector<Rgb> lights = project(medium, medium.source, medium.emission);
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

// The share of its outgoing flux that a node can afford.
float affordable(const float* v, const Surrounded& s) {
    float out = 0.0f;
    for (int a = 0; a < 3; ++a)
        for (int step : {-s.stride(a), s.stride(a)})
            out += std::max(0.0f, v[step] - *v) / 12.0f;
    return out > *v ? *v / out : 1.0f;
}

}  // namespace

void sharpen_lights(const BrickLattice& lattice, std::vector<Rgb>& intensity) {
    const std::vector<Rgb> before = intensity;
    parallel_for(lattice.brick_count(), [&](std::size_t b) {
        const Surrounded s(lattice, flat(before), 3, b, 2);
        if (std::all_of(s.box.begin(), s.box.end(), [](float v) { return v == 0.0f; }))
            return;
        const std::size_t plane = std::size_t(s.wide) * s.wide * s.wide;
        std::vector<float> share(plane, 1.0f);
        for (int c = 0; c < 3; ++c) {
            const float* values = &s.box[c * plane];
            for (int x = 1; x < s.wide - 1; ++x)
                for (int y = 1; y < s.wide - 1; ++y)
                    for (int z = 1; z < s.wide - 1; ++z)
                        share[s.index({x, y, z})] = affordable(values + s.index({x, y, z}), s);
            for (int n = 0; n < BrickLattice::kNodes; ++n) {
                const int i = s.index(BrickLattice::node_in_brick(n) + 2);
                float sum = values[i];
                for (int a = 0; a < 3; ++a)
                    for (int k : {i - s.stride(a), i + s.stride(a)}) {
                        const float flux = (values[k] - values[i]) / 12.0f;  // out of this node where positive
                        sum -= flux * (flux > 0.0f ? share[i] : share[k]);
                    }
                intensity[b * BrickLattice::kNodes + n][c] = std::max(sum, 0.0f);
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

}  // namespace brisance
