// The table of scattering methods, which may compute light that scattered in the medium before its last scattering, the
// ledger's cells MM and SM. A method is one row: its type defines its name, keys, presets, requirements and
// construction. The table is read by the plan, `scattering.method` and the sections of the schema, `brisance report`
// with its help, and `brisance stability`.
//
// The lighting grid, which stores these cells at the medium's nodes, is not a row: every other method replaces it.
#pragma once

#include <tuple>

#include "photon_density/method.h"
#include "ray_lights/method.h"
#include "volumetric_photons/method.h"
#include "volumetric_vpls/method.h"

namespace brisance {

using ScatteringMethodList =
    std::tuple<RayLightsMethod, VolumetricVplsMethod, VolumetricPhotonsMethod, PhotonDensityMethod>;

}  // namespace brisance
