#include "camera_rays/secondary_field.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "camera_rays/ray_sum.h"

namespace brisance {

namespace {

// A voxel's extinction is that of its middle up to this optical depth, and that of two Gauss points beyond: then its
// depth is exact. The middle of such a part stands for the depth from which its light leaves up to the second.
constexpr float kThinVoxel = 0.1f, kThinPart = 0.2f;
constexpr double kGauss = 0.21132487;

Rgb colour(const SecondaryRecord& r, int slot) {
    return {r.value[slot], r.value[slot + 1], r.value[slot + 2]};
}

}  // namespace

SecondaryField::SecondaryField(const SourceField& field)
    : field_(field),
      index_from_local_(glm::inverse(dmat3(field.medium().world_from_index))),
      made_(field.bricks().brick_count()) {}

const SecondaryField::Records& SecondaryField::records(std::size_t brick) const {
    return made_.get(brick, [&] {
        auto out = std::make_unique<Records>();
        field_.put_secondary(brick, *out);
        return out;
    });
}

SecondaryField::Seen SecondaryField::along(const Ray& ray, double end) const {
    Seen seen;
    const float opaque = std::exp(-kOpaqueDepth);
    const double length_of_voxel = field_.medium().spacing;
    const auto see_part = [&](const Records& records, const VoxelSegment& s, SecondaryRecord here) {
        const auto length = static_cast<float>(s.end - s.begin);
        const float extinction = here.value[SecondaryRecord::Extinction], tau = extinction * length;
        if (tau > kThinPart)
            here = interpolated(records.data(), position_in_brick(s, s.begin + double(mean_depth(tau) / extinction)));
        const float path = seen.transmittance * length * phi1(tau), opacity = path * extinction;
        seen.emission += colour(here, SecondaryRecord::V) * (field_.direct_emission() ? path : opacity);
        seen.scattered += colour(here, SecondaryRecord::Scattered) * opacity;
        seen.transmittance -= opacity;
        seen.closeness += opacity / static_cast<float>(std::max(s.end, length_of_voxel));
    };
    const auto see_voxel = [&](const Records& records, const VoxelSegment& s) {
        const double length = s.end - s.begin, middle = 0.5 * (s.begin + s.end);
        const SecondaryRecord here = interpolated(records.data(), position_in_brick(s, middle));
        if (here.value[SecondaryRecord::Extinction] * float(length) <= kThinVoxel) {
            see_part(records, s, here);
        } else {
            VoxelSegment half = s;
            half.end = middle;
            see_part(records, half, interpolated(records.data(), position_in_brick(s, s.begin + kGauss * length)));
            half.begin = middle;
            half.end = s.end;
            see_part(records, half, interpolated(records.data(), position_in_brick(s, s.end - kGauss * length)));
        }
        return seen.transmittance > opaque;
    };
    const BrickLattice& bricks = field_.bricks();
    const bool leaves =
        walk_bricks(bricks, lattice_ray(bricks, index_from_local_, field_.medium().reference_node, ray, end),
                    [&](const VoxelSegment& s) {
                        const Records& of_brick = records(s.brick);
                        return walk_cubes<1>(s, [&](const VoxelSegment& voxel) { return see_voxel(of_brick, voxel); });
                    });
    if (!leaves)
        seen.transmittance = 0.0f;
    return seen;
}

}  // namespace brisance
