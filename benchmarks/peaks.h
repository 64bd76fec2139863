// What one core can do at most, in the instruction set that kernels take: the roofs that they are held against.
#pragma once

namespace brisance::benchmarks {

// Floating-point operations per second of fused multiply-adds that wait for nothing; each counts as two.
double peak_flops();

// 32-bit values per second that gather instructions read from a table in the nearest cache.
double peak_gathered();

}  // namespace brisance::benchmarks
