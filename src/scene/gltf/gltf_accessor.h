// Reads numbers from a glTF file's buffers (glTF 2.0, section 3.6) and checks all bounds.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scene/gltf/gltf_file.h"

namespace brisance {

// Each function rejects the file in a line that says `what` was read, when the accessor, its bufferView or its buffer
// does not exist or is too short, or its type is not the expected one.

// Returns the number of elements, all of which exist. Allocates nothing, so that a file may claim any number.
std::size_t element_count(const GltfFile& file, int accessor, const std::string& what);

// All elements of `components` numbers each, one after the other; normalised integers as 0..1 or -1..1. 16 components
// are a 4x4 matrix, column by column.
std::vector<float> read_floats(const GltfFile& file, int accessor, int components, const std::string& what);

// As read_floats, as vectors: vec2, vec3 or vec4.
template <class Vector>
std::vector<Vector> read_vectors(const GltfFile& file, int accessor, const std::string& what) {
    const std::vector<float> numbers = read_floats(file, accessor, Vector::length(), what);
    std::vector<Vector> vectors(numbers.size() / static_cast<std::size_t>(Vector::length()));
    for (std::size_t i = 0; i < numbers.size(); ++i)
        vectors[i / Vector::length()][static_cast<int>(i % Vector::length())] = numbers[i];
    return vectors;
}

// Unsigned integers of 8, 16 or 32 bits, `components` an element, one after the other.
std::vector<std::uint32_t> read_indices(const GltfFile& file, int accessor, const std::string& what,
                                        int components = 1);

// The bytes of a bufferView: an embedded picture.
struct ByteRange {
    const unsigned char* first = nullptr;
    std::size_t size = 0;
};
ByteRange bytes_of_view(const GltfFile& file, int view, const std::string& what);

}  // namespace brisance
