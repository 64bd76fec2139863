#include "reference/path_film.h"

#include <cmath>
#include <cstring>

namespace brisance {

namespace {

constexpr char kMagic[8] = {'B', 'R', 'I', 'S', 'P', 'F', '0', '1'};

std::uint64_t fnv1a(const char* bytes, std::size_t count) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (std::size_t i = 0; i < count; ++i)
        hash = (hash ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3;
    return hash;
}

struct Header {
    char magic[8];
    std::uint64_t key, width, height, sums, bytes;
    PathFilm::Work work;
};

}  // namespace

PathFilm::PathFilm(int width, int height, bool orders, bool cells)
    : width_(width),
      height_(height),
      orders_(orders ? kPathOrders : 3),
      sums_(orders_ + (cells ? kCells : 0)),
      values_(std::size_t(width) * height * 2 * sums_ * 3),
      squares_(std::size_t(width) * height * 3) {}

bool PathFilm::add(std::size_t pixel, int half, const PathSum& path) {
    Rgb total(0.0f);
    for (const Rgb& order : path)
        total += order;
    if (!std::isfinite(total.x) || !std::isfinite(total.y) || !std::isfinite(total.z))
        return false;
    double* v = &values_[(pixel * 2 + half) * sums_ * 3];
    for (int order = 0; order < kPathOrders; ++order)
        for (int c = 0; c < 3; ++c)
            v[std::min(order, orders_ - 1) * 3 + c] += path[order][c];
    for (int cell = 0; orders_ + cell < sums_; ++cell)
        for (int c = 0; c < 3; ++c)
            v[(orders_ + cell) * 3 + c] += path.cells[cell][c];
    for (int c = 0; c < 3; ++c)
        squares_[pixel * 3 + c] += double(total[c]) * total[c];
    return true;
}

std::string PathFilm::serialise(const std::string& key) const {
    Header header{};
    std::memcpy(header.magic, kMagic, sizeof kMagic);
    header.key = fnv1a(key.data(), key.size());
    header.width = width_;
    header.height = height_;
    header.sums = sums_;
    header.bytes = (values_.size() + squares_.size()) * sizeof(double);
    header.work = work;
    std::string out(sizeof header + header.bytes, '\0');
    std::memcpy(out.data(), &header, sizeof header);
    std::memcpy(out.data() + sizeof header, values_.data(), values_.size() * sizeof(double));
    std::memcpy(out.data() + sizeof header + values_.size() * sizeof(double), squares_.data(),
                squares_.size() * sizeof(double));
    const std::uint64_t check = fnv1a(out.data(), out.size());
    out.append(reinterpret_cast<const char*>(&check), sizeof check);
    return out;
}

std::string PathFilm::restore(const std::string& bytes, const std::string& key) {
    Header header{};
    std::uint64_t check = 0;
    if (bytes.size() < sizeof header + sizeof check || std::memcmp(bytes.data(), kMagic, sizeof kMagic) != 0)
        return "is no checkpoint of this version";
    std::memcpy(&header, bytes.data(), sizeof header);
    const std::size_t body = bytes.size() - sizeof check;
    std::memcpy(&check, bytes.data() + body, sizeof check);
    if (body != sizeof header + header.bytes || check != fnv1a(bytes.data(), body))
        return "is damaged";
    if (header.key != fnv1a(key.data(), key.size()))
        return "belongs to another shot, volume, or other settings than tracing.samples, seconds and error";
    if (header.width != std::uint64_t(width_) || header.height != std::uint64_t(height_) ||
        header.sums != std::uint64_t(sums_) || header.bytes != (values_.size() + squares_.size()) * sizeof(double))
        return "is of another picture size or other layers";
    std::memcpy(values_.data(), bytes.data() + sizeof header, values_.size() * sizeof(double));
    std::memcpy(squares_.data(), bytes.data() + sizeof header + values_.size() * sizeof(double),
                squares_.size() * sizeof(double));
    work = header.work;
    return "";
}

}  // namespace brisance
