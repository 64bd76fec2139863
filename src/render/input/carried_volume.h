// Volumes that a node of a glTF file carries (VolumeSettings::node), and the velocity that this gives to their smoke.
#pragma once

#include "medium/medium.h"
#include "shot/shot.h"

namespace brisance {

// The places of one node.
class Carrier {
public:
    // Keeps a reference to the shot.
    Carrier(const Shot& shot, std::string node);

    // World from node at a frame of the shot. Throws Error Usage when no glTF file of the shot has the node, else as
    // load_scene.
    dmat4 at(double frame) const;

private:
    const Shot& shot_;
    std::string node_;
};

// The velocity that a place in the world has at `frame`, if the node carries it [m per frame]: an affine map, the mean
// over the time for which the shutter is open. What turns moves along tangents.
dmat4 carried_velocity(const Carrier& carrier, double frame, const ShutterSettings& shutter);

// Adds it to the velocity of the grids; to grids without velocity it gives one. Nothing changes where nothing moves.
void add_carried_velocity(const dmat4& carried, MediumGrids& grids);

}  // namespace brisance
