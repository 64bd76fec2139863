// The table of scattering methods: who may own light that was scattered in the medium before its last scattering, the
// ledger's cells MM and SM. A method is one row: its type says its name, keys, presets, what it needs, and how it is
// made. What reads the table: the plan, `scattering.method` and the sections of the schema, `--help`, `brisance report`
// and `brisance stability`.
//
// The lighting grid, which keeps these cells at the medium's nodes, is no row: it is what every other method replaces.
#pragma once

#include <tuple>

#include "ray_lights/method.h"
#include "volumetric_photons/method.h"
#include "volumetric_vpls/method.h"

namespace brisance {

using ScatteringMethodList = std::tuple<RayLightsMethod, VolumetricVplsMethod, VolumetricPhotonsMethod>;

}  // namespace brisance
