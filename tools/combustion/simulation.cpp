#include "simulation.h"

#include "radiation.h"

namespace brisance::combustion {

namespace {

constexpr float kPressureTolerance = 2e-3f;  // of the residual, relative
constexpr int kPressureCyclesMax = 20;
constexpr float kLeastGas = 1e-3f;    // a cell with less is air
constexpr float kGlowStart = 900.0f;  // darker gas gives no light worth drawing [K]
constexpr float kPuffEdge = 0.1f;     // depth over which a puff's gas reaches full strength [m]

ivec3 box_cells(const Settings& s) {
    const int across = std::max(1, (s.resolution + 15) / 16) * 16;
    const int up = static_cast<int>(std::lround(float(across) * s.height_ratio / 16.0f)) * 16;
    return ivec3(across, across, std::max(16, up));
}

}  // namespace

Simulation::Simulation(const Settings& settings)
    : settings_(settings),
      cells_(box_cells(settings)),
      h_(settings.width / float(cells_.x)),
      origin_(-0.5f * settings.width, -0.5f * settings.width, 0.0f),
      puffs_(make_puffs(settings)),
      turbulence_(settings.seed),
      mixture_(cells_, vec4(0.0f)),
      velocity_(cells_),
      expansion_(cells_),
      multigrid_(cells_, h_) {}

std::vector<StepReport> Simulation::advance_frame() {
    std::vector<StepReport> reports;
    for (int s = 0; s < settings_.substeps; ++s)
        for (const StepReport& report : advance_substep())
            reports.push_back(report);
    return reports;
}

std::vector<StepReport> Simulation::advance_substep() {
    std::vector<StepReport> reports;
    const double frame_seconds = 1.0 / settings_.frame_rate;
    const double end = frame_seconds / settings_.substeps * ++substep_;
    const float shortest = static_cast<float>(frame_seconds) / float(settings_.steps_per_frame_max);
    // While puffs enter at full speed the flow of the last step does not yet show how fast the next will be.
    const bool bursting = time_ < 2.0f * settings_.burst_duration;
    while (end - time_ > 1e-6) {
        const float speed = std::max(maximum_speed(), bursting ? settings_.burst_speed : 0.0f);
        const float left = static_cast<float>(end - time_);
        const float wanted = std::max(settings_.courant * h_ / std::max(speed, 1e-3f), shortest);
        const float dt = left / std::ceil(left / wanted - 1e-3f);
        reports.push_back(step(dt));
        reports.back().maximum_speed = speed;
        time_ += dt;
    }
    time_ = end;
    return reports;
}

StepReport Simulation::step(float dt) {
    StepReport report;
    report.seconds = dt;
    advect_all(dt);
    add_burst(dt);
    react(dt);
    add_forces(dt);
    project(report);
    return report;
}

float Simulation::maximum_speed() const {
    float fastest = 0.0f;
    for (const Field<float>& u : velocity_.normal)
        for (float v : u.values)
            fastest = std::max(fastest, std::abs(v));
    return fastest;
}

bool Simulation::is_ambient(const vec4& cell) {
    return cell[Gas] < kLeastGas && cell[Heat] < 1.0f && cell[Soot] < 1e-4f;
}

float Simulation::temperature(const vec4& cell) const {
    const float heat = std::max(cell[Heat], 0.0f) / std::max(cell[Gas], kLeastGas);
    return std::min(settings_.ambient_temperature + heat, settings_.maximum_temperature);
}

float Simulation::flame(const vec4& cell) const {
    const float glow = (temperature(cell) - kGlowStart) / (settings_.maximum_temperature - kGlowStart);
    return std::min(cell[Gas], 1.0f) * std::clamp(glow, 0.0f, 1.0f);
}

double Simulation::soot_mass() const {
    const double volume = double(h_) * h_ * h_;
    return volume * sum_slabs(cells_.z, [&](int k) {
               double sum = 0.0;
               for (std::size_t c = mixture_.index(0, 0, k); c < mixture_.index(0, 0, k + 1); ++c)
                   sum += mixture_.values[c][Soot];
               return sum;
           });
}

// The least box around all gas that is not ambient, widened by `margin` cells.
CellBox Simulation::occupied(int margin) const {
    std::vector<CellBox> part(std::size_t(cells_.z), CellBox{cells_, ivec3(0)});
    for_slabs(cells_.z, [&](int k) {
        CellBox& box = part[std::size_t(k)];
        for (int j = 0; j < cells_.y; ++j)
            for (int i = 0; i < cells_.x; ++i)
                if (!is_ambient(mixture_(i, j, k))) {
                    box.low = glm::min(box.low, ivec3(i, j, k));
                    box.high = glm::max(box.high, ivec3(i, j, k) + 1);
                }
    });
    CellBox all{cells_, ivec3(0)};
    for (const CellBox& box : part) {
        all.low = glm::min(all.low, box.low);
        all.high = glm::max(all.high, box.high);
    }
    return {glm::max(all.low - margin, ivec3(0)), glm::min(all.high + margin, cells_)};
}

void Simulation::advect_all(float dt) {
    const Field<vec4> centred = centred_velocity(velocity_, cells_, h_);
    const int reach = 3 + static_cast<int>(std::ceil(maximum_speed() * dt / h_));
    const CellBox box = occupied(reach);
    if (box.high.x > box.low.x)
        advect(mixture_, kCentre, centred, dt, box, box);
    for (int a = 0; a < 3; ++a)
        advect(velocity_.normal[a], face_offset(a), centred, dt, {ivec3(0), velocity_.normal[a].size}, box);
}

void Simulation::add_burst(float dt) {
    const float t = static_cast<float>(time_);
    for (const Puff& puff : puffs_) {
        if (t + dt <= puff.start || t >= puff.start + puff.duration)
            continue;
        const vec3 reach(2.0f * puff.radius);
        const ivec3 low = glm::max(ivec3((puff.centre - reach - origin_) / h_), ivec3(0));
        const ivec3 high = glm::min(ivec3((puff.centre + reach - origin_) / h_) + 2, cells_);
        for_slabs(std::max(0, high.z - low.z), [&](int slab) {
            const int k = low.z + slab;
            for (int j = low.y; j < high.y; ++j)
                for (int i = low.x; i < high.x; ++i) {
                    const float share = std::clamp(puff.depth(world_of_centre(i, j, k)) / kPuffEdge, 0.0f, 1.0f);
                    if (share <= 0.0f)
                        continue;
                    const float heat = settings_.ignition_temperature - settings_.ambient_temperature;
                    vec4& cell = mixture_(i, j, k);
                    cell = glm::max(cell, share * vec4(puff.richness, heat, 0.0f, 1.0f));
                    for (int a = 0; a < 3; ++a) {
                        float& u = velocity_.normal[a](i, j, k);
                        u = glm::mix(u, puff.velocity[a], share);
                    }
                }
        });
    }
}

void Simulation::react(float dt) {
    Field<float> soot(cells_);
    for (std::size_t c = 0; c < soot.values.size(); ++c)
        soot.values[c] = mixture_.values[c][Soot];
    const Field<float> escape = escape_fraction(soot, h_, settings_.soot_absorption);
    for_slabs(cells_.z, [&](int k) {
        for (int j = 0; j < cells_.y; ++j)
            for (int i = 0; i < cells_.x; ++i) {
                vec4& cell = mixture_(i, j, k);
                expansion_(i, j, k) = 0.0f;
                if (is_ambient(cell)) {
                    cell = vec4(0.0f);
                    continue;
                }
                const float outwards = sample(escape, (vec3(i, j, k) + kCentre) * 0.5f, kCentre);
                cell = reacted(cell, outwards, dt, expansion_(i, j, k));
            }
    });
}

// One cell's burning, cooling, mixing and soot over dt. `escape` is the share of radiated heat that leaves the cloud.
vec4 Simulation::reacted(const vec4& cell, float escape, float dt, float& expansion) const {
    const Settings& s = settings_;
    const float gas = std::clamp(cell[Gas], kLeastGas, 1.0f);
    const float cold = temperature(cell);
    // A constant share of the fuel per second, once alight.
    const float alight = glm::smoothstep(600.0f, 900.0f, cold);
    const float burnt = std::max(cell[Fuel], 0.0f) * (1.0f - std::exp(-alight * dt / s.burn_time));
    const float heated = std::min(cold + s.heat_per_fuel * burnt / gas, s.maximum_temperature);

    // [1] eq. 13, d theta/dt = -c (theta / range)^4, solved exactly over the step.
    const float range = s.maximum_temperature - s.ambient_temperature;
    const float theta = (heated - s.ambient_temperature) / range;
    const float rate = 3.0f * escape * s.radiative_cooling / range * dt;
    const float radiated = range * theta / std::cbrt(1.0f + rate * theta * theta * theta);

    // [4] div u = (1/T) dT/dt, T the cell's mean.
    const float mean_cold = s.ambient_temperature + gas * (cold - s.ambient_temperature);
    const float mean_heated = s.ambient_temperature + gas * (heated - s.ambient_temperature);
    const float mean_next = s.ambient_temperature + gas * radiated;
    expansion = (std::log(mean_heated / mean_cold) + s.contraction * std::log(mean_next / mean_heated) +
                 s.expansion_per_fuel * burnt) /
                dt;

    // [5] The gas relaxes to the mean; as heat is kept, its share of the cell grows by as much as it cools.
    const float kept = gas + (1.0f - gas) * std::exp(-dt / s.mixing_time);
    vec4 next;
    next[Heat] = gas * radiated;
    next[Gas] = std::min(1.0f, gas / kept);
    next[Fuel] = std::max(cell[Fuel], 0.0f) - burnt;
    // Soot is a mass per volume: it thins as the gas that carries it expands.
    next[Soot] = (cell[Soot] + s.soot_per_fuel * burnt) * std::exp(-(expansion + s.soot_dissipation) * dt);
    return next;
}

// Buoyancy, vorticity confinement and turbulence at the cell centres [m/s^2].
Field<vec4> Simulation::accelerations() const {
    const Field<vec4> u = centred_velocity(velocity_, cells_, 1.0f);
    Field<vec4> vorticity(cells_);  // and its length in w
    const auto at = [&](const Field<vec4>& f, int i, int j, int k) {
        return f(std::clamp(i, 0, cells_.x - 1), std::clamp(j, 0, cells_.y - 1), std::clamp(k, 0, cells_.z - 1));
    };
    const float over_2h = 0.5f / h_;
    const CellBox box = occupied(2);
    for_slabs(std::max(0, box.high.z - box.low.z), [&](int slab) {
        const int k = box.low.z + slab;
        for (int j = box.low.y; j < box.high.y; ++j)
            for (int i = box.low.x; i < box.high.x; ++i) {
                const vec4 dx = (at(u, i + 1, j, k) - at(u, i - 1, j, k)) * over_2h;
                const vec4 dy = (at(u, i, j + 1, k) - at(u, i, j - 1, k)) * over_2h;
                const vec4 dz = (at(u, i, j, k + 1) - at(u, i, j, k - 1)) * over_2h;
                const vec3 curl(dy.z - dz.y, dz.x - dx.z, dx.y - dy.x);
                vorticity(i, j, k) = vec4(curl, glm::length(curl));
            }
    });
    const Settings& s = settings_;
    Field<vec4> acceleration(cells_);
    for_slabs(cells_.z, [&](int k) {
        for (int j = 0; j < cells_.y; ++j)
            for (int i = 0; i < cells_.x; ++i) {
                const vec4& cell = mixture_(i, j, k);
                if (is_ambient(cell))
                    continue;
                const float lightness = 1.0f - s.ambient_temperature / (s.ambient_temperature + cell[Heat]);
                vec3 a(0.0f, 0.0f, s.buoyancy * s.gravity * lightness);
                const vec3 slope(at(vorticity, i + 1, j, k).w - at(vorticity, i - 1, j, k).w,
                                 at(vorticity, i, j + 1, k).w - at(vorticity, i, j - 1, k).w,
                                 at(vorticity, i, j, k + 1).w - at(vorticity, i, j, k - 1).w);
                const float steepness = glm::length(slope);
                if (steepness > 0.0f)  // [3] eq. 11
                    a += s.confinement * h_ * glm::cross(slope / steepness, vec3(vorticity(i, j, k)));
                // Three octaves that drift upwards; finer eddies turn over faster and carry less.
                const vec3 x = world_of_centre(i, j, k) / s.turbulence_length;
                const vec3 drift(0.0f, 0.0f, static_cast<float>(time_) * 1.5f);
                const vec3 eddies = turbulence_(x - drift) + 0.7f * turbulence_(x * 2.3f - drift * 1.7f) +
                                    0.5f * turbulence_(x * 5.1f - drift * 2.9f);
                a += s.turbulence * lightness * eddies;
                acceleration(i, j, k) = vec4(a, 0.0f);
            }
    });
    return acceleration;
}

void Simulation::add_forces(float dt) {
    const Field<vec4> a = accelerations();
    for (int axis = 0; axis < 3; ++axis) {
        Field<float>& u = velocity_.normal[axis];
        ivec3 back(0);
        back[axis] = 1;
        for_slabs(cells_.z, [&](int k) {
            for (int j = 0; j < cells_.y; ++j)
                for (int i = 0; i < cells_.x; ++i) {
                    const ivec3 before = glm::max(ivec3(i, j, k) - back, ivec3(0));
                    u(i, j, k) += 0.5f * dt * (a(i, j, k)[axis] + a(before.x, before.y, before.z)[axis]);
                }
        });
    }
}

// Root mean square of div u - expansion; the difference itself goes to `rhs` where one is given.
double Simulation::divergence_error(Field<float>* rhs) const {
    const auto& [u, v, w] = velocity_.normal;
    const float over_h = 1.0f / h_;
    const double square = sum_slabs(cells_.z, [&](int k) {
        double sum = 0.0;
        for (int j = 0; j < cells_.y; ++j)
            for (int i = 0; i < cells_.x; ++i) {
                const float divergence =
                    (u(i + 1, j, k) - u(i, j, k) + v(i, j + 1, k) - v(i, j, k) + w(i, j, k + 1) - w(i, j, k)) * over_h;
                const float error = divergence - expansion_(i, j, k);
                sum += double(error) * error;
                if (rhs)
                    (*rhs)(i, j, k) = error;
            }
        return sum;
    });
    return std::sqrt(square / double(expansion_.values.size()));
}

// Subtracts the gradient of the p that solves laplacian(p) = div u - expansion: [2] sec. 3, with dt/density in p.
void Simulation::project(StepReport& report) {
    Field<float>& w = velocity_.normal[2];
    for (int j = 0; j < cells_.y; ++j)
        for (int i = 0; i < cells_.x; ++i)
            w(i, j, 0) = 0.0f;
    Field<float> rhs(cells_);
    report.divergence_before = divergence_error(&rhs);
    report.pressure_cycles = multigrid_.solve(rhs, kPressureTolerance, kPressureCyclesMax);
    const float over_h = 1.0f / h_;
    for (int axis = 0; axis < 3; ++axis) {
        Field<float>& u = velocity_.normal[axis];
        for_slabs(u.size.z, [&](int k) {
            for (int j = 0; j < u.size.y; ++j)
                for (int i = 0; i < u.size.x; ++i) {
                    const ivec3 face(i, j, k);
                    if (axis == 2 && k == 0)
                        continue;
                    ivec3 before = face;
                    --before[axis];
                    // Zero pressure on an open face is a ghost cell of opposite pressure behind it.
                    const bool first = face[axis] == 0, last = face[axis] == cells_[axis];
                    const float low = first ? 0.0f : multigrid_.pressure(before.x, before.y, before.z);
                    const float high = last ? -low : multigrid_.pressure(i, j, k);
                    u(i, j, k) -= (high - (first ? -high : low)) * over_h;
                }
        });
    }
    report.divergence_after = divergence_error(nullptr);
}

}  // namespace brisance::combustion
