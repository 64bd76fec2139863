// The only file that includes OpenVDB. It turns files and trees into plain data, in a child process.
#include <fmt/format.h>
#include <openvdb/io/File.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/openvdb.h>
#include <openvdb/util/logging.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <optional>
#include <stdexcept>

#include "core/error.h"
#include "core/printable.h"
#include "volume/child/read_vdb.h"
#include "volume/raw_grid.h"
#include "volume/vdb_header.h"

namespace brisance {
namespace {

using openvdb::GridBase;

// Runs `body` and turns any exception of OpenVDB, damaged files included, into an Error with one line about `where`.
template <class Body>
auto guarded(const std::string& where, const Body& body) {
    const char* const remedy = "write or copy the file again";
    try {
        return body();
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::BadData,
                    fmt::format("{}: needs more memory than there is: a damaged VDB, or one too large for this "
                                "machine; {} or try where there is more memory",
                                where, remedy));
    } catch (const std::exception& error) {
        const std::string text = printable(error.what());
        const bool codec = text.find("ompress") != std::string::npos || text.find("osc") != std::string::npos;
        throw Error(ExitCode::BadData,
                    fmt::format("{}: {}: {}; {}", where,
                                codec ? "its compressed voxels cannot be unpacked" : "damaged VDB", text, remedy));
    } catch (...) {
        throw Error(ExitCode::BadData, fmt::format("{}: damaged VDB; {}", where, remedy));
    }
}

std::string type_label(const GridBase& grid) {
    std::string type = grid.valueType();
    if (type.starts_with("ptdata") || type.starts_with("ptidx"))
        return "points";
    if (grid.saveFloatAsHalf() && (type == "float" || type == "double"))
        return "half";
    if (grid.saveFloatAsHalf() && (type == "vec3s" || type == "vec3d"))
        return "vec3h";
    return type;
}

std::string class_label(const GridBase& grid) {
    switch (grid.getGridClass()) {
        case openvdb::GRID_LEVEL_SET:
            return "level set";
        case openvdb::GRID_FOG_VOLUME:
            return "fog volume";
        case openvdb::GRID_STAGGERED:
            return "staggered";
        default:
            return "unknown";
    }
}

// Why the transform cannot be used; empty when it can. Writes it to `info`.
std::string take_transform(const GridBase& grid, GridInfo& info) {
    if (!grid.transform().isLinear()) {
        info.affine = false;
        return "its transform is a frustum; resample it to uniform voxels (Houdini: VDB Resample, Blender: bake again)";
    }
    const char* const singular = "its transform is singular or not finite; give it a voxel size above zero";
    openvdb::Mat4d matrix;
    try {
        matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
    } catch (const std::exception&) {  // OpenVDB inverts it, and cannot
        return singular;
    }
    bool finite = true;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            finite = finite && std::isfinite(matrix(i, j));
            info.world_from_index[i][j] = matrix(i, j);  // row vectors there, column vectors here: both transposed
        }
    }
    const dmat3 axes(info.world_from_index);
    const double box = glm::length(axes[0]) * glm::length(axes[1]) * glm::length(axes[2]);
    const bool regular = finite && std::isfinite(box) && std::abs(glm::determinant(axes)) > 1e-12 * box;
    if (!regular)
        info.world_from_index = dmat4(1.0);
    return regular ? std::string() : singular;
}

std::string why_unusable(const GridInfo& info) {
    static constexpr const char* readable[] = {"float", "double", "half", "int32", "int64", "vec3s", "vec3d", "vec3h"};
    if (info.value_type == "points")
        return "holds points, not voxels; rasterize them (Houdini: VDB from Particles, Blender: Points to Volume)";
    if (info.grid_class == "level set")
        return "is a level set; convert it to fog (Houdini: Convert VDB, SDF to Fog; or vdb_tool -sdf2fog)";
    if (info.value_type == "bool" || info.value_type == "mask")
        return "holds on/off flags, not amounts; write it as float";
    if (std::none_of(std::begin(readable), std::end(readable), [&](const char* t) { return info.value_type == t; }))
        return fmt::format("holds values of type {}; write it as float or vec3s", info.value_type);
    return {};
}

void take_bounds(const openvdb::CoordBBox& box, GridInfo& info) {
    const bool none = box.empty();
    info.active_min = none ? ivec3(0) : ivec3(box.min().x(), box.min().y(), box.min().z());
    info.active_max = none ? ivec3(-1) : ivec3(box.max().x(), box.max().y(), box.max().z());
}

