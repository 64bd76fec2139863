#include "scene/gltf/gltf_accessor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>

namespace brisance {
namespace {

// Elements at a regular distance. Without `first` all numbers are 0: an accessor that has no bufferView.
struct Elements {
    const unsigned char* first = nullptr;
    std::size_t count = 0, stride = 0;
    int component_type = 0;
    bool normalised = false;
};

std::size_t component_bytes(const GltfFile& file, int type, const std::string& what) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return 1;
        case TINYGLTF_COMPONENT_TYPE_SHORT:
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return 2;
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return 4;
        default:
            file.reject(fmt::format("{} has component type {}, which glTF does not know", what, type));
    }
}

int components_of(const tinygltf::Accessor& accessor) {
    switch (accessor.type) {
        case TINYGLTF_TYPE_SCALAR:
            return 1;
        case TINYGLTF_TYPE_VEC2:
            return 2;
        case TINYGLTF_TYPE_VEC3:
            return 3;
        case TINYGLTF_TYPE_VEC4:
            return 4;
        case TINYGLTF_TYPE_MAT4:
            return 16;
        default:
            return 0;  // smaller matrices: nothing here reads any
    }
}

// `count` elements of `bytes` each, from `offset` of a bufferView on.
Elements elements_of_view(const GltfFile& file, int view, std::size_t offset, std::size_t count, std::size_t bytes,
                          const std::string& what) {
    const ByteRange range = bytes_of_view(file, view, what);
    const std::size_t given = file.model.bufferViews[static_cast<std::size_t>(view)].byteStride;
    const std::size_t stride = given == 0 ? bytes : given;
    if (stride < bytes)
        file.reject(fmt::format("{}: elements of {} bytes stand {} bytes apart", what, bytes, stride));
    // By division: a count from a file may be anything up to 2^64.
    const bool fits = count == 0 || (offset <= range.size && range.size - offset >= bytes &&
                                     count - 1 <= (range.size - offset - bytes) / stride);
    if (!fits)
        file.reject(fmt::format("{}: {} elements do not fit into the {} bytes of bufferView {}", what, count,
                                range.size, view));
    return {range.first + (count == 0 ? 0 : offset), count, stride, 0, false};
}

Elements elements(const GltfFile& file, int index, int components, const std::string& what) {
    const tinygltf::Accessor& accessor = checked(file, file.model.accessors, index, (what + ": accessor").c_str());
    if (components_of(accessor) == 0 || (components != 0 && components_of(accessor) != components))
        file.reject(fmt::format("{}: accessor {} has another number of components than {}", what, index, components));
    const std::size_t bytes =
        component_bytes(file, accessor.componentType, what) * static_cast<std::size_t>(components_of(accessor));
    Elements result{nullptr, accessor.count, bytes, 0, false};
    if (accessor.bufferView >= 0)
        result = elements_of_view(file, accessor.bufferView, accessor.byteOffset, accessor.count, bytes, what);
    else if (!accessor.sparse.isSparse && accessor.count > 0)
        file.reject(fmt::format("{}: accessor {} has no bufferView", what, index));
    result.component_type = accessor.componentType;
    result.normalised = accessor.normalized;
    return result;
}

