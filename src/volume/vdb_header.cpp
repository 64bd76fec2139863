// Layout of the skeleton: magic, versions, flags, UUID, file metadata, then per grid a descriptor with the offset at
// which the grid ends and the next descriptor begins.
#include "volume/vdb_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <string_view>

#include "core/error.h"
#include "core/input_file.h"
#include "core/printable.h"

namespace brisance {
namespace {

constexpr std::uint32_t kOldestVersion = 211;  // older ones have another skeleton; nothing has written them since 2012
constexpr std::uint32_t kNoVersion = 1000;     // 224 since 2018
constexpr std::uint32_t kGridOffsets = 212, kInstancing = 216, kTextUuid = 218, kTransformPerGrid = 219,
                        kCompressionFlag = 220, kCompressionPerGrid = 222;
constexpr std::uint32_t kLongestText = 1u << 16;

// Little-endian reads that check the end of the file.
class ByteReader {
public:
    ByteReader(const std::filesystem::path& file, std::uint64_t size)
        : stream_(file, std::ios::binary), file_(file), size_(size) {
        if (!stream_)
            throw Error(ExitCode::BadData, fmt::format("{}: cannot be opened; check its permissions", file.string()));
    }

    template <class T>
    T number() {
        std::array<unsigned char, sizeof(T)> bytes{};
        take(bytes.data(), sizeof(T));
        std::uint64_t value = 0;
        for (std::size_t i = sizeof(T); i-- > 0;)
            value = (value << 8) | bytes[i];
        return static_cast<T>(value);
    }

    std::string text() {
        const auto length = number<std::uint32_t>();
        if (length > kLongestText)
            throw_damaged(fmt::format("a name of {} bytes at byte {}", length, offset_));
        std::string result(length, '\0');
        take(result.data(), length);
        return result;
    }

    void skip(std::uint64_t bytes) { go_to(offset_ + bytes); }

    void go_to(std::uint64_t offset) {
        if (offset > size_)
            throw_truncated(fmt::format("something ends at byte {}", offset));
        offset_ = offset;
        stream_.seekg(static_cast<std::streamoff>(offset));
    }

    [[noreturn]] void throw_truncated(const std::string& what) const {
        throw Error(ExitCode::BadData,
                    fmt::format("{}: truncated VDB: {}, but the file has only {} bytes; copy or write it again",
                                file_.string(), what, size_));
    }

    [[noreturn]] void throw_damaged(const std::string& what) const {
        throw Error(ExitCode::BadData,
                    fmt::format("{}: damaged VDB: {}; write or copy the file again", file_.string(), what));
    }

    std::uint64_t offset() const { return offset_; }

private:
    void take(void* destination, std::uint64_t bytes) {
        if (offset_ + bytes > size_)
            throw_truncated(fmt::format("its header goes on at byte {}", offset_));
        stream_.read(static_cast<char*>(destination), static_cast<std::streamsize>(bytes));
        if (!stream_)
            throw Error(ExitCode::BadData, fmt::format("{}: reading failed at byte {}", file_.string(), offset_));
        offset_ += bytes;
    }

    std::ifstream stream_;
    std::filesystem::path file_;
    std::uint64_t size_;
    std::uint64_t offset_ = 0;
};

std::string first_bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string bytes(512, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream.gcount()));
    return bytes;
}

bool begins_with_magic(const std::string& bytes) {
    static constexpr std::string_view magic{" BDV\0\0\0\0", 8};
    return bytes.starts_with(magic);
}

// Bytes of one value of a type, as files name types; 0 for one without a fixed size, or unknown here.
std::uint64_t bytes_of_type(std::string_view type) {
    struct Type {
        std::string_view name;
        std::uint64_t bytes;
    };
    static constexpr Type types[] = {{"bool", 1},   {"mask", 1},   {"float", 4},  {"int32", 4},
                                     {"double", 8}, {"int64", 8},  {"vec2s", 8},  {"vec2i", 8},
                                     {"vec3s", 12}, {"vec3i", 12}, {"vec2d", 16}, {"vec3d", 24}};
    const auto* const found = std::find_if(std::begin(types), std::end(types), [&](const Type& t) {  //
        return t.name == type;
    });
    return found == std::end(types) ? 0 : found->bytes;
}

