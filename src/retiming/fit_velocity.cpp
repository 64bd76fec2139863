#include "retiming/fit_velocity.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "core/parallel.h"
#include "retiming/group_motion.h"
#include "retiming/sparse_field.h"

namespace brisance {
namespace {

constexpr std::size_t kMostNodes = 4000;  // at one place
// Candidates: the 99th percentile of the velocity as voxels per frame.
constexpr double kSlowest = 0.04, kFastest = 28.0;
constexpr int kCandidates = 20;   // steps of about the square root of two
constexpr int kRefinements = 10;  // golden sections
constexpr double kNamed = 1.25;   // ratio within which a scale may be one of the usual units

// Two neighbours, and the nodes at which they are compared.
class Place {
public:
    Place(const NeighbourFrames& frames, std::size_t role, double metres_per_unit) : number_(frames.first_number) {
        SourceFrame first, second;
        first.fields = {frames.first.fields[role]};
        second.fields = {frames.second.fields[role]};
        const VelocityPair velocity = {&frames.first.velocity, &frames.second.velocity};
        std::vector<FieldGroup> groups = group_fields(first, second);
        if (groups.empty() || groups.front().lattice.empty() || (velocity[0]->empty() && velocity[1]->empty()))
            return;
        group_ = std::move(groups.front());
        const VelocitySettings unit{VelocityUnit::Frame, metres_per_unit, 1.0};
        motion_ = motion_of(group_, velocity, unit, frames.second_number - frames.first_number);
        choose_nodes();
        still_ = squares(0.0);
    }

    int number() const { return number_; }
    bool usable() const { return still_ > 0.0; }

    // Squared difference after motion `scale` times the unit, relative to that without.
    double left(double scale) const { return squares(scale) / still_; }

private:
    void choose_nodes() {
        std::vector<std::size_t> all;
        const std::vector<std::uint8_t> a = group_.occupied(0), b = group_.occupied(1);
        for (std::size_t i = 0; i < a.size(); ++i)
            if (a[i] || b[i])
                all.push_back(i);
        const std::size_t step = all.size() / kMostNodes + 1;
        for (std::size_t i = step / 2; i < all.size(); i += step)
            nodes_.push_back(all[i]);
    }

    double difference(std::size_t i, int frame, double scale) const {
        const dvec3 node(group_.lattice.node(i));
        const dvec3 there = motion_.moved(node, frame, 1 - frame, scale);
        const FieldPair& field = group_.fields.front();
        const float other = sample_channel(cell_at(group_.lattice, there), field.values[1 - frame].data(), 1, 0);
        return double(other) - field.values[frame][i];
    }

    double squares(double scale) const {
        constexpr std::size_t block = 256;
        std::vector<double> sums((nodes_.size() + block - 1) / block, 0.0);
        parallel_blocks(nodes_.size(), block, [&](std::size_t begin, std::size_t end) {
            for (std::size_t n = begin; n < end; ++n)
                for (int frame = 0; frame < 2; ++frame) {
                    const double d = difference(nodes_[n], frame, scale);
                    sums[begin / block] += d * d;
                }
        });
        double sum = 0.0;
        for (const double s : sums)
            sum += s;
        return sum;
    }

