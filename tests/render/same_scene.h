// Small scenes, and other representations of the same scene: the same extinction and emission at every point of space,
// and the same view of it.
//
// Fields are trilinear between nodes and 0 beyond the box, so that a lattice of half the spacing holds the same field
// without error, as does one with more zeros around it, a turned or a moved one, or the sum of two volumes that touch.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "fixtures/media.h"
#include "shot/shot.h"

namespace brisance::testing {

// Volumes that add up, and the shot that looks at them. All of a scene's volumes have the settings of `shot.medium`.
struct SameScene {
    std::string name;
    std::vector<Recipe> volumes;
    Shot shot;
    // NOLINTNEXTLINE(readability-identifier-naming): the name that gtest calls
    friend void PrintTo(const SameScene& scene, std::ostream* out) { *out << scene.name; }
};

// A ball of uneven smoke of 1 m and some 5 mean free paths in radius, with a fire in its core.
SameScene smoke_ball(float mean_cosine);
// A burst of 18 mean free paths in radius, which burns at its skin, too, in a box of haze 2 m wide and 0.4 mean free
// paths across.
SameScene burst_in_haze(float mean_cosine);
// The burst in a veil of haze that has about as many voxels as the burst.
SameScene burst_in_veil();
// A box of haze 4 m and one mean free path across, around a fire that is no smoke.
SameScene fire_in_haze();

// Other representations. Zeros are voxels of the file.
SameScene cropped(SameScene scene);  // to the voxels above zero
SameScene padded(SameScene scene, const ivec3& low, const ivec3& high);
SameScene finer(SameScene scene);                              // voxels of half the edge
SameScene turned(SameScene scene);                             // by 90 degrees about x, voxel by voxel
SameScene turned_by_transform(SameScene scene);                // by 90 degrees about z, in the transform
SameScene moved(SameScene scene, const dvec3& voxels);         // with its camera
SameScene split(const SameScene& scene, int first_of_second);  // into volumes that touch, along x

}  // namespace brisance::testing
