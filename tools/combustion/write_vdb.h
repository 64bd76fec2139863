// One frame to one .vdb file. The only file here that OpenVDB enters is write_vdb.cpp.
#pragma once

#include <filesystem>
#include <string>

#include "simulation.h"

namespace brisance::combustion {

struct WriteSettings {
    bool half = false;                     // 16-bit floats
    bool velocity = true;                  // write the velocity grid, "vel" [m/s]
    float density_threshold = 0.004f;      // where neither density
    float gas_threshold = 0.02f;           // nor the share of the burst's gas reaches this, no grid stores anything
    float temperature_threshold = 320.0f;  // nor any temperature below [K]
    float flame_threshold = 0.01f;
    std::string creator;  // file-level metadata
};

// Throws Error CannotCreate or OutputFailed.
void write_vdb(const Simulation& simulation, const WriteSettings& settings, const std::filesystem::path& file);

}  // namespace brisance::combustion
