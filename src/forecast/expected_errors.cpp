#include "forecast/expected_errors.h"

#include <algorithm>
#include <cmath>

#include "gathering/map_layouts.h"
#include "medium/extinction_met.h"
#include "medium_lighting/levels/lattice_errors.h"
#include "medium_lighting/levels/lighting_level.h"

namespace brisance {

namespace {

// Shadow maps of 12^2 texels add 1 % to a picture of dense smoke, and the error falls as the resolution's power 4/3
// (gathering/map_layouts.cpp).
constexpr double kErrorOfMaps = 0.01, kResolutionOfMaps = 12.0, kPowerOfMaps = 4.0 / 3.0;
// The orders of scattering err with the optical depth of a voxel of their lattice. After a bounce on the light's own
// lattice this counts less, and the gather on that lattice remains.
constexpr double kErrorOfLattice = 0.045, kErrorOfLatticeBefore = 0.0105, kErrorOfFineBounce = 0.066;
// Fire seen directly: the camera's samples, over lighting.error, which they follow; and beyond them voxels that hide
// what burns in them.
constexpr double kErrorOfRays = 0.12, kErrorOfBurningVoxels = 0.002;
// Of light that surfaces and lamps send on or receive, and of scattering methods with random samples: not modelled, but
// as it often is in rooms and on floors.
constexpr double kErrorOfSurfaces = 0.05, kErrorOfSurfacesOnSmoke = 0.1, kErrorOfOtherMethods = 0.05;

// ExpectedError::spread of what the model knows, of fire seen directly, and of what it guesses.
constexpr double kSpread = 0.35, kSpreadOfRays = 0.5, kSpreadOfRest = 0.8;

double square(double x) {
    return x * x;
}

// An error is hardly ever more than the light itself.
double limited(double error) {
    return error / (1.0 + error);
}

// No cell's: errors of the picture that its light on surfaces has for want of samples.
const std::string kNoiseOfShading = "noise of shading";

const std::string kLattice = "lattice of the light";
const std::string kSeries = "orders of scattering on the coarse lattice";

// A number that a stage noted.
double noted(const Statistics& statistics, const std::string& stage, const char* key, double otherwise = 0.0) {
    for (const StageCost& s : statistics.stages)
        if (s.name == stage && s.detail.contains(key) && s.detail[key].is_number())
            return s.detail[key].get<double>();
    return otherwise;
}

// What noise leaves on surfaces, over the picture, whose sum of squares is `all`.
ExpectedError error_of_shading(const Statistics& statistics, double all) {
    return {kNoiseOfShading, all > 0.0 ? noted(statistics, "camera", "error_of_shading") / std::sqrt(all) : 0.0,
            kSpread};
}

// What noise leaves in light that pixels share: the root of the sum of squares over pixels and channels, which the
// camera expected from its samples [W/(m^2 sr)].
double error_of_shared(const Statistics& statistics, const std::string& cell) {
    for (const StageCost& s : statistics.stages)
        if (s.name == "camera" && s.detail.contains("errors_of_shared_light"))
            return s.detail["errors_of_shared_light"].value(cell, 0.0);
    return 0.0;
}

// Of a voxel, as a collision meets it.
double voxel_depth(const Medium& medium) {
    return medium.spacing * extinction_met(medium.extinction);
}

class ErrorModel {
public:
    // `coarse_light`: the error of light on a coarser lattice than the medium's, before it has scattered.
    // `interpolation`: what interpolation between nodes may add.
    // `smoke_level`: lattice of light that has. `fine_bounces`: the share of the light of the orders, on a lattice of
    // `lattice_level`, that they replace.
    ErrorModel(const ModelledFrame& frame, double coarse_light, double interpolation, double smoke_level,
               double lattice_level, double fine_bounces, double remainder)
        : plan_(frame.plan),
          coarse_light_(coarse_light),
          interpolation_(interpolation),
          depth_(voxel_depth(frame.medium)),
          orders_(depth_ * std::exp2(smoke_level) *
                  error_of_orders(std::exp2(lattice_level - smoke_level), fine_bounces)),
          remainder_(remainder),
          rays_(kErrorOfRays * frame.shot.lighting.error) {
        const LightingSettings& settings = frame.shot.lighting;
        if (settings.shadows == ShadowMethod::Maps)
            maps_ = kErrorOfMaps * std::pow(kResolutionOfMaps / shadow_resolution(settings), kPowerOfMaps);
    }

