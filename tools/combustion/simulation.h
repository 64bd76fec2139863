// A burst of burning fuel over a solid floor: low-speed flow of a hot gas that expands as it burns, rises, rolls up,
// makes soot and cools by radiating through it.
// References
// [1] Nguyen, Fedkiw & Jensen, Physically Based Modeling and Animation of Fire, SIGGRAPH 2002: cooling (eq. 13),
//     buoyancy and confinement on a marker-and-cell grid.
// [2] Feldman, O'Brien & Arikan, Animating Suspended Particle Explosions, SIGGRAPH 2003: expansion as a divergence
//     imposed on the pressure solve.
// [3] Fedkiw, Stam & Jensen, Visual Simulation of Smoke, SIGGRAPH 2001: vorticity confinement (eq. 9-11).
// [4] Majda & Sethian, The derivation and numerical solution of the equations for zero Mach number combustion,
//     Combust. Sci. Technol. 42, 1985: div u = (1/T) DT/Dt at constant pressure.
// [5] Dopazo & O'Brien, An approach to the autoignition of a turbulent mixture, Acta Astronautica 1, 1974: mixing
// within
//     a cell as relaxation to the mean. Without it every cell that the cloud's edge crosses would be lukewarm at once,
//     a dark skin one cell thick that shows the grid through black-body radiation's steep rise.
// Departs from [1]: cooling is scaled by the share of radiation that leaves the cloud, see radiation.h.
// Departs from [4]: shrinking by cooling is kept in part only, and burning expands beyond its heating (Settings).
#pragma once

#include "advection.h"
#include "burst.h"
#include "field.h"
#include "multigrid.h"
#include "noise.h"
#include "settings.h"

namespace brisance::combustion {

// What a cell holds: fuel [mass fraction], heat [K: the cell's mean temperature above ambient], soot [density units]
// and gas [mass fraction of what came out of the burst; the rest is air]. Heat belongs to the gas until the two have
// mixed.
enum Component { Fuel, Heat, Soot, Gas };
using Mixture = Field<vec4>;

struct StepReport {
    float seconds = 0.0f;            // length of the step
    float maximum_speed = 0.0f;      // before the step [m/s]
    double divergence_before = 0.0;  // root mean square of (div u - wanted) before the pressure solve [1/s]
    double divergence_after = 0.0;   // and after it
    int pressure_cycles = 0;
};

class Simulation {
public:
    explicit Simulation(const Settings& settings);

    // Advances by one frame; returns one report per step.
    std::vector<StepReport> advance_frame();
    // Advances by one of the `substeps` states of a frame: as many of these calls make a frame, bit by bit.
    std::vector<StepReport> advance_substep();

    double time() const { return time_; }  // [s]
    double frame_rate() const { return settings_.frame_rate; }
    float cell_size() const { return h_; }  // [m]
    const ivec3& cells() const { return cells_; }
    const Mixture& mixture() const { return mixture_; }
    const FaceVelocity& velocity() const { return velocity_; }
    float temperature(const vec4& cell) const;  // of the gas in it [K]
    float flame(const vec4& cell) const;        // how brightly it glows: 0 at 900 K, 1 when full of the hottest gas
    double soot_mass() const;                   // density integrated over the box [m^3]
    vec3 world_of_centre(int i, int j, int k) const { return (vec3(i, j, k) + kCentre) * h_ + origin_; }

private:
    StepReport step(float dt);
    float maximum_speed() const;
    CellBox occupied(int margin) const;
    void advect_all(float dt);
    void add_burst(float dt);
    void react(float dt);
    vec4 reacted(const vec4& cell, float escape, float dt, float& expansion) const;
    void add_forces(float dt);
    Field<vec4> accelerations() const;
    void project(StepReport& report);
    double divergence_error(Field<float>* rhs) const;
    static bool is_ambient(const vec4& cell);

    Settings settings_;
    ivec3 cells_;
    float h_;
    vec3 origin_;  // world position of the low corner of cell (0, 0, 0) [m]
    double time_ = 0.0;
    int substep_ = 0;  // states since the start
    std::vector<Puff> puffs_;
    CurlNoise turbulence_;
    Mixture mixture_;
    FaceVelocity velocity_;
    Field<float> expansion_;  // divergence imposed on the flow [1/s]
    Multigrid multigrid_;
};

}  // namespace brisance::combustion
