// The rays of a light's shadow map.
#pragma once

#include <cstdint>
#include <vector>

#include "medium/lattice/local_bounds.h"

namespace brisance {

// The texels of a map, in square tiles, so that rays of one vector run through the same smoke and become opaque in it,
// or leave it, at about the same distance.
struct TexelTable {
    static constexpr int kTile = 4;  // texels along a side
    static constexpr std::size_t kRays = std::size_t(kTile) * kTile;
    int resolution, tiles_aside;
    std::vector<vec3> direction;  // unit, of the rays of each tile in turn

    explicit TexelTable(int texels);
    std::size_t tiles() const { return std::size_t(tiles_aside) * tiles_aside; }
    // Of one of a tile's rays; past the map's edge where tiles do not fill it.
    glm::ivec2 texel_of(std::size_t tile, std::size_t ray) const {
        return kTile * glm::ivec2(int(tile) / tiles_aside, int(tile) % tiles_aside) +
               glm::ivec2(int(ray) / kTile, int(ray) % kTile);
    }
};

// The part of a map that receivers in the medium read: around the directions to the sphere about the medium. What lies
// aside is not made. Of lights inside the sphere, and for receivers outside, it is the whole map.
class SeenTexels {
public:
    // Keeps a reference. `distances`: of a texel. `whole`: for receivers outside.
    SeenTexels(const TexelTable& texels, const Medium& medium, int distances, bool whole);

    // `light`: local [m].
    void look_from(const vec3& light);

    // The rays to march, whole tiles, and where what they find belongs: rays() times the map's distances.
    std::size_t rays() const { return tiles_.size() * TexelTable::kRays; }
    const float* direction(int axis) const { return direction_[axis].data(); }  // nodes per metre
    std::uint16_t* marched() { return marched_.data(); }

    // Row by row.
    bool has(std::size_t texel) const { return seen_[texel] != 0; }
    // Copies what was marched to rows of texels. Those that are not seen begin with 0.
    void put_in_rows(std::uint16_t* rows) const;

private:
    // Calls visit(texel, ray) for those of a tile.
    template <class Visit>
    void for_texels(std::size_t tile, const Visit& visit) const;
    void mark(std::size_t tile, bool seen);

    const TexelTable& texels_;
    mat3 index_from_local_;
    LocalBounds bounds_;
    std::size_t distances_;
    bool whole_;
    std::vector<std::size_t> tiles_;
    std::vector<float> direction_[3];
    std::vector<std::uint16_t> marched_;
    std::vector<std::uint8_t> seen_;  // each texel
};

}  // namespace brisance
