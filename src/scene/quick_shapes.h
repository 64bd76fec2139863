// Quads and spheres that a shot gives by their numbers.
#pragma once

#include "core/progress.h"
#include "scene/memory_budget.h"
#include "scene/scene.h"
#include "scene/settings.h"

namespace brisance {

// Two triangles of the corners 0 1 2 and 0 2 3. Without area it is left out with a warning; not being flat costs a
// warning.
void add_quad(const QuickQuad& quad, const std::string& name, Scene& scene, Progress& progress);

// A light of kind Quad: black, and emits from its front only. `extent`: Scene::largest_coordinate() of what is there.
void add_quad_light(const LightSettings& light, double extent, Scene& scene, Progress& progress);

// 20480 triangles with their corners on the sphere, whose area is 0.03 % below the sphere's, and with the sphere's own
// normals. Throws Error BadData when the radius is not above 0.
void add_sphere(const QuickSphere& sphere, const std::string& name, Scene& scene, MemoryBudget& budget);

}  // namespace brisance
