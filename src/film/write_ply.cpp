#include "film/write_ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/error.h"
#include "film/whole_file.h"

namespace brisance {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are written as they lie in memory");

using Type = PlyProperty::Type;

const char* name_of(Type type) {
    switch (type) {
        case Type::Double:
            return "double";
        case Type::Float:
            return "float";
        case Type::Int:
            return "int";
        case Type::Byte:
            break;
    }
    return "uchar";
}

template <class T>
void append(std::string& bytes, T value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append(std::string& bytes, Type type, double value) {
    switch (type) {
        case Type::Double:
            append(bytes, value);
            break;
        case Type::Float:
            append(bytes, static_cast<float>(value));
            break;
        case Type::Int:
            append(bytes, static_cast<std::int32_t>(std::lround(value)));
            break;
        case Type::Byte:
            append(bytes, static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0))));
            break;
    }
}

std::string header(const std::vector<PlyProperty>& properties, const std::vector<std::string>& comments,
                   std::size_t vertices) {
    std::string text = "ply\nformat binary_little_endian 1.0\n";
    for (const std::string& comment : comments)
        text += fmt::format("comment {}\n", comment);
    text += fmt::format("element vertex {}\n", vertices);
    for (const PlyProperty& property : properties)
        text += fmt::format("property {} {}\n", name_of(property.type), property.name);
    return text + "end_header\n";
}

}  // namespace

void write_ply(const std::filesystem::path& file, const std::vector<PlyProperty>& properties,
               const std::vector<std::string>& comments) {
    const std::size_t vertices = properties.empty() ? 0 : properties.front().values.size();
    for (const PlyProperty& property : properties)
        if (property.values.size() != vertices)
            throw Error(ExitCode::RenderFailed,
                        fmt::format("cannot write {}: property {} has {} values for {} points", file.string(),
                                    property.name, property.values.size(), vertices));
    std::string bytes = header(properties, comments, vertices);
    for (std::size_t v = 0; v < vertices; ++v)
        for (const PlyProperty& property : properties)
            append(bytes, property.type, property.values[v]);
    write_whole_file(file, bytes);
}

}  // namespace brisance
