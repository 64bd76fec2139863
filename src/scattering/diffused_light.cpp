#include "scattering/diffused_light.h"

#include "lighting_grid/voxel_lights.h"
#include "medium/coarse_medium.h"

namespace brisance {

DiffusedLight diffused_light(const ExtinctionPyramid& fine, int level, const ScatteredLight& once,
                             const DiffusionSettings& settings) {
    const Medium medium = coarse_medium(fine, level);
    ExtinctionPyramid pyramid(medium, 1);
    pyramid.set_occluders(fine.occluders());
    const ScatteredLight source = restricted(once, fine.medium().lattice, level);
    const std::vector<Rgb> unit =
        project_extinction_times(medium, std::vector<Rgb>(medium.extinction.size(), Rgb(1.0f)));
    std::vector<std::uint8_t> smoke(unit.size());  // in the hat of a node
    DiffusedLight out;
    for (std::size_t i = 0; i < smoke.size(); ++i)
        out.nodes += smoke[i] = unit[i].x > 0.0f;

    Diffusion diffusion(pyramid, settings);
    const Gathered arriving = diffusion.solve(source.intensity, source.directional);
    out.counts = diffusion.counts();
    out.bytes = medium.bytes() + pyramid.bytes() + diffusion.bytes();
    ScatteredLight light = scattered_light(medium, arriving, smoke);
    light.source = scattered_source(medium, arriving, smoke);
    out.light = spread_to_fine(light, {medium.lattice, level, smoke}, fine.medium());
    return out;
}

}  // namespace brisance
