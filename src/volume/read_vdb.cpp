// The only file that includes OpenVDB. It turns files and trees into plain data.
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
#include "volume/raw_grid.h"
#include "volume/vdb_file.h"
#include "volume/vdb_header.h"

namespace brisance {
namespace {

using openvdb::GridBase;

// Text of a library's exception, short and printable.
std::string clean(const std::string& text) {
    std::string result;
    for (const char c : text.substr(0, 160))
        result += std::isprint(static_cast<unsigned char>(c)) ? c : ' ';
    return result;
}

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
        const std::string text = clean(error.what());
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

// Copies leaves' addresses and tiles out of a tree; false when the grid is of another type.
template <class GridType, class T, int Channels>
bool take_voxels(const GridBase::ConstPtr& base, std::optional<AnyRawGrid>& result) {
    if (!base->isType<GridType>())
        return false;
    const auto grid = openvdb::gridConstPtrCast<GridType>(base);
    using Tree = typename GridType::TreeType;
    static_assert(Tree::LeafNodeType::DIM == BlockGrid::kBlock);
    static_assert(sizeof(typename Tree::ValueType) == sizeof(T) * Channels);
    RawGrid<T> raw;
    raw.channels = Channels;
    raw.owner = grid;
    raw.leaves.reserve(grid->tree().leafCount());
    for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) {
        const openvdb::Coord& at = leaf->origin();
        RawLeaf<T> out{{at.x(), at.y(), at.z()}, reinterpret_cast<const T*>(leaf->buffer().data()), {}};
        for (openvdb::Index word = 0; word < 8; ++word)
            out.active[word] = leaf->valueMask().template getWord<std::uint64_t>(word);
        raw.leaves.push_back(out);
    }
    auto tile = grid->tree().cbeginValueOn();
    tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
        const openvdb::CoordBBox box = tile.getBoundingBox();
        RawTile<T> out{{box.min().x(), box.min().y(), box.min().z()}, box.max().x() - box.min().x() + 1, {}};
        const typename Tree::ValueType value = tile.getValue();
        std::memcpy(out.value, &value, sizeof(value));
        raw.tiles.push_back(out);
    }
    result = std::move(raw);
    return true;
}

std::optional<AnyRawGrid> raw_grid_from(const GridBase::ConstPtr& grid) {
    std::optional<AnyRawGrid> result;
    take_voxels<openvdb::FloatGrid, float, 1>(grid, result) ||
        take_voxels<openvdb::DoubleGrid, double, 1>(grid, result) ||
        take_voxels<openvdb::Int32Grid, std::int32_t, 1>(grid, result) ||
        take_voxels<openvdb::Int64Grid, std::int64_t, 1>(grid, result) ||
        take_voxels<openvdb::Vec3SGrid, float, 3>(grid, result) ||
        take_voxels<openvdb::Vec3DGrid, double, 3>(grid, result);
    return result;
}

// One file, opened and checked.
class OpenFile {
public:
    explicit OpenFile(const std::filesystem::path& path)
        : path_(path.string()), header_(read_vdb_header(path)), file_(path.string()) {
        guarded(path_, [&] {
            openvdb::initialize();
            openvdb::logging::setLevel(openvdb::logging::Level::Fatal);  // what matters is in our own messages
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

    std::size_t size() const { return stored_.size(); }
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
                clean(error.what()));
        }
        info.usable = info.why_unusable.empty();
        return info;
    }

    GridBase::Ptr load(std::size_t k) {
        return guarded(where(k), [&] { return file_.readGrid(readable_name(k)); });
    }

    // Bytes of the whole tree in memory, as the writer noted them; 0 where it did not.
    std::uint64_t claimed_bytes(std::size_t k) {
        return guarded(where(k), [&] {
            const GridBase::Ptr grid = file_.readGridMetadata(readable_name(k));
            const auto bytes = grid->getMetadata<openvdb::Int64Metadata>(GridBase::META_FILE_MEM_BYTES);
            return bytes ? static_cast<std::uint64_t>(std::max<std::int64_t>(bytes->value(), 0)) : std::uint64_t{0};
        });
    }

