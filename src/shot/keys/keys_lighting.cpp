#include "shot/keys/keys.h"

namespace brisance {

void add_lighting_keys(std::vector<Key>& keys) {
    keys.push_back(make_key(
        "lighting.error",
        "relative error that is asked of the picture: each of shadow maps, lattices and series of bounces may add so "
        "much; below 0.04 a correction by unbiased samples helps to reach it (correction.samples)",
        real_float({0.0, 1.0, true}), [](Shot & s) -> auto& { return s.lighting.error; }));
    keys.push_back(make_key(
        "lighting.lattice_error",
        "relative error that light on wider voxels may add to the picture before it has scattered; that of light of "
        "the smoke goes in proportion; auto: half of lighting.error, up to three times that beside a correction",
        or_word(real_float({0.0, 1.0}), "auto", -1.0f), [](Shot & s) -> auto& { return s.lighting.lattice_error; }));
    keys.push_back(make_key(
        "lighting.interpolation",
        "relative error of the light in smoke up to which it is interpolated from coarser nodes; 0: every node is lit; "
        "auto: a quarter of lighting.error where voxels twice as wide would add no more than lighting.error",
        or_word(real_float({0.0, 1.0}), "auto", -1.0f), [](Shot & s) -> auto& { return s.lighting.interpolation; }));
    keys.push_back(make_key(
        "lighting.lattice_level",
        "light in smoke is gathered on voxels 2^n wide; auto: as wide as lighting.lattice_error allows",
        or_word(whole(0, 8), "auto", -1), [](Shot & s) -> auto& { return s.lighting.lattice_level; }));
    keys.push_back(make_key(
        "lighting.smoke_lattice_level",
        "the same for light that smoke scatters on to smoke, on no finer ones; auto: as lighting.lattice_level where "
        "that is stated, or as wide as lighting.lattice_error allows",
        or_word(whole(0, 8), "auto", -1), [](Shot & s) -> auto& { return s.lighting.smoke_lattice_level; }));
    keys.push_back(make_key(
        "lighting.alpha", "a light of level l serves up to about alpha spacings of its level: larger is more exact",
        real_float({1.0, 64.0}), [](Shot & s) -> auto& { return s.lighting.alpha; }));
    keys.push_back(make_key(
        "lighting.levels", "of the hierarchy above the voxels; auto: from the volume's extent",
        or_word(whole(1, 24), "auto", 0), [](Shot & s) -> auto& { return s.lighting.levels; }));
    keys.push_back(make_key(
        "lighting.clusters",
        "for comparison: at most so many lamps in the place of the fire's lights, by k-means; 0: none", whole(0, 65536),
        [](Shot & s) -> auto& { return s.lighting.clusters; }));
    keys.push_back(make_key(
        "lighting.shadows", "maps: precomputed; exact: per light and point, slow; none: for study",
        choice<ShadowMethod>(
            {{"maps", ShadowMethod::Maps}, {"exact", ShadowMethod::Exact}, {"none", ShadowMethod::None}}),
        [](Shot & s) -> auto& { return s.lighting.shadows; }));
    keys.push_back(make_key(
        "lighting.shadow_resolution", "texels along one side of a light's octahedral map; auto: from lighting.error",
        or_word(whole(2, 256), "auto", 0), [](Shot & s) -> auto& { return s.lighting.shadow_resolution; }));
    keys.push_back(make_key(
        "lighting.shadow_distances", "transmittance samples along a texel's ray; auto: from lighting.error",
        or_word(whole(2, 256), "auto", 0), [](Shot & s) -> auto& { return s.lighting.shadow_distances; }));
    keys.push_back(make_key(
        "lighting.memory_limit_mebibytes",
        "for shadow maps [MiB]; their resolution is lowered to respect it, with a notice", mebibytes(1.0, 16777216.0),
        [](Shot & s) -> auto& { return s.lighting.memory_limit_bytes; }));
    keys.push_back(make_key(
        "lighting.energy_balance", "scale each bounce so that emitted = collided + escaped", flag(),
        [](Shot & s) -> auto& { return s.lighting.energy_balance; }));
    keys.push_back(make_key(
        "scattering.bounces", "0: emission only, 1: single scattering, all: until the remainder",
        or_word(whole(0, 10000), "all", -1), [](Shot & s) -> auto& { return s.scattering.bounces; }));
    keys.push_back(make_key(
        "scattering.remainder", "with all bounces: the share of the light that may be left over",
        real_float({0.0, 1.0, true, true}), [](Shot & s) -> auto& { return s.scattering.remainder; }));
    keys.push_back(make_key(
        "scattering.lattice_level",
        "bounces above one are solved on voxels 2^n wide; auto: as wide as lighting.error allows",
        or_word(whole(0, 16), "auto", -1), [](Shot & s) -> auto& { return s.scattering.lattice_level; }));
    keys.push_back(make_key(
        "scattering.fine_bounces",
        "bounces on the voxels of the light itself, after those that were solved on wider ones; auto: one, none where "
        "lighting.error is 0.01 or less",
        or_word(whole(0, 16), "auto", -1), [](Shot & s) -> auto& { return s.scattering.fine_bounces; }));
    keys.push_back(make_key(
        "scattering.alpha", "as lighting.alpha, for scattered light", real_float({1.0, 64.0}),
        [](Shot & s) -> auto& { return s.scattering.alpha; }));
    keys.push_back(make_key(
        "scattering.escape",
        "probability that scattered light leaves the smoke without another collision, by which scattering.method=auto "
        "and the light of lamps on smoke choose; auto: measured",
        or_word(real_float({0.0, 1.0}), "auto", -1.0f), [](Shot & s) -> auto& { return s.scattering.escape; }));
    keys.push_back(make_key(
        "scattering.solver",
        "what makes the bounces above one: hierarchy: lights with shadow maps; radiance_cascades: probes that look "
        "ahead by intervals; diffusion: all bounces at once, as heat that spreads",
        choice<ScatteringSolver>({{"hierarchy", ScatteringSolver::Hierarchy},
                                  {"radiance_cascades", ScatteringSolver::RadianceCascades},
                                  {"diffusion", ScatteringSolver::Diffusion}}),
        [](Shot & s) -> auto& { return s.scattering.solver; }));
    keys.push_back(make_key(
        "scattering.cascade_side",
        "with radiance_cascades: directions of the finest probes, n * n; coarser ones have up to 4 times as many each",
        whole(2, 32), [](Shot & s) -> auto& { return s.scattering.cascade_side; }));
    keys.push_back(make_key(
        "scattering.flux_limiter",
        "with diffusion: no more light flows than can travel; without, thin smoke spreads it too fast", flag(),
        [](Shot & s) -> auto& { return s.scattering.flux_limiter; }));
    add_scattering_method_keys(keys);
}

}  // namespace brisance