template <class LeafPointer>
bool leaf_comes_before(const LeafPointer& a, const LeafPointer& b) {
    return a->origin() < b->origin();
}

RawLeaf shape_of(const openvdb::Coord& origin, const openvdb::util::NodeMask<3>& mask) {
    RawLeaf leaf{{origin.x(), origin.y(), origin.z()}, {}};
    for (openvdb::Index word = 0; word < 8; ++word)
        leaf.active[word] = mask.getWord<std::uint64_t>(word);
    return leaf;
}

template <class Tree, class T>
void take_tiles(const Tree& tree, std::vector<RawTile<T>>& tiles) {
    auto tile = tree.cbeginValueOn();
    tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const openvdb::CoordBBox box = tile.getBoundingBox();
        RawTile<T> out{{box.min().x(), box.min().y(), box.min().z()}, box.max().x() - box.min().x() + 1, {}};
        const typename Tree::ValueType value = tile.getValue();
        std::memcpy(out.value, &value, sizeof(value));
        tiles.push_back(out);
    }
}

// Copies leaves' shapes, the addresses of their values, and tiles out of a tree; false when the grid is of another
// type.
template <class GridType, class T, int Channels>
bool take_voxels(const GridBase::ConstPtr& base, std::optional<AnyLoadedVoxels>& result) {
    if (!base->isType<GridType>())
        return false;
    const auto grid = openvdb::gridConstPtrCast<GridType>(base);
    using Tree = typename GridType::TreeType;
    static_assert(Tree::LeafNodeType::DIM == BlockGrid::kBlock);
    static_assert(sizeof(typename Tree::ValueType) == sizeof(T) * Channels);
    std::vector<const typename Tree::LeafNodeType*> leaves;
    grid->tree().getNodes(leaves);
    std::sort(leaves.begin(), leaves.end(), leaf_comes_before<const typename Tree::LeafNodeType*>);
    LoadedVoxels<T> loaded;
    loaded.channels = Channels;
    loaded.owner = grid;
    loaded.leaves.reserve(leaves.size());
    loaded.values.reserve(leaves.size());
    for (const auto* const leaf : leaves) {
        loaded.leaves.push_back(shape_of(leaf->origin(), leaf->valueMask()));
        loaded.values.push_back(reinterpret_cast<const T*>(leaf->buffer().data()));
    }
    take_tiles(grid->tree(), loaded.tiles);
    result = std::move(loaded);
    return true;
}

std::optional<AnyLoadedVoxels> voxels_of(const GridBase::ConstPtr& grid) {
    std::optional<AnyLoadedVoxels> result;
    take_voxels<openvdb::FloatGrid, float, 1>(grid, result) ||
        take_voxels<openvdb::DoubleGrid, double, 1>(grid, result) ||
        take_voxels<openvdb::Int32Grid, std::int32_t, 1>(grid, result) ||
        take_voxels<openvdb::Int64Grid, std::int64_t, 1>(grid, result) ||
        take_voxels<openvdb::Vec3SGrid, float, 3>(grid, result) ||
        take_voxels<openvdb::Vec3DGrid, double, 3>(grid, result);
    return result;
}

// One file, opened and checked.
class OpenFile : public OpenVdb {
public:
    explicit OpenFile(const std::filesystem::path& path)
        : path_(path.string()), header_(read_vdb_header(path)), file_(path.string()) {
        guarded(path_, [&] {
            initialize_openvdb();
            constexpr bool delayed = false;  // loads wholly: delayed loading is slow over networks
            file_.open(delayed);
            stored_ = header_.grid_names;
            if (stored_.empty())  // streamed files have no table of offsets to read names from
                for (auto name = file_.beginName(); name != file_.endName(); ++name)
                    stored_.push_back(*name);
        });
        if (stored_.empty())
            throw Error(ExitCode::BadData, path_ + ": holds no grid at all; write it again with at least one");
    }

    std::vector<GridInfo> grids() override {
        std::vector<GridInfo> grids;
        for (std::size_t k = 0; k < stored_.size(); ++k)
            grids.push_back(describe(k));
        return grids;
    }

    LoadedGrid load(std::size_t k, std::uint64_t memory_limit_bytes) override {
        check_claim(k, memory_limit_bytes);
        const GridBase::ConstPtr grid = read(k);
        return guarded(where(k), [&] {
            LoadedGrid loaded;
            loaded.voxels = voxels_of(grid);
            if (!loaded.voxels) {
                loaded.active_voxels = grid->activeVoxelCount();
                loaded.active_tiles = grid->constBaseTree().activeTileCount();
            }
            return loaded;
        });
    }

private:
    std::string name(std::size_t k) const { return openvdb::io::GridDescriptor::stripSuffix(stored_[k]); }

