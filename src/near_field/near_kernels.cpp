#include "near_field/near_kernels.h"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "near_field/near_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "medium/phase-inl.h"
#include "medium/sh.h"

HWY_BEFORE_NAMESPACE();
namespace brisance {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 8>;  // a brick's row is eight nodes
using V = hn::Vec<D>;

// Moments lie side by side: planes of nodes lie so far apart that they would share few lines of a cache.
struct Sums {
    V fluence[3], scattered[3];
    alignas(64) float moments[3 * kShMoments][8] = {};
};

HWY_INLINE bool row_is_dark(D d, const NearBrick& b, const float* light) {
    const V sum =
        hn::Add(hn::LoadU(d, light), hn::Add(hn::LoadU(d, light + b.plane), hn::LoadU(d, light + 2 * b.plane)));
    return hn::AllTrue(d, hn::Eq(sum, hn::Zero(d)));
}

constexpr std::uint8_t kAllOfRow = 0xff;

// One separation's contribution to one row of receivers starting at box index `at`. `seen`: a bit for each.
HWY_INLINE void add_separation(D d, const FlatStencil& stencil, const FlatSeparation& s, const NearBrick& b, int at,
                               std::uint8_t seen, const V camera[3], Sums& sums) {
    const float* light = b.intensity + at + s.offset;
    if (seen == 0 || row_is_dark(d, b, light))
        return;
    V w = hn::Set(d, s.kernel);
    if (seen != kAllOfRow) {
        alignas(8) const std::uint8_t bits[8] = {seen};  // as many as may be read
        w = hn::IfThenElseZero(hn::LoadMaskBits(d, bits), w);
    }
    if (s.first_tap != s.last_tap) {
        V depth = hn::Zero(d);
        for (int t = s.first_tap; t < s.last_tap; ++t)
            depth = hn::MulAdd(hn::Set(d, stencil.taps[t].length),
                               hn::LoadU(d, b.extinction + at + stencil.taps[t].offset), depth);
        w = hn::Mul(w, hn::Exp(d, hn::Neg(hn::Min(depth, hn::Set(d, 80.0f)))));
    }
    V phase = hn::Zero(d);
    if (b.scattered)
        phase = henyey_greenstein_lanes(d, b.mean_cosine,
                                        hn::MulAdd(hn::Set(d, s.direction.x), camera[0],
                                                   hn::MulAdd(hn::Set(d, s.direction.y), camera[1],
                                                              hn::Mul(hn::Set(d, s.direction.z), camera[2]))));
    for (int c = 0; c < 3; ++c) {
        V intensity = hn::LoadU(d, light + c * b.plane);
        if (b.directional)
            for (int m = 0; m < kShMoments; ++m)
                intensity = hn::MulAdd(hn::Set(d, s.basis[m]),
                                       hn::LoadU(d, b.directional + (3 * m + c) * b.plane + at + s.offset), intensity);
        const V arriving = hn::Mul(intensity, w);
        sums.fluence[c] = hn::Add(sums.fluence[c], arriving);
        if (b.scattered)
            sums.scattered[c] = hn::MulAdd(arriving, phase, sums.scattered[c]);
        if (b.moments)
            for (int m = 0; m < kShMoments; ++m) {
                float* const to = sums.moments[3 * m + c];
                hn::StoreU(hn::MulAdd(arriving, hn::Set(d, s.basis[m]), hn::LoadU(d, to)), d, to);
            }
    }
}

// Extinction around a node, averaged with the mass matrix's weights.
float extinction_around(const NearBrick& b, int at) {
    float sigma = 0.0f;
    constexpr float weight[3] = {1.0f / 6.0f, 2.0f / 3.0f, 1.0f / 6.0f};
    for (int k = 0; k < 27; ++k)
        sigma += weight[k / 9] * weight[k / 3 % 3] * weight[k % 3] *
                 b.extinction[at + ((k / 9 - 1) * b.wide + k / 3 % 3 - 1) * b.wide + k % 3 - 1];
    return sigma;
}

// Whether a node sees those beside it, in the order of FlatStencil::beside.
using SeenBeside = std::array<bool, 6>;

SeenBeside seen_beside(const FlatStencil& stencil, const NearBrick& b, int node) {
    SeenBeside out;
    out.fill(true);
    for (std::size_t k = 0; b.seen && k < out.size(); ++k)
        if (stencil.beside[k] >= 0) {
            const std::size_t row = std::size_t(node / 8) * stencil.separations.size();
            out[k] = (b.seen[row + std::size_t(stencil.beside[k])] >> (node % 8) & 1) != 0;
        }
    return out;
}

// A node, by its index in the brick's box and what it sees beside it.
struct SelfNode {
    int at;
    SeenBeside sees;
};

// Derivative of a plane of the brick's box at a node, by differences of the nodes beside it that it sees [1/m].
vec3 gradient(const NearField& field, const NearBrick& b, const float* plane, const SelfNode& n) {
    const int stride[3] = {b.wide * b.wide, b.wide, 1};
    vec3 change;
    for (int a = 0; a < 3; ++a) {
        const bool down = n.sees[std::size_t(2 * a)], up = n.sees[std::size_t(2 * a + 1)];
        const float difference = plane[n.at + (up ? stride[a] : 0)] - plane[n.at - (down ? stride[a] : 0)];
        change[a] = up && down ? 0.5f * difference : difference;
    }
    return change * field.index_from_local();
}

// Indices of x, y and z in sh_basis.
constexpr int kAxisMoment[3] = {2, 0, 1};

// One colour of the light that a node receives from itself, through the direction of that light and its change across
// the node.
struct SelfLight {
    float fluence;
    vec3 flux;
    float degree2[kShMoments - 3];
};

SelfLight self_light(const NearField& field, const NearField::SelfKernels& kernels, const NearBrick& b,
                     const SelfNode& n, int c) {
    const int at = n.at;
    SelfLight self{b.intensity[c * b.plane + at] * kernels.light, vec3(0.0f), {}};
    if (!b.scattered && !b.moments)
        return self;
    self.flux = -kernels.flux * gradient(field, b, b.intensity + c * b.plane, n);
    // The flux cannot exceed the fluence. At the edge of a fire a difference of nodes is no derivative.
    self.flux *= std::min(1.0f, self.fluence / std::max(glm::length(self.flux), 1e-37f));
    if (!b.directional)
        return self;
    for (int a = 0; a < 3; ++a) {
        // The mean of cos^2 over the sphere is a third.
        const float* slope = b.directional + (3 * kAxisMoment[a] + c) * b.plane;
        self.flux[a] += kernels.light * kSh1 / 3.0f * slope[at];
        self.fluence -= kernels.flux * kSh1 * gradient(field, b, slope, n)[a];
    }
    for (int m = 3; m < kShMoments; ++m)
        self.degree2[m - 3] = kernels.light / (4.0f * kPi) * b.directional[(3 * m + c) * b.plane + at];
    return self;
}

void add_self(const NearField& field, const FlatStencil& stencil, const NearBrick& b, int at, int node) {
    const NearField::SelfKernels kernels = field.self_kernels(extinction_around(b, at));
    const SelfNode n{at, seen_beside(stencil, b, node)};
    const float g = b.mean_cosine;
    for (int c = 0; c < 3; ++c) {
        const SelfLight self = self_light(field, kernels, b, n, c);
        b.fluence[c * b.out_plane + node] += self.fluence;
        if (b.scattered) {
            const vec3& out = b.toward_camera[node];
            const auto basis = sh_basis(out);
            float sum = (self.fluence + 3.0f * g * glm::dot(self.flux, out)) / (4.0f * kPi);
            for (int m = 3; m < kShMoments; ++m)
                sum += sh_phase_factor(m, g) * self.degree2[m - 3] * basis[m];
            b.scattered[c * b.out_plane + node] += sum;
        }
        if (!b.moments)
            continue;
        for (int a = 0; a < 3; ++a)
            b.moments[(3 * kAxisMoment[a] + c) * b.out_plane + node] += kSh1 * self.flux[a];
        for (int m = 3; m < kShMoments; ++m)
            b.moments[(3 * m + c) * b.out_plane + node] += self.degree2[m - 3];
    }
}

void near_brick(const NearField& field, const FlatStencil& stencil, const NearBrick& b) {
    const D d;
    const int lanes = static_cast<int>(hn::Lanes(d));
    for (int x = 0; x < 8; ++x)
        for (int y = 0; y < 8; ++y) {
            const int row = ((x + b.margin) * b.wide + y + b.margin) * b.wide + b.margin;
            for (int z = 0; z < 8; z += lanes) {
                const int node = x * 64 + y * 8 + z;
                HWY_ALIGN float direction[3][8] = {};
                for (int i = 0; b.toward_camera && i < lanes; ++i)
                    for (int a = 0; a < 3; ++a)
                        direction[a][i] = b.toward_camera[node + i][a];
                const V camera[3] = {hn::Load(d, direction[0]), hn::Load(d, direction[1]), hn::Load(d, direction[2])};
                Sums sums;
                for (int c = 0; c < 3; ++c)
                    sums.fluence[c] = sums.scattered[c] = hn::Zero(d);
                const std::size_t first = std::size_t(x * 8 + y) * stencil.separations.size();
                for (std::size_t i = 0; i < stencil.separations.size(); ++i) {
                    const std::uint8_t seen =
                        b.seen && b.seen[first + i] != kAllOfRow ? std::uint8_t(b.seen[first + i] >> z) : kAllOfRow;
                    add_separation(d, stencil, stencil.separations[i], b, row + z, seen, camera, sums);
                }
                for (int c = 0; c < 3; ++c) {
                    float* to = b.fluence + c * b.out_plane + node;
                    hn::StoreU(hn::Add(hn::LoadU(d, to), sums.fluence[c]), d, to);
                    if (!b.scattered)
                        continue;
                    to = b.scattered + c * b.out_plane + node;
                    hn::StoreU(hn::Add(hn::LoadU(d, to), sums.scattered[c]), d, to);
                }
                for (int m = 0; b.moments && m < 3 * kShMoments; ++m) {
                    float* const to = b.moments + m * b.out_plane + node;
                    hn::StoreU(hn::Add(hn::LoadU(d, to), hn::LoadU(d, sums.moments[m])), d, to);
                }
            }
            for (int z = 0; z < 8; ++z)
                add_self(field, stencil, b, row + z, x * 64 + y * 8 + z);
        }
}

}  // namespace HWY_NAMESPACE
}  // namespace brisance
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace brisance {

HWY_EXPORT(near_brick);

FlatStencil flatten(const NearField& field, int wide) {
    const auto flat = [&](const ivec3& o) { return (o.x * wide + o.y) * wide + o.z; };
    FlatStencil stencil;
    for (const NearField::Separation& s : field.stencil()) {
        FlatSeparation f{flat(s.node), s.kernel, s.direction, {}, static_cast<int>(stencil.taps.size()), 0};
        const auto basis = sh_basis(s.direction);
        std::copy(basis.begin(), basis.end(), f.basis);
        for (const NearField::Tap& t : s.taps)
            stencil.taps.push_back({flat(t.node), t.length});
        f.last_tap = static_cast<int>(stencil.taps.size());
        stencil.separations.push_back(f);
    }
    stencil.beside.fill(-1);
    for (std::size_t i = 0; i < field.stencil().size(); ++i)
        for (int k = 0; k < 6; ++k) {
            ivec3 step(0);
            step[k / 2] = k % 2 == 0 ? -1 : 1;
            if (field.stencil()[i].node == step)
                stencil.beside[std::size_t(k)] = int(i);
        }
    return stencil;
}

void gather_near(const NearField& field, const FlatStencil& stencil, const NearBrick& brick) {
    HWY_DYNAMIC_DISPATCH(near_brick)(field, stencil, brick);
}

}  // namespace brisance
#endif