template <class T>
T load(const unsigned char* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

template <class T>
float as_float(const unsigned char* from, bool normalised) {
    const auto value = static_cast<float>(load<T>(from));
    if constexpr (std::numeric_limits<T>::is_integer)
        return normalised ? std::max(value / static_cast<float>(std::numeric_limits<T>::max()), -1.0f) : value;
    return value;
}

template <class T>
void convert(const Elements& from, std::size_t element, std::size_t components, float* to) {
    const unsigned char* const bytes = from.first + element * from.stride;
    for (std::size_t c = 0; c < components; ++c)
        to[c] = as_float<T>(bytes + c * sizeof(T), from.normalised);
}

void convert_any(const Elements& from, std::size_t element, std::size_t components, float* to) {
    switch (from.component_type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return convert<std::int8_t>(from, element, components, to);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return convert<std::uint8_t>(from, element, components, to);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return convert<std::int16_t>(from, element, components, to);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return convert<std::uint16_t>(from, element, components, to);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return convert<std::uint32_t>(from, element, components, to);
        default:
            return convert<float>(from, element, components, to);
    }
}

std::uint32_t index_at(const Elements& from, std::size_t element, std::size_t component = 0) {
    const unsigned char* const bytes = from.first + element * from.stride;
    switch (from.component_type) {
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<std::uint8_t>(bytes + component);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<std::uint16_t>(bytes + component * sizeof(std::uint16_t));
        default:
            return load<std::uint32_t>(bytes + component * sizeof(std::uint32_t));
    }
}

void check_index_type(const GltfFile& file, int type, const std::string& what) {
    if (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
        type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
        file.reject(fmt::format("{} are not unsigned integers (component type {})", what, type));
}

// The elements that a sparse accessor replaces, and what by.
struct Replacement {
    Elements indices, values;
};

Replacement replacement(const GltfFile& file, const tinygltf::Accessor& accessor, const std::string& what) {
    const auto& sparse = accessor.sparse;
    if (sparse.count < 0 || sparse.indices.byteOffset < 0 || sparse.values.byteOffset < 0)
        file.reject(what + ": negative numbers in a sparse accessor");
    check_index_type(file, sparse.indices.componentType, what + ": sparse indices");
    const auto count = static_cast<std::size_t>(sparse.count);
    const std::size_t value_bytes =
        component_bytes(file, accessor.componentType, what) * static_cast<std::size_t>(components_of(accessor));
    Replacement result;
    result.indices =
        elements_of_view(file, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset), count,
                         component_bytes(file, sparse.indices.componentType, what), what);
    result.indices.component_type = sparse.indices.componentType;
    result.values = elements_of_view(file, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
                                     count, value_bytes, what);
    result.values.component_type = accessor.componentType;
    result.values.normalised = accessor.normalized;
    return result;
}

}  // namespace

std::size_t element_count(const GltfFile& file, int accessor, const std::string& what) {
    return elements(file, accessor, 0, what).count;
}

std::vector<float> read_floats(const GltfFile& file, int accessor, int components, const std::string& what) {
    const Elements from = elements(file, accessor, components, what);
    const auto n = static_cast<std::size_t>(components);
    std::vector<float> numbers;
    if (from.count > numbers.max_size() / n)
        file.reject(fmt::format("{}: {} elements are more than any memory holds", what, from.count));
    numbers.resize(from.count * n);
    if (from.first != nullptr)
        for (std::size_t i = 0; i < from.count; ++i)
            convert_any(from, i, n, &numbers[i * n]);
    const tinygltf::Accessor& described = file.model.accessors[static_cast<std::size_t>(accessor)];
    if (!described.sparse.isSparse)
        return numbers;
    const Replacement sparse = replacement(file, described, what);
    for (std::size_t i = 0; i < sparse.indices.count; ++i) {
        const std::size_t target = index_at(sparse.indices, i);
        if (target >= from.count)
            file.reject(fmt::format("{}: a sparse index is {}, of {} elements", what, target, from.count));
        convert_any(sparse.values, i, n, &numbers[target * n]);
    }
    return numbers;
}

std::vector<std::uint32_t> read_indices(const GltfFile& file, int accessor, const std::string& what, int components) {
    const Elements from = elements(file, accessor, components, what);
    check_index_type(file, from.component_type, what);
    if (file.model.accessors[static_cast<std::size_t>(accessor)].sparse.isSparse)
        file.reject(what + " are sparse, which is not supported");
    const auto n = static_cast<std::size_t>(components);
    std::vector<std::uint32_t> indices(from.count * n);
    for (std::size_t i = 0; i < indices.size(); ++i)
        indices[i] = index_at(from, i / n, i % n);
    return indices;
}

ByteRange bytes_of_view(const GltfFile& file, int view, const std::string& what) {
    const tinygltf::BufferView& v = checked(file, file.model.bufferViews, view, (what + ": bufferView").c_str());
    const tinygltf::Buffer& buffer = checked(file, file.model.buffers, v.buffer, (what + ": buffer").c_str());
    if (v.byteOffset > buffer.data.size() || v.byteLength > buffer.data.size() - v.byteOffset)
        file.reject(fmt::format("{}: bufferView {} ends beyond the {} bytes of buffer {}", what, view,
                                buffer.data.size(), v.buffer));
    return {buffer.data.data() + v.byteOffset, v.byteLength};
}

}  // namespace brisance
