// [1] W3C, Portable Network Graphics (PNG) Specification, third edition. [2] its section 12.7: the filter of least sum.
#include "png.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <vector>

#include "core/error.h"

namespace brisance {
namespace {

using Bytes = std::vector<std::uint8_t>;

void append_number(std::string& out, std::uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8)
        out += static_cast<char>(value >> shift & 0xff);
}

void append_chunk(std::string& out, const std::string& type, std::string_view data) {
    append_number(out, static_cast<std::uint32_t>(data.size()));
    const std::string body = type + std::string(data);
    out += body;
    append_number(out, static_cast<std::uint32_t>(
                           crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()))));
}

std::string compressed(const Bytes& bytes) {
    uLongf size = compressBound(static_cast<uLong>(bytes.size()));
    std::string out(size, '\0');
    if (compress2(reinterpret_cast<Bytef*>(out.data()), &size, bytes.data(), static_cast<uLong>(bytes.size()),
                  Z_BEST_COMPRESSION) != Z_OK)
        throw Error(ExitCode::RenderFailed, "cannot compress a picture for the report");
    out.resize(size);
    return out;
}

int paeth(int left, int above, int corner) {
    const int estimate = left + above - corner;
    const int a = std::abs(estimate - left), b = std::abs(estimate - above), c = std::abs(estimate - corner);
    return a <= b && a <= c ? left : b <= c ? above : corner;
}

// One row under filter type 0 to 4 of [1], after its type.
Bytes filtered(int type, const std::uint8_t* row, const std::uint8_t* before, std::size_t size) {
    Bytes out(size + 1);
    out[0] = static_cast<std::uint8_t>(type);
    for (std::size_t i = 0; i < size; ++i) {
        const int left = i < 3 ? 0 : row[i - 3], above = before ? before[i] : 0;
        const int corner = i < 3 || !before ? 0 : before[i - 3];
        const std::array<int, 5> guesses = {0, left, above, (left + above) / 2, paeth(left, above, corner)};
        out[i + 1] = static_cast<std::uint8_t>(row[i] - guesses[static_cast<std::size_t>(type)]);
    }
    return out;
}

std::uint64_t sum_of_magnitudes(const Bytes& row) {
    std::uint64_t sum = 0;
    for (std::size_t i = 1; i < row.size(); ++i)
        sum += static_cast<std::uint64_t>(std::min<int>(row[i], 256 - row[i]));
    return sum;
}

Bytes best_filtered(const std::uint8_t* row, const std::uint8_t* before, std::size_t size) {
    Bytes best = filtered(0, row, before, size);
    for (int type = 1; type < 5; ++type) {
        Bytes other = filtered(type, row, before, size);
        if (sum_of_magnitudes(other) < sum_of_magnitudes(best))
            best = std::move(other);
    }
    return best;
}

std::string file_of(int width, int height, int colour_type, std::string_view palette, const Bytes& rows) {
    std::string header;
    append_number(header, static_cast<std::uint32_t>(width));
    append_number(header, static_cast<std::uint32_t>(height));
    for (const int value : {8, colour_type, 0, 0, 0})  // bits, colour type, and the only ways to compress and order
        header += static_cast<char>(value);
    std::string out = "\x89PNG\r\n\x1a\n";
    append_chunk(out, "IHDR", header);
    append_chunk(out, "sRGB", std::string(1, '\0'));
    if (!palette.empty())
        append_chunk(out, "PLTE", palette);
    append_chunk(out, "IDAT", compressed(rows));
    append_chunk(out, "IEND", {});
    return out;
}

}  // namespace

std::string encode_png(int width, int height, std::span<const std::uint8_t> rgb) {
    const std::size_t size = 3 * static_cast<std::size_t>(width);
    assert(rgb.size() == size * static_cast<std::size_t>(height));
    Bytes rows;
    rows.reserve(rgb.size() + static_cast<std::size_t>(height));
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        const std::uint8_t* const row = rgb.data() + y * size;
        const Bytes best = best_filtered(row, y == 0 ? nullptr : row - size, size);
        rows.insert(rows.end(), best.begin(), best.end());
    }
    return file_of(width, height, 2, {}, rows);
}

std::string encode_indexed_png(int width, int height, std::span<const std::uint8_t> indices,
                               std::span<const std::uint8_t> palette) {
    const auto size = static_cast<std::size_t>(width);
    assert(indices.size() == size * static_cast<std::size_t>(height) && palette.size() <= 768);
    Bytes rows;
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y) {
        rows.push_back(0);  // indices that differ little need not look alike: no filter
        rows.insert(rows.end(), indices.begin() + static_cast<std::ptrdiff_t>(y * size),
                    indices.begin() + static_cast<std::ptrdiff_t>((y + 1) * size));
    }
    return file_of(width, height, 3, {reinterpret_cast<const char*>(palette.data()), palette.size()}, rows);
}

std::string base64(std::string_view bytes) {
    static constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            out += i + k <= bytes.size() ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

}  // namespace brisance
