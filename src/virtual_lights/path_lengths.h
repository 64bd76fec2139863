// Lengths of the paths that end at virtual lights, per pixel.
#pragma once

#include <cstdint>
#include <vector>

namespace brisance {

// Not thread-safe.
class PathLengths {
public:
    explicit PathLengths(std::size_t pixels) : paths_(pixels, 0), vertices_(pixels, 0) {}

    // Adds one path with `vertices` scatterings, counted from the first surface of the pixel; 0: there was no path.
    void add(std::uint32_t pixel, int vertices) {
        paths_[pixel] += vertices > 0 ? 1 : 0;
        vertices_[pixel] += static_cast<std::uint32_t>(vertices);
    }

    // Mean number of vertices of the paths of each pixel; 0 where there were none.
    std::vector<float> means() const {
        std::vector<float> out(paths_.size(), 0.0f);
        for (std::size_t p = 0; p < out.size(); ++p)
            if (paths_[p] > 0)
                out[p] = static_cast<float>(double(vertices_[p]) / paths_[p]);
        return out;
    }

private:
    std::vector<std::uint32_t> paths_, vertices_;
};

}  // namespace brisance
