#include "make_vdb.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/points/PointConversion.h>

#include <cstring>
#include <fstream>
#include <iterator>

namespace brisance {
namespace {

openvdb::math::Transform::Ptr make_transform(const TestGrid& grid) {
    if (grid.frustum)
        return openvdb::math::Transform::createFrustumTransform(
            openvdb::BBoxd(openvdb::Vec3d(0, 0, 0), openvdb::Vec3d(8, 8, 8)), 0.5, 2.0, 0.1);
    const dmat4& m = grid.world_from_index;
    const bool uniform = m == dmat4(dmat3(m[0][0])) && m[0][0] > 0.0;
    if (uniform)
        return openvdb::math::Transform::createLinearTransform(m[0][0]);
    openvdb::Mat4d matrix;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            matrix(i, j) = m[i][j];
    return openvdb::math::Transform::createLinearTransform(matrix);
}

openvdb::GridClass class_of(TestClass grid_class) {
    switch (grid_class) {
        case TestClass::Fog:
            return openvdb::GRID_FOG_VOLUME;
        case TestClass::LevelSet:
            return openvdb::GRID_LEVEL_SET;
        case TestClass::Staggered:
            return openvdb::GRID_STAGGERED;
        case TestClass::Unknown:
            break;
    }
    return openvdb::GRID_UNKNOWN;
}

template <class Value>
Value convert(const dvec3& value) {
    if constexpr (openvdb::VecTraits<Value>::IsVec) {
        using Element = typename Value::value_type;
        return Value(static_cast<Element>(value.x), static_cast<Element>(value.y), static_cast<Element>(value.z));
    } else {
        return static_cast<Value>(value.x);
    }
}

template <class GridType>
openvdb::GridBase::Ptr make_values(const TestGrid& grid) {
    using Value = typename GridType::ValueType;
    const typename GridType::Ptr result = GridType::create();
    for (const TestTile& tile : grid.tiles)
        result->tree().addTile(static_cast<openvdb::Index>(tile.level),
                               openvdb::Coord(tile.index.x, tile.index.y, tile.index.z), convert<Value>(tile.value),
                               true);
    auto accessor = result->getAccessor();
    for (const TestVoxel& voxel : grid.voxels)
        accessor.setValueOn(openvdb::Coord(voxel.index.x, voxel.index.y, voxel.index.z), convert<Value>(voxel.value));
    return result;
}

openvdb::GridBase::Ptr make_points(const TestGrid& grid) {
    const openvdb::math::Transform::Ptr transform = make_transform(grid);
    std::vector<openvdb::Vec3s> positions;
    for (const TestVoxel& voxel : grid.voxels)
        positions.push_back(
            openvdb::Vec3s(transform->indexToWorld(openvdb::Vec3d(voxel.index.x, voxel.index.y, voxel.index.z))));
    return openvdb::points::createPointDataGrid<openvdb::points::NullCodec, openvdb::points::PointDataGrid>(positions,
                                                                                                            *transform);
}

openvdb::GridBase::Ptr make_grid(const TestGrid& grid) {
    switch (grid.type) {
        case TestType::Float:
            return make_values<openvdb::FloatGrid>(grid);
        case TestType::Double:
            return make_values<openvdb::DoubleGrid>(grid);
        case TestType::Int32:
            return make_values<openvdb::Int32Grid>(grid);
        case TestType::Int64:
            return make_values<openvdb::Int64Grid>(grid);
        case TestType::Bool:
            return make_values<openvdb::BoolGrid>(grid);
        case TestType::Mask:
            return make_values<openvdb::MaskGrid>(grid);
        case TestType::Vec3f:
            return make_values<openvdb::Vec3SGrid>(grid);
        case TestType::Vec3d:
            return make_values<openvdb::Vec3DGrid>(grid);
        case TestType::Vec3i:
            return make_values<openvdb::Vec3IGrid>(grid);
        case TestType::Points:
            return make_points(grid);
    }
    return nullptr;
}

openvdb::GridPtrVec make_grids(const std::vector<TestGrid>& grids) {
    openvdb::initialize();
    openvdb::GridPtrVec result;
    for (const TestGrid& grid : grids) {
        const openvdb::GridBase::Ptr made = make_grid(grid);
        made->setName(grid.name);
        made->setTransform(make_transform(grid));
        made->setGridClass(class_of(grid.grid_class));
        made->setSaveFloatAsHalf(grid.half);
        result.push_back(made);
    }
    return result;
}

}  // namespace

void write_vdb(const std::filesystem::path& file, const std::vector<TestGrid>& grids, bool statistics) {
    const openvdb::GridPtrVec made = make_grids(grids);
    openvdb::io::File out(file.string());
    out.setGridStatsMetadataEnabled(statistics);
    out.write(made);
    out.close();
}

void write_vdb_stream(const std::filesystem::path& file, const std::vector<TestGrid>& grids) {
    const openvdb::GridPtrVec made = make_grids(grids);
    std::ofstream out(file, std::ios::binary);
    openvdb::io::Stream(out).write(made);
}

int patch_doubles(const std::filesystem::path& file, double from, double to) {
    std::ifstream in(file, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    char old_bytes[sizeof(double)], new_bytes[sizeof(double)];
    std::memcpy(old_bytes, &from, sizeof(double));
    std::memcpy(new_bytes, &to, sizeof(double));
    const std::string wanted(old_bytes, sizeof(double));
    int count = 0;
    for (std::size_t at = bytes.find(wanted); at != std::string::npos; at = bytes.find(wanted, at + 1), ++count)
        bytes.replace(at, sizeof(double), std::string(new_bytes, sizeof(double)));
    std::ofstream(file, std::ios::binary) << bytes;
    return count;
}

}  // namespace brisance
