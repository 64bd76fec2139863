// Input of the lighting of a medium.
#pragma once

#include "emitters/surroundings.h"
#include "gathering/settings.h"
#include "medium/medium.h"
#include "medium_lighting/stages/specular_photons.h"
#include "medium_lighting/stages/virtual_lights_as_points.h"
#include "scattering/settings.h"

namespace brisance {

// Light that surfaces send into the medium.
struct ReflectedLight {
    const PointsOfSides* lights = nullptr;  // null: none
    const SpecularPhotons* cast = nullptr;  // null: none
};

// Everything by reference must outlive the lighting.
struct MediumLightingInput {
    const Medium& medium;
    vec3 eye;           // of the camera, local [m]
    float pixel_angle;  // width of a pixel per metre of distance
    LightingSettings lighting;
    ScatteringSettings scattering;
    const Surroundings* surroundings = nullptr;  // null: none
    ReflectedLight reflected = {};

    // Light to be computed.
    bool fire = false;                // something emits, and MV, MM or SV begin with it
    bool single = false;              // MV
    bool multiple = false;            // MM
    bool surfaces_on_medium = false;  // MS
    bool emitters_on_medium = false;  // MA, or its share of MM
    float emitters_at_nodes = 1.0f;   // the share of MA that nodes hold; the rest: along the camera's rays
    bool fire_on_surfaces = false;    // SV: lights of the fire are kept for receivers on surfaces
    bool smoke_on_surfaces = false;   // SM: the same of the smoke
    bool directional = false;         // anisotropic phase function: light keeps its direction
    bool orders_apart = false;        // orders of scattering are kept for layers of their own
};

}  // namespace brisance
