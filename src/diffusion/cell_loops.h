// Loops over the cells of a lattice, in blocks that do not depend on the number of threads.
#pragma once

#include <vector>

#include "core/parallel.h"

namespace brisance {

constexpr std::size_t kCellsAtOnce = 8192;

template <class Body>
void over_cells(std::size_t cells, const Body& body) {
    parallel_blocks(cells, kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            body(i);
    });
}

// Sum over all cells of term(i).
template <class Term>
double sum_over(std::size_t cells, const Term& term) {
    std::vector<double> parts((cells + kCellsAtOnce - 1) / kCellsAtOnce, 0.0);
    parallel_blocks(cells, kCellsAtOnce, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t i = begin; i < end; ++i)
            sum += term(i);
        parts[begin / kCellsAtOnce] = sum;
    });
    double sum = 0.0;
    for (const double p : parts)
        sum += p;
    return sum;
}

}  // namespace brisance
