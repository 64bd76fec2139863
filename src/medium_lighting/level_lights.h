// Light of the medium's own lights at the nodes of its lattice, or of a coarser one.
#pragma once

#include "medium_lighting/lit_lattice.h"
#include "scattering/multiple_scattering.h"

namespace brisance {

// Where to gather: level 0 is the medium's own lattice.
struct GatherTarget {
    int level;
    const ExtinctionPyramid& pyramid;
    LatticeRequest request;
    bool sparse;  // few of the lattice's nodes are requested
};

class LevelLights {
public:
    // `lights`: of the medium's own lattice, sharpened, from which those of coarser ones are made. Keeps references;
    // what is gathered is added to `costs`. `kept`: shadow maps of `lights` where all nodes of that lattice are
    // requested; null: none are kept.
    LevelLights(const LitLattice& lattice, const HierarchyLights& lights, float alpha, std::vector<LevelCost>& costs,
                Progress& progress, ShadowMapCache* kept = nullptr)
        : lattice_(lattice), lights_(lights), alpha_(alpha), costs_(costs), progress_(progress), kept_(kept) {}

    Gathered gather(const GatherTarget& target) const;

    // Scales light at all nodes of a coarser lattice such that it conserves energy there.
    void balance(const GatherTarget& target, Gathered& light) const;

private:
    ScatteredLight restricted_to(int level) const;

    const LitLattice& lattice_;
    const HierarchyLights& lights_;
    float alpha_;
    std::vector<LevelCost>& costs_;
    Progress& progress_;
    ShadowMapCache* kept_;
};

}  // namespace brisance
