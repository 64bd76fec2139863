#include "virtual_lights/placement/metropolis.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "transport/particle_walk.h"
#include "virtual_lights/placement/camera_receivers.h"

namespace brisance {

namespace {

constexpr Stream kChainPilot = stream_of("virtual_lights/metropolis/pilot");
constexpr Stream kChain = stream_of("virtual_lights/metropolis/chain");
constexpr std::size_t kChains = 64;  // at most
// Light paths of the separate estimate, whose error all lights share.
std::size_t pilot_paths(const VirtualLightSettings& s) {
    return std::clamp<std::size_t>(4 * static_cast<std::size_t>(s.count), 1024, 16384);
}
constexpr int kTries = 4;
constexpr int kStepsPerLight = 2;
constexpr int kSamplesPerLight = 2;
// Mutations by number in [0, 1).
constexpr double kWholePath = 0.3, kLastFlights = 0.8;
// Particles that share all power; only their kinds and their powers follow from the number.
constexpr std::uint64_t kParticles = std::uint64_t{1} << 32;

struct State {
    Deposit deposit;                        // its power as if its path were the only one
    std::optional<EmittedParticle> before;  // the start of the flight before the one that ended here
    int flight = 0;                         // of the path that ended here
    int earlier = 0;                        // deposits of the path before `before`
    int siblings = 0;                       // deposits of the path, itself included
    double weight = 0.0;

    bool can_redraw_flights() const { return before && flight + 1 < kManyScatterings; }
    double weight_of_path() const { return weight * siblings; }  // a path is drawn, then one of its deposits
};

class LightPaths {
public:
    explicit LightPaths(const PlacementInput& input)
        : scene_(input.scene), receivers_(input), particles_(scene_, ball_around(scene_), kParticles) {}

    void use_floor(double per_power) { per_power_ = per_power; }

    double contribution(const Deposit& deposit, Rng& rng) const { return receivers_.contribution(deposit, rng); }
    double weight_of(const State& state, double contribution) const {
        return contribution + per_power_ * luminance(state.deposit.power);
    }
    void weigh(State& state, Rng& rng) const { state.weight = weight_of(state, contribution(state.deposit, rng)); }

    // All deposits of a new path.
    std::vector<State> draw(Rng& rng) const {
        const auto number = static_cast<std::uint64_t>(rng.next_double() * double(kParticles));
        const std::optional<EmittedParticle> start = particles_.emit(number, rng);
        if (!start || !(largest(start->power) > 0.0f) || !std::isfinite(largest(start->power)))
            return {};
        return follow({start->ray, start->power * float(kParticles)}, rng);
    }

    // One deposit of a new path, weighed.
    std::optional<State> redraw_path(Rng& rng) const {
        const std::vector<State> all = draw(rng);
        const double choice = rng.next_double();
        if (all.empty())
            return std::nullopt;
        State state = all[std::min(static_cast<std::size_t>(choice * double(all.size())), all.size() - 1)];
        weigh(state, rng);
        return state;
    }

    // The same path up to the flight before the last, from there anew.
    std::optional<State> redraw_flights(const State& from, Rng& rng) const {
        const std::vector<State> all = follow(*from.before, rng);
        for (State state : all)
            if (state.flight == 1) {
                state.flight = from.flight;
                state.earlier = from.earlier;
                state.siblings = from.earlier + static_cast<int>(all.size());
                weigh(state, rng);
                return state;
            }
        return std::nullopt;
    }

private:
    std::vector<State> follow(const EmittedParticle& start, Rng& rng) const {
        std::vector<State> out;
        std::optional<EmittedParticle> before;
        int flights = 0;
        walk_particle(scene_, start, 0, {}, rng, [&](const ParticleFlight& flight) {
            if (flight.landing() && holds_light(flight.landing()->material)) {
                State state;
                state.deposit = deposit_of(scene_, flight.segment, flight.power);
                state.before = before;
                state.flight = flights;
                state.earlier = static_cast<int>(std::count_if(
                    out.begin(), out.end(), [&](const State& other) { return other.flight < flights - 1; }));
                out.push_back(state);
            }
            before = EmittedParticle{flight.ray(), flight.power};
            ++flights;
            return true;
        });
        for (State& state : out)
            state.siblings = static_cast<int>(out.size());
        return out;
    }

