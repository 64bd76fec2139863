#include "virtual_lights/technique.h"

#include <algorithm>
#include <array>
#include <tuple>

#include "core/error.h"
#include "virtual_lights/baselines.h"
#include "virtual_lights/choices.h"
#include "virtual_lights/compensations.h"
#include "virtual_lights/flux/deposit_flux.h"
#include "virtual_lights/flux/gathered_flux.h"
#include "virtual_lights/gatherers/all_lights.h"
#include "virtual_lights/gatherers/bsdf_rays.h"
#include "virtual_lights/gatherers/combined.h"
#include "virtual_lights/gatherers/lightcuts.h"
#include "virtual_lights/gatherers/one_light.h"
#include "virtual_lights/gatherers/resampled.h"
#include "virtual_lights/gatherers/stochastic_lightcuts.h"
#include "virtual_lights/kinds/patch_light.h"
#include "virtual_lights/kinds/point_light.h"
#include "virtual_lights/kinds/sphere_light.h"
#include "virtual_lights/placement/bidirectional.h"
#include "virtual_lights/placement/metropolis.h"
#include "virtual_lights/placement/rejection.h"
#include "virtual_lights/placement/relaxation.h"

namespace brisance {

namespace {

// The table. A new placement, kind or gatherer is a row here; names, help, refusals, presets and the product of all
// choices follow. The first row of each is the default.

constexpr std::array kPlacements = {
    Placement{"blue_noise", "where camera paths meet surfaces a second time, thinned out evenly", camera_deposits,
              thin_to_blue_noise, power_per_area, nullptr},
    Placement{"random", "any of those", camera_deposits, thin_at_random, power_per_area, nullptr},
    Placement{"light_paths", "where particles from fire and lamps arrive", light_path_deposits, thin_at_random,
              power_alone, light_path_flux},
    Placement{"relaxed_light_paths", "those of them near the camera's paths, thinned out evenly",
              relaxed_light_path_deposits, thin_to_blue_noise, equal_importance, nullptr},
    Placement{"repelled_light_paths", "the same, but begun at random and moved apart in steps",
              relaxed_light_path_deposits, thin_by_relaxation, equal_importance, nullptr},
    Placement{"rejection", "where they arrive, kept by what the camera sees of them", rejected_deposits, thin_at_random,
              equal_importance, rejected_flux},
    Placement{"bidirectional", "half of those, half of the camera's, by what the camera sees of them",
              bidirectional_deposits, thin_at_random, equal_importance, nullptr},
    Placement{"metropolis", "where particles mutated toward what the camera sees arrive", metropolis_deposits,
              thin_at_random, equal_importance, metropolis_flux}};

template <class T>
struct Row {
    using Type = T;
    const char* name;
    const char* help;
};

constexpr std::tuple kFluxes = {Row<GatheredFlux>{"gathered", "of all photons around the light"},
                                Row<DepositFlux>{"own", "of the one photon that placed the light"}};

constexpr std::tuple kKinds = {
    Row<PatchKind>{"patch", "the surface itself, interpolated between lights"},
    Row<SphereKind>{"sphere", "a sphere that reaches to a near light (sphere_neighbours)"},
    Row<PointKind>{"point", "a point with a bound on its geometry term (point_bound)"},
    Row<DiffusePointKind>{"diffuse_point", "the same, of the material's Lambert base alone"}};

constexpr std::tuple kGatherers = {
    Row<Combined<PowerChooser>>{"combined", "a light by power and a ray by BSDF, by the balance heuristic"},
    Row<Combined<TreeChooser>>{"combined_tree", "the same with a light by a tree of bounds"},
    Row<OneLight<PowerChooser>>{"power", "a light by power"},
    Row<OneLight<TreeChooser>>{"light_tree", "a light by a tree of bounds"},
    Row<OneLight<PlainPowerChooser>>{"plain_power", "a light by its own power, also where power is by area"},
    Row<OneLight<UniformChooser>>{"uniform", "a light, all alike"},
    Row<BsdfRays>{"bsdf", "a ray by BSDF"},
    Row<Resampled>{"resampled", "of several lights one by its unoccluded contribution"},
    Row<ResampledCombined>{"resampled_combined", "the same of lights by power and rays by BSDF"},
    Row<Lightcuts>{"lightcuts", "one light for each node of a cut through a tree, the same for all vertices"},
    Row<StochasticLightcuts>{"stochastic_lightcuts", "a random light of each node of a small cut"},
    Row<AllLights>{"all", "every light"}};

constexpr std::size_t kFluxCount = std::tuple_size_v<decltype(kFluxes)>;
constexpr std::size_t kKindCount = std::tuple_size_v<decltype(kKinds)>;
constexpr std::size_t kGathererCount = std::tuple_size_v<decltype(kGatherers)>;

// A kind of light with a flux: whether there is such a thing, and what gatherers need to know of it.
struct KindWithFlux {
    void (*fit)(LightSet&) = nullptr;  // null: the kind needs what the flux does not have
    decltype(Technique::single) single = nullptr;
    bool hittable = false, bounded = false;
    std::array<decltype(Technique::gather), kGathererCount> gather{};  // null: the gatherer needs what the kind lacks
};

template <class Family, class Kind>
constexpr decltype(Technique::gather) gather_from() {
    if constexpr (requires { typename Family::template Of<Kind>; })
        return [](const LightSet& set, LightImportance importance) -> std::unique_ptr<Gatherer> {
            return std::make_unique<typename Family::template Of<Kind>>(set, importance);
        };
    else
        return nullptr;
}

template <class Family, class Flux>
constexpr KindWithFlux kind_with_flux() {
    if constexpr (requires { typename Family::template Of<Flux>; }) {
        using Kind = typename Family::template Of<Flux>;
        static_assert(VirtualLightKind<Kind>);
        return {Kind::fit, single_lights_of<Kind>, Hittable<Kind>, Bounded<Kind>,
                std::apply(
                    [](const auto&... row) {
                        return std::array{gather_from<typename std::decay_t<decltype(row)>::Type, Kind>()...};
                    },
                    kGatherers)};
    } else {
        return {};
    }
}

using KindRow = std::array<KindWithFlux, kFluxCount>;

template <class Family>
constexpr KindRow kind_row() {
    return std::apply(
        [](const auto&... flux) {
            return KindRow{kind_with_flux<Family, typename std::decay_t<decltype(flux)>::Type>()...};
        },
        kFluxes);
}

// The product of kinds, fluxes and gatherers.
constexpr std::array<KindRow, kKindCount> kProduct = std::apply(
    [](const auto&... kind) { return std::array{kind_row<typename std::decay_t<decltype(kind)>::Type>()...}; }, kKinds);

template <class... Rows>
std::vector<TechniqueChoice> choices_of(const std::tuple<Rows...>& rows) {
    return std::apply([](const auto&... row) { return std::vector<TechniqueChoice>{{row.name, row.help}...}; }, rows);
}

template <class... Rows>
constexpr auto needs_of(const std::tuple<Rows...>&) {
    return std::array<const char*, sizeof...(Rows)>{Rows::Type::kNeeds...};
}
constexpr auto kGathererNeeds = needs_of(kGatherers);
constexpr auto kKindNeeds = needs_of(kKinds);

// Whether vertices can reuse what others chose.
template <class Family>
constexpr bool resamples() {
    if constexpr (requires { Family::kResamples; })
        return Family::kResamples;
    else
        return false;
}
constexpr auto kResamples = std::apply(
    [](const auto&... row) { return std::array{resamples<typename std::decay_t<decltype(row)>::Type>()...}; },
    kGatherers);

// In the order of the table.
template <class Rows, class Holds>
std::string names_where(const Rows& rows, const Holds& holds) {
    std::string out;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (holds(i))
            out += (out.empty() ? "" : ", ") + std::string(rows[i].name);
    return out.empty() ? "none" : out;
}

std::size_t index_of(const std::vector<TechniqueChoice>& choices, const std::string& key, const std::string& name) {
    for (std::size_t i = 0; i < choices.size(); ++i)
        if (choices[i].name == name)
            return i;
    throw Error(ExitCode::Usage, "virtual_lights." + key + ": \"" + name + "\" is not known; there are " +
                                     names_where(choices, [](std::size_t) { return true; }));
}

// Rows of the table.
struct Chosen {
    std::size_t placement, flux, kind, gatherer;
    const KindWithFlux& with_flux() const { return kProduct[kind][flux]; }
};

Chosen chosen(const VirtualLightSettings& s) {
    return {index_of(light_placements(), "placement", s.placement), index_of(light_fluxes(), "flux", s.flux),
            index_of(light_kinds(), "kind", s.kind), index_of(light_gatherers(), "sampling", s.sampling)};
}

constexpr auto kFromDeposits = std::apply(
    [](const auto&... row) { return std::array{std::decay_t<decltype(row)>::Type::kFromDeposits...}; }, kFluxes);

std::string flux_complaint(const Chosen& c) {
    if (kFromDeposits[c.flux] && !kPlacements[c.placement].flux_deposits)
        return "flux " + light_fluxes()[c.flux].name + " needs deposits that carry flux: placement " +
               names_where(kPlacements, [](std::size_t i) { return kPlacements[i].flux_deposits != nullptr; }) +
               ", not " + kPlacements[c.placement].name;
    return {};
}

std::string kind_complaint(const Chosen& c) {
    if (c.with_flux().fit)
        return {};
    const std::string kind = light_kinds()[c.kind].name, flux = light_fluxes()[c.flux].name;
    return "kind " + kind + " needs " + kKindNeeds[c.kind] + ": flux " +
           names_where(light_fluxes(), [&](std::size_t i) { return kProduct[c.kind][i].fit != nullptr; }) + "; flux " +
           flux + " goes with kind " +
           names_where(light_kinds(), [&](std::size_t i) { return kProduct[i][c.flux].fit != nullptr; });
}

// Kinds that have an ability with some flux.
template <class Has>
std::string kinds_that(const Has& has) {
    return names_where(light_kinds(),
                       [&](std::size_t i) { return std::any_of(kProduct[i].begin(), kProduct[i].end(), has); });
}

std::string gatherer_complaint(const Chosen& c) {
    if (!c.with_flux().fit || c.with_flux().gather[c.gatherer])
        return {};
    return "sampling " + light_gatherers()[c.gatherer].name + " needs " + kGathererNeeds[c.gatherer] + ": kind " +
           kinds_that([&](const KindWithFlux& k) { return k.gather[c.gatherer] != nullptr; }) + "; kind " +
           light_kinds()[c.kind].name + " goes with sampling " +
           names_where(light_gatherers(), [&](std::size_t i) { return c.with_flux().gather[i] != nullptr; });
}

std::string extension_complaint(const Chosen& c, bool path_extension) {
    if (!c.with_flux().fit || c.with_flux().hittable || !path_extension)
        return {};
    return std::string("path_extension needs ") + kHittable + ": kind " +
           kinds_that([](const KindWithFlux& k) { return k.hittable; }) + "; kind " + light_kinds()[c.kind].name +
           " goes with path_extension=false";
}

// Any other kind would ignore it.
std::string contribution_kind_complaint(const VirtualLightSettings& s) {
    return s.contribution_bound == kUnbounded ? std::string()
                                              : why_no_bound(s, "contribution_bound", "contribution_bound=none");
}

std::string reuse_complaint(const Chosen& c, int neighbours) {
    if (neighbours == 0 || kResamples[c.gatherer])
        return {};
    return "resampling_neighbours needs a sampling that resamples: " +
           names_where(light_gatherers(), [](std::size_t i) { return kResamples[i]; }) + "; sampling " +
           light_gatherers()[c.gatherer].name + " goes with resampling_neighbours=0";
}

// Neighbours whose choices presets reuse, and the rounds of one of them.
constexpr const char *kNeighbours = "4", *kRounds = "3";

std::vector<TechniquePreset> make_presets() {
    std::vector<TechniquePreset> out;
    for (const TechniqueChoice& gatherer : light_gatherers())
        if (out.empty())
            out.push_back({"vbnl", "virtual blue noise lighting", {}});
        else
            out.push_back({"vbnl_" + gatherer.name,
                           "the same lights, sampling " + gatherer.name + ": " + gatherer.help,
                           {{"sampling", gatherer.name}}});
    for (std::size_t i = 0; i < kGathererCount; ++i)
        if (kResamples[i]) {
            const std::string name = light_gatherers()[i].name;
            out.push_back({"vbnl_" + name + "_reused",
                           "vbnl_" + name + ", where pixels reuse what others around them chose",
                           {{"sampling", name}, {"resampling_neighbours", kNeighbours}}});
            out.push_back(
                {"vbnl_" + name + "_rounds",
                 "the same in several rounds, each of what the one before has kept",
                 {{"sampling", name}, {"resampling_neighbours", kNeighbours}, {"resampling_rounds", kRounds}}});
        }
    out.insert(out.end(), baselines().begin(), baselines().end());
    return out;
}

}  // namespace

const std::vector<TechniqueChoice>& light_placements() {
    static const std::vector<TechniqueChoice> all = [] {
        std::vector<TechniqueChoice> out;
        out.reserve(std::size(kPlacements));
        for (const Placement& row : kPlacements)
            out.push_back({row.name, row.help});
        return out;
    }();
    return all;
}

const std::vector<TechniqueChoice>& light_fluxes() {
    static const std::vector<TechniqueChoice> all = choices_of(kFluxes);
    return all;
}

const std::vector<TechniqueChoice>& light_kinds() {
    static const std::vector<TechniqueChoice> all = choices_of(kKinds);
    return all;
}

const std::vector<TechniqueChoice>& light_gatherers() {
    static const std::vector<TechniqueChoice> all = choices_of(kGatherers);
    return all;
}

const std::vector<TechniquePreset>& light_presets() {
    static const std::vector<TechniquePreset> all = make_presets();
    return all;
}

std::string help_of(const std::vector<TechniqueChoice>& choices) {
    std::string out;
    for (const TechniqueChoice& choice : choices)
        out += (out.empty() ? "" : "; ") + choice.name + ": " + choice.help;
    return out;
}

std::string why_no_bound(const VirtualLightSettings& settings, const std::string& what, const std::string& otherwise) {
    const Chosen c = chosen(settings);
    if (!c.with_flux().fit || c.with_flux().bounded)
        return {};
    return what + " needs " + kBounded + ": kind " + kinds_that([](const KindWithFlux& k) { return k.bounded; }) +
           "; kind " + light_kinds()[c.kind].name + " goes with " + otherwise;
}

std::string why_not_together(const VirtualLightSettings& settings) {
    const Chosen c = chosen(settings);
    std::string out;
    for (const std::string& complaint :
         {flux_complaint(c), kind_complaint(c), gatherer_complaint(c), extension_complaint(c, settings.path_extension),
          compensation_complaint(settings), contribution_complaint(settings), contribution_kind_complaint(settings),
          pixels_complaint(settings), reuse_complaint(c, settings.resampling_neighbours)})
        if (!complaint.empty())
            out += (out.empty() ? "" : "; and ") + complaint;
    return out;
}

Technique technique_of(const VirtualLightSettings& settings) {
    check(settings);
    const Chosen c = chosen(settings);
    constexpr auto kBuild = std::apply(
        [](const auto&... row) { return std::array{&std::decay_t<decltype(row)>::Type::build...}; }, kFluxes);
    return {&kPlacements[c.placement], kBuild[c.flux], c.with_flux().fit, c.with_flux().gather[c.gatherer],
            c.with_flux().single};
}

bool has_positions(const VirtualLightSettings& settings) {
    return !kFromDeposits[chosen(settings).flux];
}

}  // namespace brisance
