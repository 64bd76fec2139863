// How light from surfaces is gathered: where virtual lights lie, what kind they are, and how a path vertex samples
// them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

namespace brisance {

enum class LightRadius {
    Adaptive,  // small where many camera paths arrive
    Uniform    // one for all
};

// How directions toward a spherical light are sampled.
enum class SphereSampling { Combined, Cone, Vertex, Light };

// What the bound of point lights is on.
enum class BoundedTerm {
    LightCosine,  // the light's cosine over squared distance
    BothCosines   // the whole geometry term
};

// No light is above it.
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// What makes up for the light that the bound takes away.
enum class BoundCompensation : std::uint8_t {
    None,
    Exact,       // paths find it
    ScreenSpace  // it is taken from what pixels show
};

// As many photons as the lights need (photons_needed), up to most_automatic_photons().
inline constexpr int kAutomaticPhotons = -1;
// A photon takes some two microseconds, a sample of a surface ten and more.
inline constexpr double kAutomaticPhotonsOfSample = 16.0;
inline constexpr double kManyPhotons = 1e6, kMostAutomaticPhotons = 8e6;

// `samples`: of surfaces, of the whole picture. A million photons are worth while for the smallest.
inline std::size_t most_automatic_photons(double samples) {
    return static_cast<std::size_t>(
        std::clamp(kAutomaticPhotonsOfSample * samples, kManyPhotons, kMostAutomaticPhotons));
}

// Placement, flux, kind and sampling are names; choices.h lists them and says which go together.
struct VirtualLightSettings {
    int count = 12000;  // virtual lights; 0: none, all surface light is found by paths
    int passes = 1;     // pictures that are averaged, each with lights of its own
    int window = 0;     // of a sequence: frames from one set of positions to the next; 0: each frame has its own
    std::string placement = "blue_noise";
    std::string flux = "gathered";
    std::string kind = "patch";
    double point_bound = 100.0;  // kind point: upper bound on cosine over squared distance [1/m^2]
    BoundedTerm point_bound_of = BoundedTerm::LightCosine;
    double contribution_bound = kUnbounded;  // kind point: upper bound on what a light adds to a vertex, luminance
    BoundCompensation compensation = BoundCompensation::None;  // kind point: of what the bound takes away
    int sphere_neighbours = 10;     // kind sphere: its radius is the distance to the neighbour of this number
    double sphere_shrinking = 0.7;  // kind sphere: alpha of radius_shrunk() over passes; 1: the radius stays
    double sphere_scale = 1.0;      // ... and by how much the radius has shrunk, no key of its own
    int sphere_samples = 4;         // kind sphere: directions sampled for each light
    SphereSampling sphere_sampling = SphereSampling::Combined;
    double candidates_per_pixel = 0.25;  // camera paths; never fewer than eight per light
    double importance_floor = 0.05;      // placements rejection, metropolis: share of lights that no one needs to see
    LightRadius radius = LightRadius::Adaptive;
    int neighbours = 128;             // candidates from whose distance their density is estimated
    double radius_factor = 1.1;       // radius over the distance that a light would keep from others
    int photons = kAutomaticPhotons;  // particles from fire and emitters; 0: no lights
    double picture_error = 0.02;      // what automatic photons follow: lighting.error of the shot, no key of its own
    bool light_smoke = false;         // lights have spots (flux_spots.h), no key of its own
    int profile_resolution = 16;      // of directions of lights that are not plain Lambert: texels along a side
    std::string sampling = "combined";
    int light_samples = 1;                 // sampling power, plain_power, uniform, light_tree: lights at every vertex
    int resampling_candidates = 32;        // sampling resampled, resampled_combined: lights to choose from
    int resampling_rays = 1;               // sampling resampled_combined: rays by BSDF beside them
    int resampling_neighbours = 0;         // both: samples of pixels around whose lights are reused; 0: none
    double resampling_radius = 8.0;        // ... from how far [pixels]
    int resampling_rounds = 1;             // ... in so many rounds, of what the one before has kept
    bool resampling_visibility = true;     // ... as far as they are seen by those that chose them
    bool resampling_transmittance = true;  // both: candidates count the smoke before them, coarsely
    double lightcuts_error = 0.02;         // sampling lightcuts: what a node may err, over the sum of all
    int lightcuts_most = 1000;             // ... and the most nodes of a cut
    int stochastic_cut_size = 10;          // sampling stochastic_lightcuts: nodes of a cut, each with one light
    bool path_extension = true;            // paths continue where a ray's footprint covers few lights
    double n_min = 40.0;                   // lights in the footprint: with fewer the path continues, ...
    double n_max = 80.0;                   // ... with more it ends; between them it does both in part
    double sharing_radius = 0.2;  // pixels share light on matt surfaces: over the distance to others; 0: none does
    std::uint32_t seed = 0;       // other seeds draw other random numbers
};

// Those of a pass, counted from 0: with a seed of its own, and spheres that shrink from pass to pass, so that the mean
// of many passes has neither their blur nor their noise. It is consistent where the kind loses nothing to a bound.
VirtualLightSettings settings_of_pass(VirtualLightSettings settings, int pass);

// The values that a setting may have, both ends included unless the flag says otherwise.
template <class T>
struct SettingRange {
    T low;
    T high;
    bool without_low = false;
    constexpr bool contains(T value) const { return (without_low ? value > low : value >= low) && value <= high; }
};

// The keys of a shot and the renderer's own check both read these.
struct VirtualLightRanges {
    static constexpr double kUnlimited = std::numeric_limits<double>::infinity();
    static constexpr SettingRange<int> count{0, 100000000};
    static constexpr SettingRange<int> passes{1, 65536};
    static constexpr SettingRange<int> window{0, 100000};
    static constexpr SettingRange<double> point_bound{0.0, kUnlimited, true};
    static constexpr SettingRange<double> contribution_bound{0.0, kUnlimited, true};
    static constexpr SettingRange<int> sphere_neighbours{1, 100000};
    static constexpr SettingRange<double> sphere_shrinking{0.0, 1.0, true};
    static constexpr SettingRange<int> sphere_samples{1, 65536};
    static constexpr SettingRange<double> candidates_per_pixel{0.0, 1000.0};
    static constexpr SettingRange<int> neighbours{1, 100000};
    static constexpr SettingRange<double> radius_factor{0.0, 10.0, true};
    static constexpr SettingRange<int> photons{0, 2000000000};
    static constexpr SettingRange<int> profile_resolution{2, 128};
    static constexpr SettingRange<int> resampling_candidates{1, 65536};
    static constexpr SettingRange<double> importance_floor{0.0, 1.0, true};
    static constexpr SettingRange<int> light_samples{1, 65536};
    static constexpr SettingRange<int> resampling_rays{1, 65536};
    static constexpr SettingRange<int> resampling_neighbours{0, 32};
    static constexpr SettingRange<double> resampling_radius{0.0, 128.0};
    static constexpr SettingRange<int> resampling_rounds{1, 8};
    static constexpr SettingRange<double> lightcuts_error{0.0, 1.0};
    static constexpr SettingRange<int> lightcuts_most{1, 100000000};
    static constexpr SettingRange<int> stochastic_cut_size{1, 1000000};
    static constexpr SettingRange<double> sharing_radius{0.0, 1.0};
    static constexpr SettingRange<double> n_min{0.0, kUnlimited};  // and not above n_max
    static constexpr SettingRange<double> n_max{0.0, kUnlimited};
};

}  // namespace brisance
