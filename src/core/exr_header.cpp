// Layout: magic, version and flags, then for each part attributes of a name, a type, a size and as many bytes, up to an
// empty name. Several parts end with an empty header.
#include "core/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "core/error.h"
#include "core/input_file.h"
#include "core/printable.h"

namespace brisance {
namespace {

constexpr std::uint32_t kManyParts = 0x1000, kDeep = 0x800;
constexpr std::size_t kLongestText = 255;
constexpr std::int64_t kMostPixels = std::int64_t{1} << 28, kLongestSide = std::int64_t{1} << 17;

[[noreturn]] void reject(const std::filesystem::path& file, const std::string& why) {
    throw Error(ExitCode::BadData,
                fmt::format("{}: truncated or damaged: {}; write or copy the picture again", file.string(), why));
}

// Little-endian reads within a range of bytes.
class Bytes {
public:
    Bytes(std::string_view bytes, const std::filesystem::path& file) : rest_(bytes), file_(file) {}

    std::string_view take(std::uint64_t count) {
        if (count > rest_.size())
            reject(file_, "its header reaches beyond its end");
        const std::string_view taken = rest_.substr(0, count);
        rest_.remove_prefix(count);
        return taken;
    }

    std::uint32_t number() {
        std::uint32_t value = 0;
        const std::string_view bytes = take(4);
        for (std::size_t i = 4; i-- > 0;)
            value = (value << 8) | static_cast<unsigned char>(bytes[i]);
        return value;
    }

    std::string text() {
        const std::size_t length = rest_.substr(0, kLongestText + 1).find('\0');
        if (length == std::string_view::npos)
            reject(file_, "a name in its header has no end");
        return std::string(take(length + 1).substr(0, length));
    }

    bool empty() const { return rest_.empty(); }

