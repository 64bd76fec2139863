#include "radiance_cascades/radiance_cascades.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "medium/coarse_medium.h"
#include "medium/lattice/local_bounds.h"
#include "medium/phase.h"
#include "radiance_cascades/interval_kernels.h"

namespace brisance {

namespace {

constexpr int kMostCascades = 16;
constexpr int kDirectionsAtOnce = 16;  // share a block of the medium
constexpr float kLongestStep = 1.0f;   // [nodes]

}  // namespace

// Where the merged light of one cascade goes: to the next finer one, averaged over the directions that divide one of
// its own, or to the nodes.
struct RadianceCascades::Output {
    std::vector<float> far;  // per probe and direction of the finer cascade, three colours
    Gathered* light = nullptr;
};

// One task of a cascade.
class RadianceCascades::Merge {
public:
    Merge(const RadianceCascades& all, int index, const CascadeField& field, const std::vector<float>& far, Output& out)
        : all_(all), cascade_(all.cascades_[index]), index_(index), field_(field), far_(far), out_(out) {
        const Medium& medium = all.pyramid_.medium();
        index_from_local_ = medium.index_from_local * (1.0f / float(1 << cascade_.level));
        local_from_index_ = medium.local_from_index * float(1 << cascade_.level);
        last_ = std::size_t(index) + 1 == all.cascades_.size();
    }

    void run(Task& task) const {
        const std::vector<ProbeClass> classes =
            probe_classes(cascade_.probes, task.brick, last_ ? nullptr : &all_.cascades_[index_ + 1].probes);
        const bool occluded = all_.pyramid_.occluders() && near_surfaces(task);
        const bool make = occluded && task.unhidden.empty();
        std::size_t cursor = 0;
        thread_local FieldBlock block;
        const int at_once = index_ == 0 ? 1 : kDirectionsAtOnce;
        for (int first = task.first; first < task.last; first += at_once) {
            const int last = std::min(first + at_once, task.last);
            fill(block, task.brick, classes, first, last);
            for (int d = first; d < last; ++d)
                for (const ProbeClass& c : classes)
                    merge_class(block, task, c, d, occluded, make, cursor);
        }
    }

private:
    struct Segment {
        vec3 begin, end;  // from the probe [nodes of the marched level]
    };

    Segment segment(int direction) const {
        const vec3 d = index_from_local_ * all_.directions_->of(index_)[direction];
        return {cascade_.begin * d, cascade_.end * d};
    }

    void fill(FieldBlock& block, std::size_t brick, const std::vector<ProbeClass>& classes, int first, int last) const {
        vec3 low(1e30f), high(-1e30f);
        for (int d = first; d < last; ++d) {
            const Segment s = segment(d);
            low = glm::min(low, glm::min(s.begin, s.end));
            high = glm::max(high, glm::max(s.begin, s.end));
        }
        ivec3 from(BrickLattice::kSize), to(-1);
        for (const ProbeClass& c : classes)
            for (const int n : c.nodes) {
                from = glm::min(from, BrickLattice::node_in_brick(n));
                to = glm::max(to, BrickLattice::node_in_brick(n));
            }
        const ivec3 origin = cascade_.probes.lattice.first_node(brick);
        block.fill(field_, all_.levels_[cascade_.level].occupied,
                   (origin + from) * cascade_.stride + ivec3(glm::floor(low)),
                   (origin + to) * cascade_.stride + ivec3(glm::floor(high)) + 1);
    }

    // Marches the same segment from all probes of a class. Without extinction on its way, nothing happens.
    void march(const FieldBlock& block, Task& task, const ProbeClass& c, const Segment& s, bool occluded, bool make,
               std::size_t& cursor, Intervals& out) const {
        const vec3 way = s.end - s.begin;
        const float nodes = glm::length(way);
        const int samples = std::clamp(static_cast<int>(std::ceil(nodes / kLongestStep)), 1, 250);
        const vec3 step = way / float(samples), first = s.begin + 0.5f * step;
        const int count = static_cast<int>(c.nodes.size());
        const ivec3 origin = cascade_.probes.lattice.first_node(task.brick);
        std::int32_t probe[kProbesAtOnce];
        vec3 low(1e30f), high(-1e30f);
        for (int p = 0; p < count; ++p) {
            const ivec3 node = (origin + BrickLattice::node_in_brick(c.nodes[p])) * cascade_.stride;
            probe[p] = block.index(node);
            low = glm::min(low, vec3(node));
            high = glm::max(high, vec3(node));
        }
        const std::uint8_t* unhidden = nullptr;
        if (occluded) {
            if (make)
                look_for_surfaces(task, c, s, samples);
            unhidden = task.unhidden.data() + cursor;
            cursor += count;
        }
        const bool empty = !block.may_hold(low + glm::min(s.begin, s.end), high + glm::max(s.begin, s.end));
        march_intervals({block.values(),
                         block.stride_x(),
                         block.stride_y(),
                         probe,
                         count,
                         {first.x, first.y, first.z},
                         {step.x, step.y, step.z},
                         empty ? 0 : samples,
                         (cascade_.end - cascade_.begin) / float(samples),
                         unhidden},
                        out);
    }

