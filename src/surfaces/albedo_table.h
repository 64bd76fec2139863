// Numbers tabulated over roughness and angle, as directional albedos of microfacets vary: finer where these change
// fast.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "core/parallel.h"

namespace brisance {

// The first row is that of kSmoothAlpha, the last that of alpha 1.
struct AlbedoLattice {
    static constexpr int kRoughnesses = 48, kAngles = 80, kMeans = 768, kMeanPoints = 256;

    // Where a number lies between two entries of a table: the first of them, and the share of the second.
    struct Place {
        int first;
        double beyond;
    };
    // Among `count` of them, by roughness alone.
    static Place by_roughness(double alpha, int count);
    static Place by_angle(double alpha, double cosine);
    // Of the entry `i` of `count`.
    static double alpha_of(int i, int count);
    // Of the fraction of a row of angles.
    static double cosine_of(double alpha, double fraction);
};

// A row of roughness: a BSDF asks for many cosines of its own.
struct AlbedoRow {
    double alpha = 1.0;
    AlbedoLattice::Place place{};
    AlbedoRow() = default;
    // a >= kSmoothAlpha
    explicit AlbedoRow(double a) : alpha(a), place(AlbedoLattice::by_roughness(a, AlbedoLattice::kRoughnesses)) {}
};

template <std::size_t kNumbers>
class AlbedoTable {
public:
    using Numbers = std::array<double, kNumbers>;

    // `of(alpha, cosine)`: the Numbers there.
    template <class Function>
    explicit AlbedoTable(const Function& of) : entries_(std::size_t(AlbedoLattice::kRoughnesses * kAngles)) {
        parallel_for(entries_.size(), [&](std::size_t i) {
            const double alpha = AlbedoLattice::alpha_of(static_cast<int>(i) / kAngles, AlbedoLattice::kRoughnesses);
            const double along = double(static_cast<int>(i) % kAngles) / (kAngles - 1);
            const Numbers numbers = of(alpha, AlbedoLattice::cosine_of(alpha, along));
            std::copy(numbers.begin(), numbers.end(), entries_[i].begin());
        });
    }

    // In double precision: what is lost is a small difference from 1.
    Numbers at(const AlbedoRow& row, double cosine) const {
        const auto [column, along] = AlbedoLattice::by_angle(row.alpha, cosine);
        const Entry* const low = &entries_[std::size_t(row.place.first * kAngles + column)];
        const Entry* const high = low + kAngles;
        const double above = row.place.beyond;
        Numbers sum;
        for (std::size_t i = 0; i < kNumbers; ++i)
            sum[i] = (1.0 - above) * (1.0 - along) * low[0][i] + (1.0 - above) * along * low[1][i] +
                     above * (1.0 - along) * high[0][i] + above * along * high[1][i];
        return sum;
    }

private:
    using Entry = std::array<float, kNumbers>;
    static constexpr int kAngles = AlbedoLattice::kAngles;
    std::vector<Entry> entries_;  // [roughness][angle]
};

// Means over the hemisphere, weighted by the cosine.
template <std::size_t kNumbers>
class AlbedoMeans {
public:
    using Numbers = std::array<double, kNumbers>;

    // `of(row, cosine)`: the Numbers there. Of the interpolated table, not of the exact integrals: errors of
    // interpolation then cancel over directions.
    template <class Function>
    explicit AlbedoMeans(const Function& of) : entries_(AlbedoLattice::kMeans) {
        parallel_for(entries_.size(), [&](std::size_t i) {
            const AlbedoRow row(AlbedoLattice::alpha_of(static_cast<int>(i), AlbedoLattice::kMeans));
            Numbers sum{};
            double from = 0.0;
            for (int k = 0; k < AlbedoLattice::kMeanPoints; ++k) {
                const double to = AlbedoLattice::cosine_of(row.alpha, double(k + 1) / AlbedoLattice::kMeanPoints);
                add(of(row, 0.5 * (from + to)), to * to - from * from, sum);
                from = to;
            }
            std::copy(sum.begin(), sum.end(), entries_[i].begin());
        });
    }

    Numbers of(double alpha) const {
        const auto [first, beyond] = AlbedoLattice::by_roughness(alpha, AlbedoLattice::kMeans);
        Numbers sum{};
        add(entries_[std::size_t(first)], 1.0 - beyond, sum);
        add(entries_[std::size_t(first) + 1], beyond, sum);
        return sum;
    }

private:
    using Entry = std::array<float, kNumbers>;

    template <class From>
    static void add(const From& from, double weight, Numbers& sum) {
        for (std::size_t i = 0; i < kNumbers; ++i)
            sum[i] += weight * from[i];
    }

    std::vector<Entry> entries_;  // [finer roughness]
};

}  // namespace brisance