// A damaged count or size here would keep OpenVDB busy for minutes. This reader stops at the end of the file. Of a
// number OpenVDB ignores the size: with a wrong one it would go on reading at another place than this reader.
void skip_metadata(ByteReader& reader) {
    const auto entries = reader.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < entries; ++i) {
        reader.text();  // name
        const std::uint64_t should = bytes_of_type(reader.text());
        const auto bytes = reader.number<std::uint32_t>();
        if (should != 0 && bytes != should)
            reader.throw_damaged(
                fmt::format("a number of {} bytes instead of {} at byte {}", bytes, should, reader.offset()));
        reader.skip(bytes);
    }
}

// Bytes of a transform behind its name; 0 for one that is unknown here.
std::uint64_t bytes_of_transform(std::string_view type) {
    if (type == "ScaleMap" || type == "UniformScaleMap")
        return 15 * sizeof(double);  // five vectors: the scale, and what follows from it
    if (type == "ScaleTranslateMap" || type == "UniformScaleTranslateMap")
        return 18 * sizeof(double);
    if (type == "AffineMap" || type == "UnitaryMap")
        return 16 * sizeof(double);
    return type == "TranslationMap" ? 3 * sizeof(double) : 0;
}

// Versions, flags and file metadata; leaves the reader at the count of grids. True: grids can be found by offset.
bool read_preamble(ByteReader& reader, VdbHeader& header) {
    reader.number<std::uint64_t>();  // magic, checked before
    header.file_version = reader.number<std::uint32_t>();
    if (header.file_version > kNoVersion)
        reader.throw_damaged(fmt::format("file format {}", header.file_version));
    if (header.file_version < kOldestVersion)
        return false;
    reader.skip(2 * sizeof(std::uint32_t));  // version of the library that wrote the file
    const bool offsets = header.file_version < kGridOffsets || reader.number<char>() != 0;
    if (header.file_version >= kCompressionFlag && header.file_version < kCompressionPerGrid)
        reader.skip(1);
    reader.skip(header.file_version >= kTextUuid ? 36 : 16);
    skip_metadata(reader);
    return offsets;
}

struct Descriptor {
    std::string tree_type, shown_name;
    std::uint64_t end = 0;
};

// The root of a tree, behind the transform: its counts of tiles and of children, each of which takes bytes before the
// grid's end. OpenVDB goes on reading at the end of the file, up to 2^32 times. Trees that OpenVDB could not read
// either, or that are older, are not looked at.
void check_root(ByteReader& reader, const Descriptor& grid, const std::string& transform) {
    constexpr std::string_view tree = "Tree_", shape = "_5_4_3";
    constexpr std::uint64_t place = 3 * sizeof(std::int32_t), masks = 2 * 32 * 32 * 32 / 8;
    const std::size_t type_end = grid.tree_type.find(shape);
    if (!grid.tree_type.starts_with(tree) || type_end == std::string::npos)
        return;
    const std::uint64_t value = bytes_of_type(grid.tree_type.substr(tree.size(), type_end - tree.size()));
    const std::uint64_t skipped = bytes_of_transform(transform);
    if (value == 0 || skipped == 0)
        return;
    reader.skip(skipped);
    reader.skip(sizeof(std::uint32_t) + value);  // count of buffers, always 1; the background
    const auto tiles = reader.number<std::uint32_t>(), children = reader.number<std::uint32_t>();
    const std::uint64_t needed = tiles * (place + value + 1) + children * (place + masks);
    if (reader.offset() > grid.end || needed > grid.end - reader.offset())
        reader.throw_damaged(
            fmt::format("the root of grid \"{}\" claims {} tiles and {} children, which cannot fit before byte {}",
                        grid.shown_name, tiles, children, grid.end));
}

