#include "medium/similar_medium.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace brisance {

namespace {

// Optical depth of a voxel at most: in the skin of smoke, where isothermal half-spaces then come out right to 3 %; and
// below the skin, where light has long forgotten where it came from, and walls are to stay walls.
constexpr float kSkinDepth = 2.0f, kMostDepth = 4.0f;
constexpr float kSteepest = 4.0f;  // a voxel's extinction over that of its thinnest neighbour, once above kSkinDepth
constexpr double kMostAbsorption = 0.05;  // share of extinction beyond which absorption is no longer raised

// Mean cosine of backward scattering at least: of a ball of optical radius 2, pictures of g = -0.9 and -0.999 are then
// right to 2 and 3 %, and without to 13 and 180 %. Moments stop at degree 2, which light scattered once does not mind.
constexpr double kSharpestOfAllOrders = -0.7, kSharpest = -0.8;

// What a node becomes.
struct Similar {
    double extinction;
    dvec3 albedo;
    dvec3 source_factor;  // of the thermal source function
    dvec3 emission_factor;
};

// Forward scattering taken out. The share is that of the colour that scatters least, so that no albedo turns negative.
Similar without_forward(double extinction, const dvec3& albedo, double share) {
    const double left = 1.0 - std::min({albedo.x, albedo.y, albedo.z}) * share;
    return {extinction * left, dvec3(1.0) - (dvec3(1.0) - albedo) / left, dvec3(1.0 / left), dvec3(1.0)};
}

// The same for light that is scattered once: the peak is followed by itself and leaves the rest as it is.
Similar without_peak(double extinction, const dvec3& albedo, double share) {
    return {extinction, albedo * (1.0 - share), dvec3(1.0), dvec3(1.0)};
}

// Extinction at most at every node [1/m].
std::vector<float> limits(const Medium& medium) {
    constexpr int kWide = BrickLattice::kSize + 2;
    const float skin = kSkinDepth / medium.spacing, most = kMostDepth / medium.spacing;
    std::vector<float> limit(medium.extinction.size());
    parallel_for(medium.lattice.brick_count(), [&](std::size_t b) {
        std::vector<float> box(kWide * kWide * kWide);
        copy_box(medium.lattice, medium.extinction, 1, medium.lattice.first_node(b) - 1, ivec3(kWide), box);
        for (int n = 0; n < BrickLattice::kNodes; ++n) {
            const ivec3 p = BrickLattice::node_in_brick(n);
            float least = most;
            for (int k = 0; k < 27; ++k)
                least = std::min(least, box[((p.x + k / 9) * kWide + p.y + k / 3 % 3) * kWide + p.z + k % 3]);
            limit[b * BrickLattice::kNodes + n] = std::clamp(kSteepest * least, skin, most);
        }
    });
    return limit;
}

// Of an isothermal half-space that absorbs this share of its extinction, over 4/sqrt(3): flux over pi times its source.
// Fits Chandrasekhar's solution to 1 %; diffusion gives the square root alone.
double emissivity(double absorbed) {
    const double root = std::sqrt(absorbed);
    return root / (1.0 + 1.26 * root);
}

void hold_down(Similar& s, double most) {
    const double x = s.extinction / most;
    if (!(x > 1.0))
        return;
    for (int c = 0; c < 3; ++c) {
        const double absorbed = 1.0 - s.albedo[c];
        const double raised = std::clamp(x * x * absorbed, absorbed, std::max(absorbed, kMostAbsorption));
        // j' / j, which is also (sigma' S') / (sigma S).
        const double gain = absorbed > 0.0 ? raised / absorbed * emissivity(absorbed) / emissivity(raised) / x : 1.0;
        s.albedo[c] = 1.0 - raised;
        s.source_factor[c] *= gain * x;
        s.emission_factor[c] *= gain;
    }
    s.extinction = most;
}

}  // namespace

float forward_share(float mean_cosine) {
    const float t = std::clamp((mean_cosine - 0.5f) / 0.35f, 0.0f, 1.0f);
    return mean_cosine * mean_cosine * mean_cosine * t * t * (3.0f - 2.0f * t);
}

float forward_left_out(float mean_cosine, int bounces) {
    return bounces == 1 ? forward_share(mean_cosine) : 0.0f;
}

std::optional<Medium> similar_medium(const Medium& medium, int bounces) {
    const bool all_orders = bounces < 0;
    const double share = all_orders ? forward_share(medium.mean_cosine) : forward_left_out(medium.mean_cosine, bounces);
    const double sharpest = all_orders ? kSharpestOfAllOrders : kSharpest;
    if (share == 0.0 && medium.mean_cosine >= sharpest && medium.max_extinction * medium.spacing <= kSkinDepth)
        return std::nullopt;
    Medium m = medium;
    m.mean_cosine = static_cast<float>(std::max((medium.mean_cosine - share) / (1.0 - share), sharpest));
    m.albedo_nodes.resize(m.extinction.size());
    const std::vector<float> limit = limits(medium);
    parallel_for(
        m.extinction.size(),
        [&](std::size_t i) {
            Similar s =
                (all_orders ? without_forward : without_peak)(medium.extinction[i], dvec3(medium.albedo_at(i)), share);
            hold_down(s, limit[i]);
            m.extinction[i] = static_cast<float>(s.extinction);
            m.albedo_nodes[i] = Rgb(s.albedo);
            if (!m.source.empty())
                m.source[i] = Rgb(dvec3(m.source[i]) * s.source_factor);
            if (!m.emission.empty())
                m.emission[i] = Rgb(dvec3(m.emission[i]) * s.emission_factor);
        },
        4096);
    m.max_extinction = *std::max_element(m.extinction.begin(), m.extinction.end());
    return m;
}

}  // namespace brisance
