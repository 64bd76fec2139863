#include "shadows/seen_texels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "medium/phase.h"
#include "shadows/octahedral_directions.h"

namespace brisance {

namespace {

// How far apart in direction texels that are interpolated lie at most, times the resolution [rad]: 8.5, those across a
// cell in the middle of a face of the octahedron.
constexpr float kTexelAngle = 9.0f;

}  // namespace

TexelTable::TexelTable(int texels) : resolution(texels), tiles_aside((texels + kTile - 1) / kTile) {
    const auto middle = [&](int texel) { return (2.0f * float(texel) + 1.0f) / float(texels) - 1.0f; };
    for (std::size_t tile = 0; tile < tiles(); ++tile)
        for (std::size_t ray = 0; ray < kRays; ++ray) {
            // Past the edge, the last texel is repeated.
            const glm::ivec2 at = glm::min(texel_of(tile, ray), glm::ivec2(texels - 1));
            direction.push_back(octahedral_direction(middle(at.x), middle(at.y)));
        }
}

SeenTexels::SeenTexels(const TexelTable& texels, const Medium& medium, int distances, bool whole)
    : texels_(texels),
      index_from_local_(medium.index_from_local),
      bounds_(local_bounds(medium)),
      distances_(std::size_t(distances)),
      whole_(whole),
      seen_(std::size_t(texels.resolution) * texels.resolution) {}

void SeenTexels::look_from(const vec3& light) {
    const vec3 to = bounds_.middle() - light;
    const float distance = glm::length(to), radius = 0.5f * bounds_.diagonal();
    const float angle =
        whole_ || radius >= distance ? kPi : std::asin(radius / distance) + kTexelAngle / float(texels_.resolution);
    const float least = angle < kPi ? distance * std::cos(angle) : -std::numeric_limits<float>::infinity();
    tiles_.clear();
    for (auto& d : direction_)
        d.clear();
    for (std::size_t tile = 0; tile < texels_.tiles(); ++tile) {
        const std::span rays = std::span(texels_.direction).subspan(tile * TexelTable::kRays, TexelTable::kRays);
        const bool seen = std::ranges::any_of(rays, [&](const vec3& d) { return glm::dot(d, to) >= least; });
        mark(tile, seen);
        for (std::size_t ray = 0; seen && ray < rays.size(); ++ray)
            for (int a = 0; a < 3; ++a)
                direction_[a].push_back((index_from_local_ * rays[ray])[a]);
    }
    marched_.resize(rays() * distances_);
}

void SeenTexels::put_in_rows(std::uint16_t* rows) const {
    for (std::size_t texel = 0; texel < seen_.size(); ++texel)
        if (!has(texel))
            rows[texel * distances_] = 0;
    const std::uint16_t* from = marched_.data();
    for (const std::size_t tile : tiles_) {
        for_texels(tile, [&](std::size_t texel, std::size_t ray) {
            std::copy_n(from + ray * distances_, distances_, rows + texel * distances_);
        });
        from += TexelTable::kRays * distances_;
    }
}

template <class Visit>
void SeenTexels::for_texels(std::size_t tile, const Visit& visit) const {
    for (std::size_t ray = 0; ray < TexelTable::kRays; ++ray) {
        const glm::ivec2 at = texels_.texel_of(tile, ray);
        if (at.x < texels_.resolution && at.y < texels_.resolution)
            visit(std::size_t(at.x) * texels_.resolution + at.y, ray);
    }
}

void SeenTexels::mark(std::size_t tile, bool seen) {
    if (seen)
        tiles_.push_back(tile);
    for_texels(tile, [&](std::size_t texel, std::size_t) { seen_[texel] = seen; });
}

}  // namespace brisance