    const DirectLight& scene_;
    CameraReceivers receivers_;
    Particles particles_;
    double per_power_ = 1.0;
};

// Plain light paths, in proportion to whose weights chains begin.
struct ChainPilot {
    std::vector<State> states;
    double total = 0.0;  // of all weights
    double mean = 0.0;   // ... over the number of paths
};

ChainPilot chain_pilot(LightPaths& paths, const VirtualLightSettings& s) {
    std::vector<std::vector<State>> drawn(pilot_paths(s));
    parallel_for(
        drawn.size(),
        [&](std::size_t i) {
            Rng rng(kChainPilot, i, s.seed);
            drawn[i] = paths.draw(rng);
            for (State& state : drawn[i])
                state.weight = paths.contribution(state.deposit, rng);
        },
        64);
    ChainPilot out;
    double contribution = 0.0, power = 0.0;
    for (const std::vector<State>& path : drawn)
        for (const State& state : path) {
            out.states.push_back(state);
            contribution += state.weight;
            power += luminance(state.deposit.power);
        }
    if (contribution > 0.0 && power > 0.0)
        paths.use_floor(s.importance_floor * contribution / power);
    for (State& state : out.states)
        out.total += state.weight = paths.weight_of(state, state.weight);
    out.mean = out.total / double(drawn.size());
    return out;
}

// Of chain `chain` of `chains`: evenly spaced through the weights of the pilot.
const State& beginning(const ChainPilot& pilot, std::size_t chain, std::size_t chains, double shift) {
    double left = (double(chain) + shift) / double(chains) * pilot.total;
    const State* last = nullptr;
    for (const State& state : pilot.states) {
        if (!(state.weight > 0.0))
            continue;
        last = &state;
        if ((left -= state.weight) < 0.0)
            break;
    }
    return *last;
}

// One mutation by several tries. True: the deposit is another.
bool mutate(const LightPaths& paths, State& state, Rng& rng) {
    const double kind = rng.next_double();
    const bool whole = kind < kWholePath, flights = !whole && kind < kLastFlights;
    if (flights && !state.can_redraw_flights())
        return false;
    const auto weight_of = [&](const State& s) { return whole ? s.weight_of_path() : s.weight; };
    State taken;
    double sum = 0.0;
    for (int i = 0; i < kTries; ++i) {
        std::optional<State> drawn = whole     ? paths.redraw_path(rng)
                                     : flights ? paths.redraw_flights(state, rng)
                                               : state;
        if (!drawn)
            continue;
        if (!whole && !flights)
            paths.weigh(*drawn, rng);
        sum += weight_of(*drawn);
        if (weight_of(*drawn) > 0.0 && rng.next_double() * sum < weight_of(*drawn))
            taken = *drawn;
    }
    if (!(sum > 0.0) || !(rng.next_double() * (sum - weight_of(taken) + weight_of(state)) < sum))
        return false;
    state = taken;
    return whole || flights;
}

struct Chain {
    std::vector<Deposit> lights;
    std::uint64_t moved = 0, steps = 0;
};

// `power`: of a sample, over its deposit's power times its weight.
Chain run_chain(const LightPaths& paths, State state, std::size_t samples, double power, Rng rng) {
    Chain out;
    bool moved = true;
    for (std::size_t i = 0; i < samples; ++i) {
        for (int step = 0; step < kStepsPerLight; ++step) {
            const bool moves = mutate(paths, state, rng);
            moved = moved || moves;
            out.moved += moves;
            ++out.steps;
        }
        const Rgb carried = state.deposit.power * float(power / state.weight);
        if (moved) {
            out.lights.push_back(state.deposit);
            out.lights.back().power = Rgb(0.0f);
        }
        out.lights.back().power += carried;
        moved = false;
    }
    return out;
}

PhotonArrivals sample_chains(const PlacementInput& input, std::size_t count) {
    LightPaths paths(input);
    const VirtualLightSettings& s = input.settings;
    const ChainPilot pilot = chain_pilot(paths, s);
    if (!(pilot.total > 0.0))
        return {};
    std::vector<Chain> chains(std::min(count, kChains));
    const double shift = Rng(kChain, ~std::uint64_t{0}, s.seed).next_double();
    parallel_for(
        chains.size(),
        [&](std::size_t i) {
            const std::size_t samples = (i + 1) * count / chains.size() - i * count / chains.size();
            chains[i] = run_chain(paths, beginning(pilot, i, chains.size(), shift), samples, pilot.mean / double(count),
                                  Rng(kChain, i, s.seed));
        },
        1);
    PhotonArrivals out;
    out.report.photons = pilot_paths(s);
    std::uint64_t moved = 0, steps = 0;
    for (const Chain& chain : chains) {
        out.arrivals.insert(out.arrivals.end(), chain.lights.begin(), chain.lights.end());
        moved += chain.moved;
        steps += chain.steps;
    }
    out.report.photons += steps * kTries;
    for (const Deposit& light : out.arrivals)
        out.report.shared += luminance(light.power);
    input.report.acceptance = steps > 0 ? double(moved) / double(steps) : 1.0;
    return out;
}

}  // namespace

PhotonArrivals metropolis_flux(const PlacementInput& input) {
    return sample_chains(input, static_cast<std::size_t>(input.settings.count));
}

std::vector<Deposit> metropolis_deposits(const PlacementInput& input) {
    return sample_chains(input, static_cast<std::size_t>(kSamplesPerLight) * input.settings.count).arrivals;
}

}  // namespace brisance
