#include "medium/voxel_size.h"

#include <algorithm>

namespace brisance {

float longest_edge(const Medium& medium) {
    float longest = 0.0f;
    for (int a = 0; a < 3; ++a)
        longest = std::max(longest, glm::length(medium.local_from_index[a]));
    return longest;
}

float longest_diagonal(const Medium& medium) {
    float longest = 0.0f;
    for (int k = 0; k < 4; ++k) {
        const vec3 corner(1.0f, k & 1 ? 1.0f : -1.0f, k & 2 ? 1.0f : -1.0f);
        longest = std::max(longest, glm::length(medium.local_from_index * corner));
    }
    return longest;
}

}  // namespace brisance