    // Adds the next cascade's light from one corner, seen through the interval, to `sum`, and its weights to `seen`.
    // `unhidden`: per probe, 0 where a surface stands between the ends of the ray and of the corner's; null: nowhere.
    void add_corner(const ProbeClass& c, int d, int corner, const Intervals& intervals, const std::uint8_t* unhidden,
                    Rgb* sum, float* seen) const {
        const int directions = all_.directions_->count(index_);
        for (int p = 0; p < c.count; ++p) {
            if (unhidden && unhidden[p] == 0)
                continue;
            const std::size_t row = std::size_t(c.following[corner][p]) * directions + d;
            sum[p] += intervals.transmittance[p] * Rgb(far_[row * 3], far_[row * 3 + 1], far_[row * 3 + 2]);
            seen[p] += 1.0f;
        }
    }

    void merge_class(const FieldBlock& block, Task& task, const ProbeClass& c, int d, bool occluded, bool make,
                     std::size_t& cursor) const {
        Rgb sum[kProbesAtOnce] = {}, far[kProbesAtOnce] = {};
        float seen[kProbesAtOnce] = {};
        Intervals intervals;
        const Segment ray = segment(d);
        march(block, task, c, ray, occluded, make, cursor, intervals);
        for (int p = 0; p < c.count; ++p)
            sum[p] = {intervals.red[p], intervals.green[p], intervals.blue[p]};
        const int corners = last_ ? 0 : corner_count(c.axes);
        for (int k = 0; k < corners; ++k) {
            const std::uint8_t* unhidden = nullptr;
            if (occluded && c.axes != 0) {
                if (make)
                    look_for_surfaces(task, c, {ray.end, ray.end + vec3(corner_offset(c.axes, k) * cascade_.stride)},
                                      0);
                unhidden = task.unhidden.data() + cursor;
                cursor += c.nodes.size();
            }
            add_corner(c, d, k, intervals, unhidden, far, seen);
        }
        // Corners behind a surface leave their weight to the others.
        for (int p = 0; p < c.count; ++p)
            if (seen[p] > 0.0f)
                sum[p] += far[p] / seen[p];
        if (index_ == 0)
            add_to_nodes(task, c, d, sum);
        else
            add_to_finer(task, c, d, sum);
    }

    void add_to_finer(const Task& task, const ProbeClass& c, int d, const Rgb* sum) const {
        const int children = all_.directions_->children(index_ - 1), count = all_.directions_->count(index_ - 1);
        for (int p = 0; p < c.count; ++p) {
            const std::int32_t probe = cascade_.probes.number[task.brick * BrickLattice::kNodes + c.nodes[p]];
            float* to = out_.far.data() + (std::size_t(probe) * count + d / children) * 3;
            for (int a = 0; a < 3; ++a)
                to[a] += sum[p][a] / float(children);
        }
    }

    void add_to_nodes(const Task& task, const ProbeClass& c, int d, const Rgb* sum) const {
        Gathered& light = *out_.light;
        const std::size_t n = light.fluence.size() / 3;
        const float solid_angle = 4.0f * kPi / float(all_.directions_->count(0));
        const auto& basis = all_.directions_->moment_basis(d);
        for (int p = 0; p < c.count; ++p) {
            const std::size_t i = task.brick * BrickLattice::kNodes + c.nodes[p];
            for (int a = 0; a < 3; ++a) {
                const float part = solid_angle * sum[p][a];
                light.fluence[a * n + i] += part;
                for (int m = 0; m < kShMoments && !light.moments.empty(); ++m)
                    light.moments[(3 * m + a) * n + i] += part * basis[m];
            }
        }
    }