    std::string where(std::size_t k) const { return fmt::format("{}: grid \"{}[{}]\"", path_, name(k), index_of(k)); }

    std::size_t find(const std::string& wanted, int index) const {
        std::string present;
        for (std::size_t k = 0; k < size(); ++k) {
            if (name(k) == wanted && index_of(k) == index)
                return k;
            present += fmt::format("{}\"{}[{}]\"", k > 0 ? ", " : "", name(k), index_of(k));
        }
        throw Error(ExitCode::BadData,
                    fmt::format("{}: no grid \"{}[{}]\"; name one of {}", path_, wanted, index, present));
    }

private:
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
            take_bounds(load(k)->evalActiveVoxelBoundingBox(), info);
    }

    std::string creator_of(const GridBase& grid) const {
        std::string creator = clean(grid.getCreator());
        const openvdb::MetaMap::Ptr of_file = file_.getMetadata();
        if (creator.empty() && of_file)
            if (const auto text = of_file->getMetadata<openvdb::StringMetadata>("creator"))
                creator = clean(text->value());
        if (creator.empty() && grid["embergen_version"])
            creator = "EmberGen " + clean(grid["embergen_version"]->str());
        return creator;
    }

    std::string path_;
    VdbHeader header_;
    openvdb::io::File file_;
    std::vector<std::string> stored_;  // as in the file: a name held by several grids has a separator and a number
};

}  // namespace

double GridInfo::voxel_volume() const {
    return std::abs(glm::determinant(dmat3(world_from_index)));
}

std::vector<GridInfo> list_grids(const std::filesystem::path& file) {
    OpenFile open(file);
    std::vector<GridInfo> grids;
    for (std::size_t k = 0; k < open.size(); ++k)
        grids.push_back(open.describe(k));
    return grids;
}

BlockGrid read_grid(const std::filesystem::path& file, const std::string& name, int index,
                    std::uint64_t memory_limit_bytes) {
    OpenFile open(file);
    const std::size_t k = open.find(name, index);
    const GridInfo info = open.describe(k);
    if (!info.usable)
        throw Error(ExitCode::BadData, fmt::format("{} {}", open.where(k), info.why_unusable));
    // Zero blocks are dropped after loading and may save much, but not the memory to load them.
    const std::uint64_t claimed = open.claimed_bytes(k);
    if (claimed / 2 > memory_limit_bytes)
        throw Error(ExitCode::BadData,
                    fmt::format("{}: says that it takes {:.1f} MiB in memory, the limit is {:.1f} MiB; write it with "
                                "larger voxels or raise the limit",
                                open.where(k), static_cast<double>(claimed) / 1048576.0,
                                static_cast<double>(memory_limit_bytes) / 1048576.0));
    const GridBase::ConstPtr grid = open.load(k);
    return guarded(open.where(k), [&] {
        const std::optional<AnyRawGrid> raw = raw_grid_from(grid);
        if (!raw)
            throw Error(ExitCode::BadData, fmt::format("{}: its tree is not of the standard shape; write it again with "
                                                       "OpenVDB's default tree",
                                                       open.where(k)));
        return expand_blocks(*raw, info, memory_limit_bytes, open.where(k));
    });
}

GridCensus census_of_grid(const std::filesystem::path& file, const std::string& name, int index, int bins) {
    OpenFile open(file);
    const std::size_t k = open.find(name, index);
    const GridBase::ConstPtr grid = open.load(k);
    return guarded(open.where(k), [&] {
        if (const std::optional<AnyRawGrid> raw = raw_grid_from(grid))
            return count_voxels(*raw, bins);
        GridCensus census;  // points and flags can be counted, no more
        census.active_voxels = grid->activeVoxelCount();
        census.active_tiles = grid->constBaseTree().activeTileCount();
        return census;
    });
}

}  // namespace brisance
