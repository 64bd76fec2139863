#include "write_vdb.h"

#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/Prune.h>

#include "core/error.h"

namespace brisance::combustion {

namespace {

// Whether there is smoke or a notable share of hot gas.
bool is_stored(const vec4& cell, const WriteSettings& settings) {
    return cell[Soot] >= settings.density_threshold || cell[Gas] >= settings.gas_threshold;
}

// Index (0, 0, 0) is the cell whose low corner is the world's origin, and an index's world position is its cell's
// centre.
openvdb::math::Transform::Ptr cell_transform(float h) {
    auto transform = openvdb::math::Transform::createLinearTransform(h);
    transform->postTranslate(openvdb::Vec3d(0.5 * h));
    return transform;
}

openvdb::CoordBBox index_box(const ivec3& cells) {
    const openvdb::Coord low(-cells.x / 2, -cells.y / 2, 0);
    return {low, low.offsetBy(cells.x - 1, cells.y - 1, cells.z - 1)};
}

template <class GridType>
typename GridType::Ptr make_grid(
    const Simulation& simulation, const WriteSettings& settings, const char* name,
    const openvdb::tools::Dense<typename GridType::ValueType, openvdb::tools::LayoutXYZ>& dense) {
    auto grid = GridType::create();
    openvdb::tools::copyFromDense(dense, grid->tree(), typename GridType::ValueType(0.0f));
    openvdb::tools::prune(grid->tree());
    grid->setName(name);
    grid->setTransform(cell_transform(simulation.cell_size()));
    grid->setSaveFloatAsHalf(settings.half);
    return grid;
}

template <class Value>
openvdb::FloatGrid::Ptr scalar_grid(const Simulation& simulation, const WriteSettings& settings, const char* name,
                                    float threshold, const Value& value_of) {
    const Mixture& mixture = simulation.mixture();
    std::vector<float> values(mixture.values.size());
    for (std::size_t c = 0; c < values.size(); ++c) {
        const vec4& cell = mixture.values[c];
        const float v = is_stored(cell, settings) ? value_of(cell) : 0.0f;
        values[c] = v < threshold ? 0.0f : v;
    }
    const openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(index_box(simulation.cells()), values.data());
    auto grid = make_grid<openvdb::FloatGrid>(simulation, settings, name, dense);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    return grid;
}

// At the cell centres, as Houdini names it: in world units a second, not in voxels, and not a step's displacement.
openvdb::Vec3SGrid::Ptr velocity_grid(const Simulation& simulation, const WriteSettings& settings) {
    const Mixture& mixture = simulation.mixture();
    const Field<vec4> centred = centred_velocity(simulation.velocity(), simulation.cells(), 1.0f);
    std::vector<openvdb::Vec3s> values(centred.values.size());
    for (std::size_t c = 0; c < values.size(); ++c) {
        const vec4& u = centred.values[c];
        if (is_stored(mixture.values[c], settings))
            values[c] = openvdb::Vec3s(u.x, u.y, u.z);
    }
    const openvdb::tools::Dense<openvdb::Vec3s, openvdb::tools::LayoutXYZ> dense(index_box(simulation.cells()),
                                                                                 values.data());
    auto grid = make_grid<openvdb::Vec3SGrid>(simulation, settings, "vel", dense);
    grid->setGridClass(openvdb::GRID_UNKNOWN);
    grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);  // turns and scales with the grid's transform
    grid->insertMeta("unit", openvdb::StringMetadata("m/s"));
    return grid;
}

}  // namespace

void write_vdb(const Simulation& simulation, const WriteSettings& settings, const std::filesystem::path& file) {
    openvdb::initialize();
    openvdb::GridPtrVec grids;
    grids.push_back(scalar_grid(simulation, settings, "density", settings.density_threshold,
                                [](const vec4& cell) { return cell[Soot]; }));
    grids.push_back(scalar_grid(simulation, settings, "temperature", settings.temperature_threshold,
                                [&](const vec4& cell) { return simulation.temperature(cell); }));
    grids.push_back(scalar_grid(simulation, settings, "flame", settings.flame_threshold,
                                [&](const vec4& cell) { return simulation.flame(cell); }));
    if (settings.velocity)
        grids.push_back(velocity_grid(simulation, settings));
    openvdb::MetaMap metadata;
    metadata.insertMeta("creator", openvdb::StringMetadata(settings.creator));
    metadata.insertMeta("time", openvdb::DoubleMetadata(simulation.time()));
    metadata.insertMeta("frames_per_second", openvdb::DoubleMetadata(simulation.frame_rate()));
    std::error_code failure;
    if (!file.parent_path().empty())
        std::filesystem::create_directories(file.parent_path(), failure);
    if (failure)
        throw Error(ExitCode::CannotCreate, file.parent_path().string() + ": " + failure.message());
    try {
        openvdb::io::File out(file.string());
        out.write(grids, metadata);
        out.close();
    } catch (const openvdb::Exception& e) {
        throw Error(ExitCode::OutputFailed, file.string() + ": " + e.what());
    }
}

}  // namespace brisance::combustion