    bool near_surfaces(const Task& task) const {
        const Medium& medium = all_.pyramid_.medium();
        const float spacing = float(1 << index_);
        const ivec3 first = cascade_.probes.lattice.first_node(task.brick) * (1 << index_);
        const vec3 middle = medium.local_of_node(first) +
                            medium.local_from_index * vec3(0.5f * spacing * float(BrickLattice::kSize - 1));
        float radius = 0.0f;
        for (int k = 0; k < 8; ++k)
            radius = std::max(
                radius, glm::distance(middle, medium.local_of_node(first + ((BrickLattice::kSize - 1) << index_) *
                                                                               ivec3(k & 1, k >> 1 & 1, k >> 2 & 1))));
        const float diagonal = glm::length(medium.local_from_index * vec3(spacing));
        return all_.pyramid_.occluders()->any_within(middle, radius + cascade_.end + 2.0f * diagonal);
    }

    // Appends how many of the samples along a segment from each probe lie before a surface, or kUnhidden.
    void look_for_surfaces(Task& task, const ProbeClass& c, const Segment& s, int samples) const {
        const Medium& medium = all_.pyramid_.medium();
        const ivec3 origin = cascade_.probes.lattice.first_node(task.brick);
        const vec3 begin = local_from_index_ * s.begin, way = local_from_index_ * (s.end - s.begin);
        const float length = glm::length(way);
        for (const int n : c.nodes) {
            const vec3 probe = medium.local_of_node((origin + BrickLattice::node_in_brick(n)) * (1 << index_));
            const float hit =
                length > 0.0f ? all_.pyramid_.occluders()->first_hit(probe + begin, way / length, length) : length;
            task.unhidden.push_back(
                hit < length ? static_cast<std::uint8_t>(std::min(hit / length * float(samples) + 0.5f, 254.0f))
                             : kUnhidden);
        }
    }

