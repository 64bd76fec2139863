// A two-dimensional filter for noisy pictures, as compositing applies one: it knows the picture, its variance, alpha
// and depth, and nothing of the scene. A baseline, biased: what it takes for noise is spread over neighbouring pixels.
//
// The weight of a pair of pixels is that of non-local means with known noise (A. Buades, B. Coll, J.-M. Morel, A
// Non-Local Algorithm for Image Denoising, CVPR 2005; F. Rousselle, C. Knaus, M. Zwicker, Adaptive Rendering with
// Non-Local Means Filtering, SIGGRAPH Asia 2012), times Gaussians of the differences in alpha and depth:
//   d2_pq = mean over channels and a patch of ((u_p - u_q)^2 - (v_p + v_q)) / (epsilon + k^2 (v_p + v_q))
//   w_pq  = exp(-max(0, d2_pq)) exp(-(alpha_p - alpha_q)^2 / s_alpha^2) exp(-((z_p - z_q) / (s_z min(z_p, z_q)))^2)
// with the picture u and its variance v, averaged over 3^2 pixels. Here, other than there, all of this is symmetric,
// and pixels exchange light:
//   u'_p = u_p + sum_q w_pq / max(W_p, W_q) (u_q - u_p),   W_p = sum_q w_pq.
// So the sum of every layer is kept exactly, a constant stays constant, and no value leaves the range of its
// neighbours. All layers share the weights: cells still add up to the picture.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "film/image.h"

namespace brisance {

class NoiseFilter {
public:
    // `picture`: the beauty, with layers "variance" and "Z". Pixels up to `radius` rows and columns apart (at least 1)
    // exchange light.
    NoiseFilter(const Image& picture, int radius);

    // Filters all layers of colours but "albedo", in pictures of the same size. Of "variance", which belongs to
    // independent pixels, it makes that of the filtered pixels under fixed weights.
    void apply(std::span<Image* const> pictures) const;

private:
    struct Offset {
        int x, y;
    };
    // Working memory of one row.
    struct Row {
        std::vector<float> distance, pairs, weight;
    };
    void add_distances(const Offset& offset, int row, Row& out) const;
    // w of the pixels of a row with those at the offset, 0 beyond the picture.
    void find_weights(const Offset& offset, int row, Row& out) const;
    // Calls `take` for all offsets, with the index of each row's first pixel and that pixel's partner; rows in
    // parallel.
    template <class Take>
    void for_each_offset(const Take& take) const;

    int width_, height_, radius_;
    float epsilon_;
    std::vector<float> colour_, variance_;  // three per pixel
    std::vector<float> alpha_, depth_;
    std::vector<float> sum_;  // W
};

}  // namespace brisance