    int number_;
    FieldGroup group_;
    Motion motion_;
    std::vector<std::size_t> nodes_;
    double still_ = 0.0;
};

struct Minimum {
    double scale = 0.0, value = 0.0;
    bool inside = false;  // not at an end of the candidates
};

double candidate(int i) {
    return kSlowest * std::pow(kFastest / kSlowest, double(i) / (kCandidates - 1));
}

// Among the candidates, then between the best one's neighbours.
Minimum find_minimum(const std::function<double(double)>& function) {
    std::vector<double> values;
    for (int i = 0; i < kCandidates; ++i)
        values.push_back(function(candidate(i)));
    const int best = static_cast<int>(std::min_element(values.begin(), values.end()) - values.begin());
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    double low = std::log(candidate(std::max(best - 1, 0)));
    double high = std::log(candidate(std::min(best + 1, kCandidates - 1)));
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = function(std::exp(a)), at_b = function(std::exp(b));
    for (int i = 0; i < kRefinements; ++i) {
        const bool left = at_a < at_b;
        (left ? high : low) = left ? b : a;
        if (left) {
            b = a;
            at_b = at_a;
            a = high - golden * (high - low);
            at_a = function(std::exp(a));
        } else {
            a = b;
            at_a = at_b;
            b = low + golden * (high - low);
            at_b = function(std::exp(b));
        }
    }
    const bool left = at_a < at_b;
    return {std::exp(left ? a : b), std::min(at_a, at_b), best > 0 && best + 1 < kCandidates};
}

std::string reason_against(const VelocityFit& fit, bool inside) {
    if (!inside || fit.explained < kLeastExplained)
        return fmt::format(
            "motion along it explains {:.0f} % of how neighbouring frames differ, and at least {:.0f} % "
            "are asked for",
            100.0 * std::max(inside ? fit.explained : 0.0, 0.0), 100.0 * kLeastExplained);
    if (fit.high > kWidestSpread * fit.low)
        return fmt::format(
            "its scale is {:.3g} m per frame at some places of the sequence and {:.3g} at others, "
            "and at most a ratio of {} is allowed",
            fit.low, fit.high, kWidestSpread);
    return {};
}

// The 99th percentile of the first velocity that is not empty, in voxels; 0 when all are.
double typical_voxels(const std::vector<NeighbourFrames>& places, double& voxel_metres) {
    for (const NeighbourFrames& place : places)
        for (const SourceFrame* frame : {&place.first, &place.second}) {
            const CentredVelocity& velocity = frame->velocity;
            if (velocity.empty())
                continue;
            voxel_metres = std::cbrt(velocity.grid.info.voxel_volume());
            return velocity.typical / voxel_metres;
        }
    return 0.0;
}

// The value that a share of the sorted values lies below.
double quantile(const std::vector<double>& sorted, double share) {
    const double at = share * double(sorted.size() - 1);
    const auto low = static_cast<std::size_t>(at);
    const std::size_t high = std::min(low + 1, sorted.size() - 1);
    return sorted[low] + (at - double(low)) * (sorted[high] - sorted[low]);
}

// The median of the places' scales: where fire burns smoke appears that no motion brought, and draws the scale down.
void fit_places(const std::vector<Place>& places, double metres_per_unit, VelocityFit& fit) {
    std::vector<double> scales;
    std::size_t inside = 0;
    for (const Place& place : places) {
        const Minimum minimum = find_minimum([&](double scale) { return place.left(scale); });
        scales.push_back(minimum.scale);
        inside += minimum.inside;
        fit.places.push_back(place.number());
    }
    std::sort(scales.begin(), scales.end());
    const double scale = quantile(scales, 0.5);
    fit.metres_per_frame = metres_per_unit * scale;
    fit.low = metres_per_unit * quantile(scales, 0.25);
    fit.high = metres_per_unit * quantile(scales, 0.75);
    double forward = 0.0, backward = 0.0;
    for (const Place& place : places) {
        forward += place.left(scale);
        backward += place.left(-scale);
    }
    fit.explained = 1.0 - forward / std::min(double(places.size()), backward);
    fit.why_not = reason_against(fit, 2 * inside > places.size());
}

}  // namespace

std::string VelocityFit::nearest_unit(double fps) const {
    struct Unit {
        const char* name;
        double metres_per_frame;
    };
    for (const Unit& unit :
         {Unit{"m/s (second)", 1.0 / fps}, Unit{"m per frame (frame)", 1.0},
          Unit{"voxels/s (voxel_second)", voxel_metres / fps}, Unit{"voxels per frame (voxel_frame)", voxel_metres}})
        if (std::abs(std::log(metres_per_frame / unit.metres_per_frame)) < std::log(kNamed))
            return fmt::format("near to {} at {:g} frames per second", unit.name, fps);
    return fmt::format("none of the usual units at {:g} frames per second", fps);
}

std::string VelocityFit::describe(double fps) const {
    return fmt::format(
        "a unit of velocity is {:.4g} voxels per frame (quartiles of {} place{}: {:.3g} to {:.3g}), {:.4g} m per "
        "frame: {}; it "
        "explains {:.0f} % of how neighbouring frames differ",
        voxels_per_frame(), places.size(), places.size() == 1 ? "" : "s", low / voxel_metres, high / voxel_metres,
        metres_per_frame, nearest_unit(fps), 100.0 * explained);
}

VelocityFit fit_velocity(const std::vector<NeighbourFrames>& frames, std::size_t role) {
    VelocityFit fit;
    const double typical = typical_voxels(frames, fit.voxel_metres);
    std::vector<Place> places;
    for (const NeighbourFrames& pair : frames)
        if (typical > 0.0)
            if (Place place(pair, role, 1.0 / typical); place.usable())
                places.push_back(std::move(place));
    if (places.empty())
        fit.why_not = "no two neighbouring frames differ and have velocities";
    else
        fit_places(places, 1.0 / typical, fit);
    return fit;
}

}  // namespace brisance