    const RadianceCascades& all_;
    const Cascade& cascade_;
    int index_;
    const CascadeField& field_;
    const std::vector<float>& far_;
    Output& out_;
    mat3 index_from_local_, local_from_index_;
    bool last_;
};

RadianceCascades::RadianceCascades(const ExtinctionPyramid& pyramid, const std::vector<std::uint8_t>& needed,
                                   const CascadeSettings& settings)
    : pyramid_(pyramid), settings_(settings), directional_(pyramid.medium().mean_cosine != 0.0f) {
    add_cascade(needed, pyramid.lattice(0));
    const float diagonal = local_bounds(pyramid.medium()).diagonal();
    while (cascades_.back().end < diagonal && int(cascades_.size()) < kMostCascades) {
        const BrickLattice& fine = cascades_.back().probes.lattice;
        std::vector<std::uint8_t> mask(fine.node_count());
        for (std::size_t i = 0; i < mask.size(); ++i)
            mask[i] = cascades_.back().probes.number[i] >= 0;
        BrickLattice coarse;
        std::vector<std::uint8_t> further = parents(fine, mask, coarse);
        add_cascade(std::move(further), std::move(coarse));
    }
    std::vector<bool> divided;
    int count = settings.side * settings.side;
    for (std::size_t i = 1; i < cascades_.size(); ++i) {
        divided.push_back(count * 4 <= settings.most_directions);
        count *= divided.back() ? 4 : 1;
    }
    directions_ = std::make_unique<CascadeDirections>(settings.side, divided);
    counts_.cascades = static_cast<int>(cascades_.size());
    counts_.directions = count;
    for (std::size_t i = 0; i < cascades_.size(); ++i) {
        add_tasks(cascades_[i], static_cast<int>(i));
        counts_.probes += cascades_[i].probes.count;
        counts_.intervals += cascades_[i].probes.count * directions_->count(static_cast<int>(i));
    }
    levels_.resize(std::size_t(cascades_.back().level) + 1);
    for (std::size_t l = 0; l < levels_.size(); ++l)
        levels_[l].occupied = occupied_nodes(pyramid.lattice(int(l)), pyramid.nodes(int(l)));
}

void RadianceCascades::add_cascade(std::vector<std::uint8_t> needed, BrickLattice lattice) {
    const int i = static_cast<int>(cascades_.size());
    const float unit = settings_.near * pyramid_.medium().spacing;
    const int level = std::clamp(i - settings_.finer, 0, pyramid_.level_count() - 1);
    // Only a single cascade can reach much farther than the medium does.
    const float end = std::min(unit * (float(2 << i) - 1.0f),
                               2.0f * local_bounds(pyramid_.medium()).diagonal() + (i > 0 ? unit : 0.0f));
    cascades_.push_back(
        {CascadeProbes(std::move(lattice), needed), unit * (float(1 << i) - 1.0f), end, level, 1 << (i - level), {}});
}

void RadianceCascades::add_tasks(Cascade& cascade, int index) const {
    const int count = directions_->count(index), groups = directional_ ? directions_->count(0) : 1;
    const int in_group = count / groups;
    const int at_once = index == 0 ? in_group : std::min(count / directions_->count(0), kDirectionsAtOnce);
    std::vector<std::size_t> bricks;
    for (std::size_t b = 0; b < cascade.probes.lattice.brick_count(); ++b) {
        const auto* first = cascade.probes.number.data() + b * BrickLattice::kNodes;
        if (std::any_of(first, first + BrickLattice::kNodes, [](std::int32_t n) { return n >= 0; }))
            bricks.push_back(b);
    }
    cascade.tasks.resize(groups);
    for (int g = 0; g < groups; ++g)
        for (const std::size_t b : bricks)
            for (int d = g * in_group; d < (g + 1) * in_group; d += at_once)
                cascade.tasks[g].push_back({b, d, d + at_once, {}});
}

// Source functions of coarser levels are means weighted by extinction: their products keep the light.
void RadianceCascades::average_source(std::span<const float> source, int channels) {
    levels_[0].source.assign(source.begin(), source.end());
    std::vector<float> light;
    for (std::size_t l = 0; l + 1 < levels_.size(); ++l) {
        const std::vector<float>& fine = pyramid_.nodes(int(l));
        const std::vector<float>& coarse = pyramid_.nodes(int(l + 1));
        light = levels_[l].source;
        parallel_for(
            fine.size(),
            [&](std::size_t i) {
                for (int c = 0; c < channels; ++c)
                    light[i * channels + c] *= fine[i];
            },
            4096);
        BrickLattice lattice;
        coarsen(pyramid_.lattice(int(l)), light, channels, lattice, levels_[l + 1].source);
        parallel_for(
            coarse.size(),
            [&](std::size_t i) {
                for (int c = 0; c < channels; ++c)
                    if (float& s = levels_[l + 1].source[i * channels + c]; coarse[i] > 0.0f)
                        s /= coarse[i];
                    else
                        s = 0.0f;
            },
            4096);
    }
}

void RadianceCascades::combine(int level, int channels, int direction) {
    const std::vector<float>& extinction = pyramid_.nodes(level);
    const std::vector<float>& source = levels_[level].source;
    const auto& basis = directions_->mean_basis(direction);
    field_.resize(extinction.size() * 4);
    parallel_for(
        extinction.size(),
        [&](std::size_t i) {
            const float* from = source.data() + i * channels;
            for (int c = 0; c < 3; ++c) {
                float sum = from[c];
                for (int m = 0; m < kShMoments && channels > 3; ++m)
                    sum += from[3 + 3 * m + c] * basis[m];
                field_[i * 4 + c] = sum;
            }
            field_[i * 4 + 3] = extinction[i];
        },
        4096);
}

void RadianceCascades::merge(int index, int channels, const std::vector<float>& far, Output& out) {
    Cascade& cascade = cascades_[index];
    const CascadeField field{&pyramid_.lattice(cascade.level), &field_};
    const Merge merge(*this, index, field, far, out);
    for (std::size_t g = 0; g < cascade.tasks.size(); ++g) {
        if (g == 0 || channels > 3)
            combine(cascade.level, channels, static_cast<int>(g));
        parallel_for(cascade.tasks[g].size(), [&](std::size_t t) { merge.run(cascade.tasks[g][t]); });
    }
}

Gathered RadianceCascades::gather(std::span<const float> source, int channels) {
    Gathered light;
    light.resize(pyramid_.lattice(0).node_count(), false, channels > 3);
    average_source(source, channels);
    std::vector<float> far;
    for (int i = counts_.cascades - 1; i >= 0; --i) {
        Output out;
        out.light = &light;
        if (i > 0)
            out.far.assign(cascades_[i].probes.count * directions_->count(i - 1) * 3, 0.0f);
        merge(i, channels, far, out);
        far = std::move(out.far);
    }
    return light;
}

std::uint64_t RadianceCascades::bytes() const {
    std::uint64_t sum = field_.size() * sizeof(float);
    for (const Level& l : levels_)
        sum += l.source.size() * sizeof(float) + l.occupied.size() * sizeof(OccupiedNodes);
    for (std::size_t i = 0; i < cascades_.size(); ++i) {
        const Cascade& c = cascades_[i];
        sum += c.probes.lattice.bytes() + c.probes.number.size() * sizeof(std::int32_t);
        if (i > 0)
            sum += c.probes.count * directions_->count(int(i) - 1) * 3 * sizeof(float);
        for (const auto& group : c.tasks)
            for (const Task& t : group)
                sum += sizeof(Task) + t.unhidden.size();
    }
    return sum;
}

}  // namespace brisance
