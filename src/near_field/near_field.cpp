#include "near_field/near_field.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "medium/lattice/brick_masks.h"
#include "medium/phase.h"
#include "medium/sh.h"
#include "near_field/lines_of_sight.h"
#include "near_field/near_kernels.h"
#include "near_field/separation_depth.h"

namespace brisance {

namespace {

constexpr int kMaxMargin = 24;  // nodes; without it, a lattice of needles would need an endless stencil
constexpr int kSelfEntries = 129;

// Returns the line integral from node 0 to node o as coefficients of the nodes' values.
std::vector<NearField::Tap> line_taps(const ivec3& o, double metres) {
    std::vector<NearField::Tap> list;
    for (const auto& [node, share] : line_shares(dvec3(o)))
        list.push_back({node, static_cast<float>(share * metres)});
    return list;
}

// Integral of r^power exp(-s r) exp(-r^2 / w^2) over r >= 0, by Simpson's rule on the scale that decays first.
double windowed_integral(int power, double s, double w) {
    const double reach = std::min(6.0 * w, s > 0.0 ? 40.0 / s : 1e300);
    constexpr int n = 400;
    const double step = reach / n;
    double sum = 0.0;
    for (int i = 0; i <= n; ++i) {
        const double r = i * step;
        const double weight = i == 0 || i == n ? 1.0 : (i % 2 ? 4.0 : 2.0);
        sum += weight * (power == 0 ? 1.0 : r) * std::exp(-s * r - r * r / (w * w));
    }
    return sum * step / 3.0;
}

// kappa and kappa_1 of a voxel far from cubic are the means over the ball of the voxel's volume, seen from its centre.
// The exact lattice correction would need a window over the longest edge.
NearField::SelfKernels ball_self_kernels(double s, double volume) {
    const double a = std::cbrt(3.0 * volume / (4.0 * kPi));
    const double tau = s * a, shell = 4.0 * kPi / volume;
    const double light = tau > 1e-8 ? -std::expm1(-tau) / tau : 1.0;
    const double flux = tau > 1e-3 ? (-std::expm1(-tau) - tau * std::exp(-tau)) / (tau * tau) : 0.5 - tau / 3.0;
    return {float(shell * a * light), float(shell * a * a * flux / 3.0)};
}

}  // namespace

NearField::NearField(const mat3& local_from_index, float radius, bool shadows)
    : local_from_index_(local_from_index),
      index_from_local_(glm::inverse(local_from_index)),
      spacing_(std::cbrt(std::abs(glm::determinant(local_from_index)))),
      shadows_(shadows) {
    const mat3 inverse = glm::transpose(index_from_local_);
    ivec3 reach;
    for (int a = 0; a < 3; ++a)
        reach[a] = std::min(kMaxMargin, static_cast<int>(2.0f * radius * glm::length(inverse[a])));
    for (int x = -reach.x; x <= reach.x; ++x)
        for (int y = -reach.y; y <= reach.y; ++y)
            for (int z = -reach.z; z <= reach.z; ++z) {
                const ivec3 o(x, y, z);
                const vec3 offset = local_from_index * vec3(o);
                const float d = glm::length(offset);
                if (o == ivec3(0) || d >= 2.0f * radius)
                    continue;
                const float blend = std::min(1.0f, 2.0f - d / radius);
                stencil_.push_back({o, blend / (d * d), -offset / d, shadows ? line_taps(o, d) : std::vector<Tap>{}});
                margin_ = std::max({margin_, std::abs(x), std::abs(y), std::abs(z)});
            }
    tabulate_self_kernel();
}

namespace {

// The lattice's nodes at one distance from a node.
struct Shell {
    double distance;  // [m]
    double nodes;
};

// The lattice corrections by a Gaussian window w: K = w K + (1 - w) K. The part (1 - w) K is smooth, so the lattice
// sums it without error. Its value at the origin is included: 1 / window^2 for 1/r^2, and 0 for 1/r.
NearField::SelfKernels windowed_self_kernels(double s, double window, double volume, const std::vector<Shell>& shells) {
    double light = 4.0 * kPi * windowed_integral(0, s, window) / volume + 1.0 / (window * window);
    double flux = 4.0 * kPi * windowed_integral(1, s, window) / volume;
    for (const auto& [d, nodes] : shells) {
        const double w = nodes * std::exp(-s * d - d * d / (window * window));
        light -= w / (d * d);
        flux -= w / d;
    }
    return {float(light), float(flux / 3.0)};
}

// Corrections for extinction so strong that it serves as the window.
NearField::SelfKernels direct_self_kernels(double s, double volume, const std::vector<Shell>& shells) {
    double light = 4.0 * kPi / (s * volume), flux = 4.0 * kPi / (s * s * volume);
    for (const auto& [d, nodes] : shells) {
        const double w = nodes * std::exp(-s * d);
        light -= w / (d * d);
        flux -= w / d;
    }
    return {float(light), float(flux / 3.0)};
}

// All lattice nodes but the origin within `reach` [m]. A cubic lattice has 65,000 of them within 25 voxels, at 500
// distances.
std::vector<Shell> node_shells(const dmat3& local_from_index, double reach) {
    const dmat3 inverse = glm::transpose(glm::inverse(local_from_index));
    ivec3 nodes;
    for (int a = 0; a < 3; ++a)
        nodes[a] = static_cast<int>(reach * glm::length(inverse[a]));
    std::vector<double> distances;
    for (int x = -nodes.x; x <= nodes.x; ++x)
        for (int y = -nodes.y; y <= nodes.y; ++y)
            for (int z = -nodes.z; z <= nodes.z; ++z) {
                const double d = glm::length(local_from_index * dvec3(x, y, z));
                if (d > 0.0 && d < reach)
                    distances.push_back(d);
            }
    std::sort(distances.begin(), distances.end());
    constexpr double kSame = 1.0 + 1e-6;  // rounding of the lattice's vectors parts what is one distance
    std::vector<Shell> shells;
    for (const double d : distances) {
        if (shells.empty() || d > shells.back().distance * kSame)
            shells.push_back({d, 0.0});
        shells.back().nodes += 1.0;
    }
    return shells;
}

}  // namespace

void NearField::tabulate_self_kernel() {
    const double h = spacing_, volume = h * h * h;
    double longest = 0.0;
    for (int a = 0; a < 3; ++a)
        longest = std::max(longest, double(glm::length(local_from_index_[a])));
    const bool nearly_cubic = longest < 3.0 * h;
    const double window = 5.0 * longest;
    const std::vector<Shell> shells =
        nearly_cubic ? node_shells(dmat3(local_from_index_), 5.0 * window) : std::vector<Shell>{};
    self_.resize(kSelfEntries);
    parallel_for(kSelfEntries, [&](std::size_t i) {
        const double u = std::min(double(i) / (kSelfEntries - 1), 0.9999);
        const double s = u / (1.0 - u) / h;
        const SelfKernels k = !nearly_cubic       ? ball_self_kernels(s, volume)
                              : s * longest < 0.7 ? windowed_self_kernels(s, window, volume, shells)
                                                  : direct_self_kernels(s, volume, shells);
        const double x = 1.0 + s * h;
        self_[i] = {float(k.light * h * h * x), float(k.flux * h * x * x)};
    });
}

NearField::SelfKernels NearField::self_kernels(float s) const {
    const float x = shadows_ ? s * spacing_ : 0.0f;
    const float u = x / (1.0f + x) * (kSelfEntries - 1);
    const int i = std::min(static_cast<int>(u), kSelfEntries - 2);
    const auto between = [&](float SelfKernels::*k) { return self_[i].*k + (u - i) * (self_[i + 1].*k - self_[i].*k); };
    const float h = spacing_, one = 1.0f + x;
    return {between(&SelfKernels::light) / (h * h * one), between(&SelfKernels::flux) / (h * one * one)};
}

struct NearField::Sight {
    LinesOfSight lines;
    LinesOfSight::Stencil stencil;
};

NearField::Sight NearField::sight_past(const Input& in) const {
    std::vector<ivec3> separations;
    for (const Separation& s : stencil_)
        separations.push_back(s.node);
    return {LinesOfSight(*in.occluders, local_from_index_, in.reference_node), LinesOfSight::Stencil(separations)};
}

void NearField::gather(const Input& in, Gathered& out) const {
    const BrickLattice& lattice = *in.lattice;
    const int wide = BrickLattice::kSize + 2 * margin_;
    const std::size_t plane = std::size_t(wide) * wide * wide;
    const std::size_t nodes = lattice.node_count();
    const auto flat = [](const std::vector<Rgb>& v) {
        return std::span<const float>(reinterpret_cast<const float*>(v.data()), v.size() * 3);
    };
    const FlatStencil stencil = flatten(*this, wide);
    const std::optional<Sight> sight = in.occluders ? std::optional<Sight>(sight_past(in)) : std::nullopt;
    parallel_for(lattice.brick_count(), [&](std::size_t b) {
        if (in.needed && !any_in_brick(*in.needed, b))
            return;
        thread_local std::vector<float> extinction, intensity, directional;
        thread_local std::vector<std::uint8_t> seen;
        std::vector<vec3> toward_camera;
        const ivec3 low = lattice.first_node(b) - margin_;
        intensity.resize(plane * 3);
        copy_box(lattice, flat(*in.intensity), 3, low, ivec3(wide), intensity);
        if (std::all_of(intensity.begin(), intensity.end(), [](float v) { return v == 0.0f; }))
            return;
        extinction.resize(plane);
        copy_box(lattice, *in.extinction, 1, low, ivec3(wide), extinction);
        if (in.directional) {
            directional.resize(plane * 24);
            copy_box(lattice, *in.directional, 24, low, ivec3(wide), directional);
        }
        NearBrick brick{};
        brick.wide = wide;
        brick.margin = margin_;
        brick.plane = plane;
        brick.extinction = extinction.data();
        brick.intensity = intensity.data();
        brick.directional = in.directional ? directional.data() : nullptr;
        for (int k = 0; in.eye && k < BrickLattice::kNodes; ++k) {
            const ivec3 node = lattice.first_node(b) + BrickLattice::node_in_brick(k) - in.reference_node;
            toward_camera.push_back(direction_toward(*in.eye, local_from_index_ * vec3(node)));
        }
        brick.toward_camera = in.eye ? toward_camera.data() : nullptr;
        const bool parted = sight && sight->lines.look(sight->stencil, lattice.first_node(b), seen);
        brick.seen = parted ? seen.data() : nullptr;
        brick.mean_cosine = in.mean_cosine;
        brick.out_plane = nodes;
        brick.fluence = out.fluence.data() + b * BrickLattice::kNodes;
        brick.scattered = out.scattered.empty() ? nullptr : out.scattered.data() + b * BrickLattice::kNodes;
        brick.moments = out.moments.empty() ? nullptr : out.moments.data() + b * BrickLattice::kNodes;
        gather_near(*this, stencil, brick);
    });
}

}  // namespace brisance
