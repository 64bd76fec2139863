// The ledger of light paths: where the camera's ray ends, and where the light arriving there comes from. Every path
// belongs to one cell, and a picture is the sum of its cells.
#pragma once

#include <array>
#include <cstddef>
#include <initializer_list>

#include "core/vec.h"

namespace brisance {

// V the emitting medium, A emitters that are no medium (and the background), M the scattering medium, S surfaces.
enum class Cell { V, A, MV, MM, MS, MA, SV, SM, SS, SA };

constexpr std::array<const char*, 10> kCellNames = {"V", "A", "MV", "MM", "MS", "MA", "SV", "SM", "SS", "SA"};
constexpr int kCells = static_cast<int>(kCellNames.size());

constexpr const char* name_of(Cell cell) {
    return kCellNames[static_cast<int>(cell)];
}

// Some of the cells.
struct CellSet : std::array<bool, kCells> {
    constexpr CellSet() : array{} {}
    constexpr CellSet(std::initializer_list<Cell> cells) : array{} {
        for (const Cell cell : cells)
            set(cell, true);
    }
    constexpr bool contains(Cell cell) const { return (*this)[static_cast<std::size_t>(cell)]; }
    constexpr void set(Cell cell, bool in) { (*this)[static_cast<std::size_t>(cell)] = in; }
};

// Radiance by cell [W/(m^2 sr)].
struct CellSum : std::array<Rgb, kCells> {
    CellSum() { fill(Rgb(0.0f)); }
    Rgb& at(Cell cell) { return (*this)[static_cast<int>(cell)]; }
    const Rgb& at(Cell cell) const { return (*this)[static_cast<int>(cell)]; }
    void add(const CellSum& other, const Rgb& weight) {
        for (int c = 0; c < kCells; ++c)
            (*this)[c] += weight * other[c];
    }
};

// Of all cells together.
inline float luminance(const CellSum& cells) {
    float sum = 0.0f;
    for (const Rgb& cell : cells)
        sum += luminance(cell);
    return sum;
}

// The cell of light seen from a medium point or a surface point, by what sent it there.
enum class Sender { V, M, S, A };
constexpr Cell cell_of(bool on_surface, Sender sender) {
    constexpr Cell kMedium[] = {Cell::MV, Cell::MM, Cell::MS, Cell::MA};
    constexpr Cell kSurface[] = {Cell::SV, Cell::SM, Cell::SS, Cell::SA};
    return (on_surface ? kSurface : kMedium)[static_cast<int>(sender)];
}

}  // namespace brisance