    void expect_end() const {
        if (!rest_.empty())
            reject(file_, "an attribute of its header is shorter than it says");
    }

private:
    std::string_view rest_;
    std::filesystem::path file_;
};

// Bytes of a value of `type` where all have the same; OpenEXR reads as many whatever size the file states.
std::uint32_t bytes_of_type(std::string_view type) {
    struct Type {
        std::string_view name;
        std::uint32_t bytes;
    };
    static constexpr Type types[] = {{"box2i", 16},
                                     {"box2f", 16},
                                     {"chromaticities", 32},
                                     {"compression", 1},
                                     {"double", 8},
                                     {"envmap", 1},
                                     {"deepImageState", 1},
                                     {"float", 4},
                                     {"int", 4},
                                     {"keycode", 28},
                                     {"lineOrder", 1},
                                     {"m33f", 36},
                                     {"m33d", 72},
                                     {"m44f", 64},
                                     {"m44d", 128},
                                     {"rational", 8},
                                     {"timecode", 8},
                                     {"tiledesc", 9},
                                     {"v2i", 8},
                                     {"v2f", 8},
                                     {"v2d", 16},
                                     {"v3i", 12},
                                     {"v3f", 12},
                                     {"v3d", 24}};
    const auto* const found =
        std::find_if(std::begin(types), std::end(types), [&](const Type& t) { return t.name == type; });
    return found == std::end(types) ? 0 : found->bytes;
}

struct Part {
    std::uint64_t pixel_bytes = 0;  // of all channels
    std::int64_t width = 0, height = 0, tile_width = 0, tile_height = 0;
    unsigned compression = 0;
};

std::uint64_t bytes_of_channels(Bytes value) {
    std::uint64_t sum = 0;
    while (!value.text().empty()) {
        constexpr std::uint32_t half = 1;
        sum += value.number() == half ? 2 : 4;
        value.take(12);  // whether it is linear, and sampling
    }
    value.expect_end();
    return sum;
}

// Texts of a length each; OpenEXR would read the last one beyond the attribute's end.
void skip_texts(Bytes value) {
    while (!value.empty())
        value.take(value.number());
}

// OpenEXR reads a value by its type whatever its name is: each has to end where the file says.
void take_attribute(const std::string& name, const std::string& type, Bytes value, Part& part) {
    if (type == "chlist") {
        const std::uint64_t bytes = bytes_of_channels(value);
        part.pixel_bytes = name == "channels" ? bytes : part.pixel_bytes;
    } else if (type == "stringvector") {
        skip_texts(value);
    } else if (type == "preview") {
        const std::uint64_t width = value.number(), height = value.number();
        value.take(4 * std::min(width * height, std::uint64_t{1} << 32));
        value.expect_end();
    } else if (name == "compression" && type == "compression") {
        part.compression = static_cast<unsigned char>(value.take(1)[0]);
    } else if (name == "tiles" && type == "tiledesc") {
        part.tile_width = value.number();
        part.tile_height = value.number();
    } else if (name == "dataWindow" && type == "box2i") {
        std::array<std::int64_t, 4> box{};
        for (std::int64_t& side : box)
            side = static_cast<std::int32_t>(value.number());
        part.width = box[2] - box[0] + 1;
        part.height = box[3] - box[1] + 1;
    }
}

// False: the empty header behind the last part.
bool read_part(Bytes& header, const std::filesystem::path& file, Part& part) {
    std::set<std::string> names;
    for (std::string name = header.text(); !name.empty(); name = header.text()) {
        const std::string type = header.text();
        const std::uint32_t size = header.number();
        const Bytes value(header.take(size), file);
        const std::uint32_t should = bytes_of_type(type);
        if (should != 0 && size != should)
            reject(file, fmt::format("attribute \"{}\" has {} bytes instead of {}", printable(name, kLongestName), size,
                                     should));
        if (!names.insert(name).second)
            reject(file, fmt::format("attribute \"{}\" stands twice", printable(name, kLongestName)));
        take_attribute(name, type, value, part);
    }
    return !names.empty();
}

// How many bytes of pixels one byte can stand for. Deflate reaches 1032, the Huffman codes of PIZ less, run lengths 64;
// DWA deflates two bytes for each block of 64 pixels.
double most_per_byte(unsigned compression) {
    constexpr unsigned dwaa = 8;
    return compression >= dwaa ? 64.0 * 2064.0 : 2064.0;
}

void check_part(const Part& part, const std::filesystem::path& file, std::uint64_t file_bytes) {
    if (part.width < 1 || part.height < 1 || part.width > kLongestSide || part.height > kLongestSide ||
        part.width > kMostPixels / part.height)
        reject(file, fmt::format("its size of {} x {} pixels makes no sense", part.width, part.height));
    const auto pixels = static_cast<double>(part.width * part.height);
    if (pixels * static_cast<double>(part.pixel_bytes) >
        most_per_byte(part.compression) * static_cast<double>(file_bytes))
        reject(file, fmt::format("{} x {} pixels cannot be in {} bytes", part.width, part.height, file_bytes));
    if (part.tile_width == 0 && part.tile_height == 0)
        return;
    constexpr std::int64_t usual = 256;  // larger tiles than a small picture are common
    const std::int64_t most_wide = std::max(usual, part.width), most_high = std::max(usual, part.height);
    if (part.tile_width < 1 || part.tile_height < 1 || part.tile_width > most_wide || part.tile_height > most_high)
        reject(file, fmt::format("tiles of {} x {} pixels make no sense", part.tile_width, part.tile_height));
    const std::int64_t across = (part.width - 1) / part.tile_width + 1, down = (part.height - 1) / part.tile_height + 1;
    if (static_cast<std::uint64_t>(across * down) > file_bytes / sizeof(std::uint64_t))  // each has its place noted
        reject(file, fmt::format("{} x {} tiles cannot be in {} bytes", across, down, file_bytes));
}

}  // namespace

void check_exr_header(const std::filesystem::path& file) {
    const std::uint64_t file_bytes = size_of_input(file);
    constexpr std::uint64_t longest = std::uint64_t{1} << 24;  // of all headers; previews are in them
    std::string begin(std::min(file_bytes, longest), '\0');
    std::ifstream in(file, std::ios::binary);
    in.read(begin.data(), static_cast<std::streamsize>(begin.size()));
    begin.resize(static_cast<std::size_t>(in.gcount()));
    if (!begin.starts_with(kExrMagic))
        return;
    Bytes header(begin, file);
    header.take(kExrMagic.size());
    const std::uint32_t flags = header.number();
    if ((flags & kDeep) != 0)
        return;
    do {
        Part part;
        if (!read_part(header, file, part))
            break;
        check_part(part, file, file_bytes);
    } while ((flags & kManyParts) != 0);
}

}  // namespace brisance
