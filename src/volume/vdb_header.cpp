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
constexpr std::uint32_t kGridOffsets = 212, kInstancing = 216, kTextUuid = 218, kCompressionFlag = 220,
                        kCompressionPerGrid = 222;
constexpr std::uint32_t kLongestName = 1u << 16;

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
        if (length > kLongestName)
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

// A damaged count or size here would keep OpenVDB busy for minutes. This reader stops at the end of the file.
void skip_metadata(ByteReader& reader) {
    const auto entries = reader.number<std::uint32_t>();
    for (std::uint32_t i = 0; i < entries; ++i) {
        reader.text();  // name
        reader.text();  // type
        reader.skip(reader.number<std::uint32_t>());
    }
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

void read_descriptors(ByteReader& reader, VdbHeader& header) {
    const auto count = reader.number<std::int32_t>();
    for (std::int32_t i = 0; i < count; ++i) {
        const std::string name = reader.text();
        reader.text();  // type of the tree
        if (header.file_version >= kInstancing)
            reader.text();  // name of the grid whose tree is shared
        const auto begin = reader.number<std::uint64_t>();
        reader.skip(sizeof(std::uint64_t));
        const auto end = reader.number<std::uint64_t>();
        const std::string shown = printable(name.substr(0, name.find('\x1e')), kLongestName);
        if (end > header.file_bytes)
            reader.throw_truncated(fmt::format("grid \"{}\" ({} of {}) ends at byte {}", shown, i + 1, count, end));
        if (begin < reader.offset() || end < begin)
            reader.throw_damaged(fmt::format("grid \"{}\" ends before it begins", shown));
        reader.go_to(begin);
        if (header.file_version >= kCompressionPerGrid)
            reader.skip(sizeof(std::uint32_t));
        skip_metadata(reader);
        reader.text();  // type of the transform
        if (reader.offset() > end)
            reader.throw_damaged(fmt::format("the metadata of grid \"{}\" reach beyond its end", shown));
        reader.go_to(end);
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
