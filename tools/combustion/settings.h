// Everything the burst depends on. Two runs with equal settings give equal grids, whatever the thread count.
#pragma once

#include <cstdint>

namespace brisance::combustion {

struct Settings {
    int resolution = 96;         // voxels across the domain; rounded up to a multiple of 16
    std::uint32_t seed = 1;      // of the puffs and of the turbulence
    float width = 16.0f;         // of the domain, along both horizontal axes [m]
    float height_ratio = 1.25f;  // domain height over its width
    float frame_rate = 24.0f;    // [1/s]
    float courant = 2.0f;        // most cells crossed in one step
    int steps_per_frame_max = 6;
    int substeps = 1;  // states at equal distances that a frame is made of; steps end at each of them

    // Burst
    int puffs = 22;
    float burst_radius = 1.2f;     // of the area the puffs start in [m]
    float burst_duration = 0.16f;  // from the first puff to the last [s]
    float burst_speed = 16.0f;     // of a puff's gas as it enters [m/s]

    // Reaction
    float ambient_temperature = 293.0f;    // [K]
    float ignition_temperature = 1300.0f;  // of the fuel as it enters [K]
    float maximum_temperature = 2300.0f;   // no gas is hotter [K]
    float heat_per_fuel = 2200.0f;         // temperature won by burning all of a cell's fuel [K]
    float burn_time = 0.5f;                // mean time a parcel of fuel takes to burn [s]
    float expansion_per_fuel = 2.0f;       // logarithm of the volume ratio besides heating, hotter than physical
    float contraction = 0.0f;              // share of the shrinking by cooling that is kept, for volume on screen
    float soot_per_fuel = 5.0f;            // density won by burning all of a cell's fuel, before dilution

    // Cooling
    float radiative_cooling = 8000.0f;  // at maximum temperature with nothing in the way [K/s]
    float soot_absorption = 3.0f;       // of heat by density 1 [1/m]
    float mixing_time = 0.7f;           // in which air drawn into a cell takes on the gas's heat [s]

    // Motion
    float gravity = 9.81f;           // [m/s^2]
    float buoyancy = 2.6f;           // gain on the weight difference
    float confinement = 4.5f;        // vorticity confinement [1]
    float turbulence = 65.0f;        // acceleration by curl noise in hot gas [m/s^2]
    float turbulence_length = 1.6f;  // of its largest eddies [m]
    float soot_dissipation = 0.02f;  // [1/s]
};

}  // namespace brisance::combustion