void read_descriptors(ByteReader& reader, VdbHeader& header) {
    const auto count = reader.number<std::int32_t>();
    for (std::int32_t i = 0; i < count; ++i) {
        const std::string name = reader.text();
        Descriptor grid{reader.text(), printable(name.substr(0, name.find('\x1e')), kLongestName), 0};
        const bool shares_tree = header.file_version >= kInstancing && !reader.text().empty();
        const auto begin = reader.number<std::uint64_t>();
        reader.skip(sizeof(std::uint64_t));
        grid.end = reader.number<std::uint64_t>();
        if (grid.end > header.file_bytes)
            reader.throw_truncated(
                fmt::format("grid \"{}\" ({} of {}) ends at byte {}", grid.shown_name, i + 1, count, grid.end));
        if (begin < reader.offset() || grid.end < begin)
            reader.throw_damaged(fmt::format("grid \"{}\" ends before it begins", grid.shown_name));
        reader.go_to(begin);
        if (header.file_version >= kCompressionPerGrid)
            reader.skip(sizeof(std::uint32_t));
        skip_metadata(reader);
        const std::string transform = reader.text();
        if (reader.offset() > grid.end)
            reader.throw_damaged(fmt::format("the metadata of grid \"{}\" reach beyond its end", grid.shown_name));
        if (header.file_version >= kTransformPerGrid && !shares_tree)
            check_root(reader, grid, transform);
        reader.go_to(grid.end);
        header.grid_names.push_back(name);
    }
}

}  // namespace

std::string describe_foreign_file(const std::string& bytes) {
    const auto begins = [&](std::string_view text) { return bytes.starts_with(text); };
    if (bytes.empty())
        return "is empty; write it again or copy it again";
    if (begins("version https://git-lfs"))
        return "is a Git LFS pointer, not the volume itself; run `git lfs pull` where it came from";
    if (begins("NanoVDB"))
        return "is a NanoVDB file; convert it with `nanovdb_convert file.nvdb file.vdb`";
    if (begins("\x1f\x8b") || begins("PK\x03\x04") || begins("\x28\xb5\x2f\xfd") || begins("BZh") ||
        begins("7z\xbc\xaf"))
        return "is a compressed archive; unpack it first";
    if (begins("\x89HDF"))
        return "is an HDF5 file (Field3D?); convert it to OpenVDB";
    if (begins("\x76\x2f\x31\x01"))
        return "is an OpenEXR image; name a .vdb file";
    if (std::all_of(bytes.begin(), bytes.end(), [](char c) { return c == '\0'; }))
        return "holds only zeros: an unfinished copy; copy it again";
    if (std::string(" BDV").starts_with(bytes.substr(0, 4)))
        return "ends within the first bytes of a VDB; copy or write it again";
    const bool text =
        std::all_of(bytes.begin(), bytes.end(), [](unsigned char c) { return c >= 32 || std::isspace(c); });
    const std::string_view body =
        std::string_view(bytes).substr(std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size()));
    if (text && body.starts_with('<'))
        return "is a web page or XML; the download failed";
    if (text)
        return "is a text file; name a .vdb file";
    std::string hex;
    for (std::size_t i = 0; i < std::min<std::size_t>(bytes.size(), 8); ++i)
        hex += fmt::format("{}{:02x}", i > 0 ? " " : "", static_cast<unsigned char>(bytes[i]));
    return fmt::format("is of another kind (it begins with {}); name a .vdb file", hex);
}

VdbHeader read_vdb_header(const std::filesystem::path& file) {
    VdbHeader header;
    header.file_bytes = size_of_input(file);
    const std::string first = first_bytes_of(file);
    if (!begins_with_magic(first))
        throw Error(ExitCode::BadData,
                    fmt::format("{}: not a VDB: it {}", file.string(), describe_foreign_file(first)));
    ByteReader reader(file, header.file_bytes);
    if (read_preamble(reader, header))
        read_descriptors(reader, header);
    return header;
}

}  // namespace brisance