    // `share`: of the cell, of the picture's light.
    ExpectedError of(const std::string& cell, double share = 1.0) const {
        const double gathered = square(maps_) + square(interpolation_);
        if (cell == "V" || cell == "A")
            return {cell, limited(rays_ + kErrorOfBurningVoxels * std::pow(depth_, 3.0)), kSpreadOfRays};
        if ((cell == "MV" && plan_.on_rays.contains(Cell::MV)) || (cell == "SV" && plan_.fire_lights_on_surfaces()))
            return {cell, kErrorOfOtherMethods, kSpreadOfRest};
        if (cell == "MV")
            return {cell,
                    limited(std::hypot(std::sqrt(gathered), error_of_voxels(float(depth_)) + coarse_light(share))),
                    kSpread};
        if (cell == "MM")
            return mixed({cell, limited(std::sqrt(gathered + square(orders_)) + remainder_), kSpread});
        const ExpectedError rest{cell, cell == "MS" ? kErrorOfSurfacesOnSmoke : kErrorOfSurfaces, kSpreadOfRest};
        return cell == "SM" ? mixed(rest) : rest;
    }

private:
    // Relative to the cell. The coarse lattice's error is that of the picture, and light of the smoke has half of its
    // square. Of a cell that the picture hardly shows it is not known.
    double coarse_light(double share) const { return std::sqrt(0.5) * coarse_light_ / std::max(share, 0.1); }

    // Over the optical depth of a voxel of the light. `width`: of the orders' voxels, in those.
    static double error_of_orders(double width, double fine_bounces) {
        return fine_bounces * std::hypot(kErrorOfFineBounce, kErrorOfLatticeBefore * width) +
               (1.0 - fine_bounces) * kErrorOfLattice * width;
    }

    // A scattering method's share of the cell's light errs by itself.
    ExpectedError mixed(const ExpectedError& grid) const {
        const double share = plan_.share_of_method;
        return {grid.cell, std::hypot((1.0 - share) * grid.error, share * kErrorOfOtherMethods),
                grid.spread + share * (kSpreadOfRest - grid.spread)};
    }

    const Plan& plan_;
    double coarse_light_, interpolation_, depth_, orders_, remainder_, rays_, maps_ = 0.0;
};

// The cell that is taken for the picture where nothing is known of their shares.
const char* brightest(const Plan& plan) {
    return plan.multiple ? "MM" : plan.single ? "MV" : "V";
}

}  // namespace

std::vector<ExpectedError> expected_errors(const Image& image, const ModelledFrame& frame, const Statistics& statistics,
                                           const std::function<void(ExpectedError&)>& change) {
    const ErrorModel model(
        frame, noted(statistics, kLattice, "error"), noted(statistics, kLattice, "interpolation"),
        noted(statistics, kLattice, "smoke_lattice_level"), noted(statistics, kSeries, "lattice_level"),
        noted(statistics, kSeries, "share_of_fine_bounces"), noted(statistics, kSeries, "estimated_remainder"));
    std::vector<ExpectedError> out(1);
    const double all = sum_of_squares(image.layer(""));
    double errors = 0.0, spreads = 0.0, light = 0.0;
    const auto add = [&](ExpectedError& e, double part) {
        if (change)
            change(e);
        const double error = part * square(e.error);
        errors += error;
        spreads += square(error * e.spread);
    };
    for (const std::string& cell : frame.plan.cells())
        for (const Layer& layer : image.layers)
            if (const double part = layer.name == cell ? sum_of_squares(layer) : 0.0; part > 0.0) {
                out.push_back(model.of(cell, std::sqrt(part / all)));
                if (const double shared = error_of_shared(statistics, cell); shared > 0.0)
                    out.back().error = limited(std::hypot(out.back().error, shared / std::sqrt(part)));
                add(out.back(), part);
                light += part;
            }
    ExpectedError shading = error_of_shading(statistics, all);
    add(shading, all);
    // Errors of cells are taken to be independent, and each moves the picture's by the part of it that it makes. A
    // picture without layers of cells errs as its brightest scattering.
    if (all > 0.0)
        out[0] = light > 0.0
                     ? ExpectedError{"", std::sqrt(errors / all), errors > 0.0 ? std::sqrt(spreads) / errors : 0.0}
                     : model.of(brightest(frame.plan));
    out[0].cell.clear();
    return out;
}

Shot as_solved(const Shot& shot, const Statistics& statistics) {
    Shot out = shot;
    // Light between two lattices cannot be stated, nor one lattice without the other.
    if (noted(statistics, kLattice, "share_of_coarser_level", 1.0) == 0.0 &&
        noted(statistics, kLattice, "smoke_share_of_coarser_level", 1.0) == 0.0) {
        out.lighting.lattice_level = static_cast<int>(noted(statistics, kLattice, "lattice_level"));
        out.lighting.smoke_lattice_level = static_cast<int>(noted(statistics, kLattice, "smoke_lattice_level"));
    }
    if (noted(statistics, kSeries, "nodes") > 0.0)
        out.scattering.lattice_level = static_cast<int>(noted(statistics, kSeries, "lattice_level"));
    return out;
}

ExpectedError expected_error(const ModelledFrame& frame) {
    const ScatteringSettings settings = orders_of(frame.shot);
    const LightingLevels levels = lighting_levels(frame.medium, frame.shot.lighting);
    const LatticeChoice series = forecast_lattice(frame.shot, frame.medium, levels.smoke.level);
    ExpectedError out =
        ErrorModel(frame, levels.first.error, levels.interpolation, levels.smoke.level,
                   levels.smoke.level + series.level,
                   share_of_fine_bounces(series, settings, frame.shot.lighting.error), settings.remainder)
            .of(brightest(frame.plan));
    out.cell.clear();
    return out;
}

}  // namespace brisance
