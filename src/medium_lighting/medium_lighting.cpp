#include "medium_lighting/medium_lighting.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "medium_lighting/exterior/point_receivers.h"
#include "medium_lighting/first_light.h"
#include "medium_lighting/stages/smoke_light.h"

namespace brisance {

namespace {

// Adds `share` of a field. An empty one is not there.
void add(std::vector<Rgb>& sum, std::vector<Rgb>&& field, float share) {
    if (sum.empty() && share == 1.0f) {
        sum = std::move(field);
        return;
    }
    sum.resize(std::max(sum.size(), field.size()), Rgb(0.0f));
    parallel_for(
        field.size(), [&](std::size_t i) { sum[i] += share * field[i]; }, 4096);
}

// A lattice of light, and its share of it.
struct ShareOfLevel {
    int level;
    float share;
};

std::vector<ShareOfLevel> shares_of(const LightingLevel& choice) {
    std::vector<ShareOfLevel> out{{choice.level, 1.0f - choice.share_of_coarser}};
    if (choice.share_of_coarser > 0.0f)
        out.push_back({choice.level + 1, choice.share_of_coarser});
    return out;
}

}  // namespace

// Makes the light on all lattices that have a share in it.
class MediumLighting::Stages {
public:
    Stages(MediumLighting& to, Statistics& statistics, Progress& progress)
        : to_(to), statistics_(statistics), progress_(progress) {}

    void run() {
        const Stopwatch watch;
        const LightingLevels levels = lighting_levels(to_.input_);
        statistics_.stages.push_back({"lattice of the light", watch.seconds(), 0, detail_of(levels)});
        const auto firsts = shares_of(levels.first), smokes = shares_of(levels.smoke);
        for (std::size_t i = 0; i < firsts.size(); ++i)
            first(firsts[i], i > 0);
        if (to_.input_.multiple)
            for (std::size_t i = 0; i < smokes.size(); ++i)
                smoke(smokes[i], i > 0);
        statistics_.stages.push_back(std::move(smoke_on_lattices_));
    }

private:
    static nlohmann::ordered_json detail_of(const LightingLevels& levels) {
        const LightingLevel &first = levels.first, &smoke = levels.smoke;
        return {{"lattice_level", first.level},
                {"share_of_coarser_level", first.share_of_coarser},
                {"error", first.error},
                {"error_of_coarser_level", first.error_of_coarser},
                {"interpolation", levels.interpolation},
                {"smoke_lattice_level", smoke.level},
                {"smoke_share_of_coarser_level", smoke.share_of_coarser},
                {"smoke_error", smoke.error},
                {"smoke_error_of_coarser_level", smoke.error_of_coarser}};
    }

    // Kept by what refers to it alone.
    Lattice lattice(int level) {
        std::weak_ptr<const LitLattice>& known = lattices_[level];
        Lattice out = known.lock();
        if (out)
            return out;
        const Stopwatch watch;
        known = out = std::make_shared<const LitLattice>(to_.input_, level);
        smoke_on_lattices_.seconds += watch.seconds();
        smoke_on_lattices_.bytes = std::max(smoke_on_lattices_.bytes, out->pyramid().bytes());
        smoke_on_lattices_.detail["lattice_levels"].push_back(level);
        return out;
    }

    void first(const ShareOfLevel& of, bool coarser) {
        Lattice on = lattice(of.level);
        Statistics costs;
        FirstLight light = first_light(*on, of.share, costs, progress_);
        note(std::move(costs), coarser);
        for (auto field : {&NodeSources::single, &NodeSources::from_surfaces, &NodeSources::from_emitters})
            add(to_.nodes_.*field, std::move(light.sources.*field), of.share);
        to_.nodes_.emitters_at_nodes = light.sources.emitters_at_nodes;
        once_.push_back({on, of.share, std::move(light.once)});
        keep(std::move(on), &SurfaceReceiver::fire, of.share, std::move(light.fire));
    }

    void smoke(const ShareOfLevel& of, bool coarser) {
        ScatteredLight once = scattered_once(of.level);
        Lattice on = lattice(of.level);
        Statistics costs;
        SmokeLight light = light_from_smoke(*on, of.share, once, costs, progress_);
        note(std::move(costs), coarser);
        add(to_.nodes_.multiple, std::move(light.multiple), of.share);
        to_.nodes_.orders.resize(std::max(to_.nodes_.orders.size(), light.orders.size()));
        for (std::size_t k = 0; k < light.orders.size(); ++k)
            add(to_.nodes_.orders[k], std::move(light.orders[k]), of.share);
        keep(std::move(on), &SurfaceReceiver::smoke, of.share, std::move(light.exterior));
    }

