// One path of a picture, for inspection.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/progress.h"
#include "medium/lattice/voxel_walk.h"
#include "reference/path_tracer.h"
#include "shot/shot.h"

namespace brisance {

struct TracedPath {
    Ray ray;                             // of the camera, through the pixel; world space [m]
    PathSum orders{};                    // its radiance by number of scatterings [W/(m^2 sr)]
    bool has_cells = false;              // the same by cell, in `orders.cells`: there are surroundings
    std::uint64_t scatterings = 0;       // followed; more than orders may hold
    std::vector<TracedVertex> vertices;  // in the order they were followed; positions in world space [m]
    bool finite() const;
};

// What the vertex carries and what it gathered.
bool finite(const TracedVertex& vertex);

// The path that method path gives number `sample` in the pixel at (x, y), counted from the top left. The same bits as
// in the picture. Throws Error Usage for a pixel outside of the picture, and as render_frame.
TracedPath trace_path(const Shot& shot, const std::filesystem::path& volume, int frame, int x, int y,
                      std::uint64_t sample, Progress& progress);

}  // namespace brisance