    int index_of(std::size_t k) const {
        int index = 0;
        for (std::size_t i = 0; i < k; ++i)
            index += name(i) == name(k) ? 1 : 0;
        return index;
    }

    // Describes a bad grid among good ones as unusable instead of throwing.
    GridInfo describe(std::size_t k) {
        GridInfo info;
        info.name = name(k);
        info.index = index_of(k);
        try {
            const GridBase::Ptr grid = file_.readGridMetadata(readable_name(k));
            fill_info(k, *grid, info);
        } catch (const Error&) {
            throw;
        } catch (const std::exception& error) {
            info.value_type = info.value_type.empty() ? "unknown" : info.value_type;
            info.why_unusable = fmt::format(
                "cannot be read ({}); write it again as a float or vec3s grid with an "
                "invertible transform",
                printable(error.what()));
        }
        info.usable = info.why_unusable.empty();
        return info;
    }

    GridBase::Ptr read(std::size_t k) {
        return guarded(where(k), [&] { return file_.readGrid(readable_name(k)); });
    }

    // Blocks of zeros are dropped after loading and may save much, but not the memory to load them.
    void check_claim(std::size_t k, std::uint64_t memory_limit_bytes) {
        const std::uint64_t claimed = claimed_bytes(k);
        if (claimed / 2 > memory_limit_bytes)
            throw Error(ExitCode::BadData,
                        fmt::format("{}: says that it takes {:.1f} MiB in memory, the limit is {:.1f} MiB; write it "
                                    "with larger voxels or raise the limit",
                                    where(k), static_cast<double>(claimed) / 1048576.0,
                                    static_cast<double>(memory_limit_bytes) / 1048576.0));
    }

    // Bytes of the whole tree in memory, as the writer noted them; 0 where it did not.
    std::uint64_t claimed_bytes(std::size_t k) {
        return guarded(where(k), [&] {
            const GridBase::Ptr grid = file_.readGridMetadata(readable_name(k));
            const auto bytes = grid->getMetadata<openvdb::Int64Metadata>(GridBase::META_FILE_MEM_BYTES);
            return bytes ? static_cast<std::uint64_t>(std::max<std::int64_t>(bytes->value(), 0)) : std::uint64_t{0};
        });
    }

    std::string where(std::size_t k) const {
        return fmt::format("{}: grid \"{}[{}]\"", path_, printable(name(k), kLongestName), index_of(k));
    }

    std::string readable_name(std::size_t k) const { return openvdb::io::GridDescriptor::nameAsString(stored_[k]); }

    void fill_info(std::size_t k, const GridBase& grid, GridInfo& info) {
        info.value_type = type_label(grid);
        info.grid_class = class_label(grid);
        info.creator = creator_of(grid);
        info.why_unusable = why_unusable(info);
        const std::string bad_transform = take_transform(grid, info);
        if (info.why_unusable.empty())
            info.why_unusable = bad_transform;
        const auto low = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MIN);
        const auto high = grid.getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MAX);
        if (low && high)
            take_bounds({openvdb::Coord(low->value()), openvdb::Coord(high->value())}, info);
        else if (info.why_unusable.empty())  // written without statistics
            take_bounds(read(k)->evalActiveVoxelBoundingBox(), info);
    }

    std::string creator_of(const GridBase& grid) const {
        std::string creator = printable(grid.getCreator());
        const openvdb::MetaMap::Ptr of_file = file_.getMetadata();
        if (creator.empty() && of_file)
            if (const auto text = of_file->getMetadata<openvdb::StringMetadata>("creator"))
                creator = printable(text->value());
        if (creator.empty() && grid["embergen_version"])
            creator = "EmberGen " + printable(grid["embergen_version"]->str());
        if (creator.empty() && grid["file_base_resolution"])  // Mantaflow does not name itself
            creator = "Blender (Mantaflow)";
        return creator;
    }

    std::string path_;
    VdbHeader header_;
    openvdb::io::File file_;
    std::vector<std::string> stored_;  // as in the file: a name held by several grids has a separator and a number
};

}  // namespace

std::unique_ptr<OpenVdb> open_vdb(const std::filesystem::path& file) {
    return std::make_unique<OpenFile>(file);
}

void initialize_openvdb() {
    openvdb::initialize();
    openvdb::logging::setLevel(openvdb::logging::Level::Fatal);  // what matters is in our own messages
}

}  // namespace brisance
