// How fast this machine is, for forecasts that are in seconds of one core of another (costs.h).
#pragma once

namespace brisance {

// Such core seconds that all threads do in a second of wall time: times a small kernel like those that march shadows,
// some 10 ms. The fastest of several runs counts, since other programs only make it slower. Near the number of cores.
double machine_speed();

}  // namespace brisance