    // On the lattice of a level, from those that are not coarser.
    ScatteredLight scattered_once(int level) const {
        ScatteredLight sum;
        float shares = 0.0f;
        for (const auto& [lattice, share, light] : once_)
            if (lattice->level() <= level && shares + share > 0.0f) {
                shares += share;
                ScatteredLight on = lattice->level() == level
                                        ? light
                                        : restricted(light, lattice->medium().lattice, level - lattice->level());
                if (sum.intensity.empty()) {
                    sum = std::move(on);
                    continue;
                }
                sum.add(sum, Rgb(-share / shares));
                sum.add(on, Rgb(share / shares));
            }
        return sum;
    }

    void note(Statistics costs, bool coarser) {
        for (StageCost& stage : costs.stages) {
            if (coarser)
                stage.name += ", on the next coarser lattice";
            statistics_.stages.push_back(std::move(stage));
        }
    }

    void keep(Lattice on, Slot slot, float share, std::unique_ptr<ExteriorLights> lights) {
        if (lights)
            to_.seen_from_outside_.push_back({std::move(on), slot, share, std::move(lights)});
    }

    struct Once {
        Lattice lattice;
        float share;
        ScatteredLight light;
    };

    MediumLighting& to_;
    Statistics& statistics_;
    Progress& progress_;
    std::map<int, std::weak_ptr<const LitLattice>> lattices_;
    std::vector<Once> once_;  // light scattered once, per lattice of the first light
    StageCost smoke_on_lattices_{"smoke on the lattices of the light", 0.0, 0, {}};
};

MediumLighting::MediumLighting(const MediumLightingInput& input, Statistics& statistics, Progress& progress)
    : input_(input) {
    Stages(*this, statistics, progress).run();
}

VisibilityRatios MediumLighting::visibility_of(Slot slot) const {
    for (const SeenFromOutside& seen : seen_from_outside_)
        if (seen.slot == slot)
            return seen.lights->visibility_ratios();
    return {};
}

void MediumLighting::at_surfaces(std::vector<SurfaceReceiver>& points) const {
    if (points.empty())
        return;
    for (SurfaceReceiver& p : points)
        p.fire = p.smoke = {};
    std::vector<const LitLattice*> lattices;
    for (const SeenFromOutside& seen : seen_from_outside_)
        if (std::find(lattices.begin(), lattices.end(), seen.lattice.get()) == lattices.end())
            lattices.push_back(seen.lattice.get());
    for (const LitLattice* lattice : lattices)
        add_at_surfaces(*lattice, points);
}

void MediumLighting::add_at_surfaces(const LitLattice& lattice, std::vector<SurfaceReceiver>& points) const {
    std::vector<ReceiverPoint> at;
    at.reserve(points.size());
    for (const SurfaceReceiver& p : points)
        at.push_back({p.local, p.normal});
    std::vector<std::uint32_t> order;
    const Receivers receivers = point_receivers(lattice.medium(), at, order);
    // Padding repeats a block's last point, which is to be added to once.
    const auto is_padding = [&](std::size_t i) { return i % Receivers::kGroup > 0 && order[i] == order[i - 1]; };
    const std::size_t n = order.size();
    for (const SeenFromOutside& seen : seen_from_outside_) {
        const bool asked = seen.slot == &SurfaceReceiver::fire ? input_.fire_on_surfaces : input_.smoke_on_surfaces;
        if (seen.lattice.get() != &lattice || !asked)
            continue;
        const std::array<Gathered, 2> arriving = seen.lights->at_surfaces(receivers);
        // Scaled by the balance of what escapes, not of what collides.
        const Rgb scale = seen.share * seen.lights->escape_scale();
        for (int part = 0; part < 2; ++part)
            for (std::size_t i = 0; i < n && !arriving[part].scattered.empty(); ++i)
                for (int c = 0; c < 3 && !is_padding(i); ++c)
                    (points[order[i]].*seen.slot)[part][c] += scale[c] * arriving[part].scattered[c * n + i];
    }
}

}  // namespace brisance
