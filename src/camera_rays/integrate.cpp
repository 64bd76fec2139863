#include "camera_rays/integrate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "camera_rays/record_kernels.h"

namespace brisance {

namespace {

// Where on a segment the parts are sampled: Gauss points for two, so that a cubic extinction's integral is exact; the
// middles otherwise.
float position_in_part(int part, int parts) {
    if (parts == 2)
        return part == 0 ? 0.21132487f : 0.78867513f;
    return (part + 0.5f) / parts;
}

// What is seen of a thick voxel is its near end: sources that vary along it want more parts than extinction does.
constexpr float kThickVoxel = 0.5f;
constexpr int kThickVoxelParts = 4, kOpaqueVoxelParts = 8;

Rgb slot(const float* record, int at) {
    return {record[at], record[at + 1], record[at + 2]};
}

// A part of a voxel's segment: constant coefficients, `length` metres at `distance`.
struct Part {
    SourceRecord record;
    SimilarRecord similar;
    SurroundingsRecord outside;  // where the field has one
    float length, distance;
};

// What such a part shows: the integral of transmittance along it [m], and that times its extinction.
struct Shown {
    float path, opacity;
};

Shown shown(float extinction, float length, float& depth) {
    const float tau = extinction * length;
    const float path = std::exp(-depth) * length * phi1(tau);
    depth += tau;
    return {path, path * extinction};
}

void add_part(RaySum& sum, const SourceField& field, const Part& p) {
    const float* r = p.record.value;
    const Shown own = shown(r[SourceRecord::Extinction], p.length, sum.depth);
    const Rgb v = slot(r, SourceRecord::V) * (field.direct_emission() ? own.path : own.opacity);
    const float* s = p.similar.value;
    const Shown scattering = shown(s[SimilarRecord::Extinction], p.length, sum.similar_depth);
    // Fire seen by one scattering that did not turn it: by all smoke before it.
    const Rgb forward = slot(s, SimilarRecord::Forward);
    const float tau = r[SourceRecord::Extinction] * p.length;
    sum.cells.at(Cell::MV) += v * (sum.forward + forward * mean_depth(tau));
    sum.forward += forward * tau;
    // The similar medium shows more of the fire by what counts as not scattered there.
    sum.cells.at(Cell::MV) +=
        slot(s, SimilarRecord::V) * (field.direct_emission() ? scattering.path : scattering.opacity) - v;
    sum.cells.at(Cell::V) += v;
    sum.cells.at(Cell::MV) += slot(r, SourceRecord::MV) * scattering.opacity;
    sum.cells.at(Cell::MM) += slot(r, SourceRecord::MM) * scattering.opacity;
    if (field.has_outside()) {
        sum.cells.at(Cell::MS) += slot(p.outside.value, SurroundingsRecord::MS) * scattering.opacity;
        sum.cells.at(Cell::MA) +=
            slot(p.outside.value, SurroundingsRecord::MA) * (field.emitters_share() * scattering.opacity);
    }
    sum.albedo_sum += Rgb(own.opacity * r[SourceRecord::Albedo]);
    sum.distance_weight += own.opacity;
    sum.distance_sum += own.opacity * p.distance;
}

int parts_of(const SourceField& field, const VoxelSegment& s) {
    const auto length = static_cast<float>(s.end - s.begin);
    if (field.majorant(s.brick) * length <= kThickVoxel)
        return 1;
    const float depth = field.majorant_of_voxel(s.brick, s.cube) * length;
    return depth <= kThickVoxel ? 1 : (depth <= 2.0f * kThickVoxel ? kThickVoxelParts : kOpaqueVoxelParts);
}

// Visits a voxel's parts until visit(distance of its point, length) returns false.
template <class Visit>
bool visit_parts(const VoxelSegment& s, int parts, const Visit& visit) {
    const double length = s.end - s.begin;
    const auto of_part = static_cast<float>(length / parts);
    for (int k = 0; k < parts; ++k) {
        const double t = s.begin + length * position_in_part(k, parts);
        if (!visit(t, of_part))
            return false;
    }
    return true;
}

// The same of every voxel, with what the field holds there.
template <class Visit>
void walk_parts(const SourceField& field, const Ray& ray, int parts, const RayEnd& end, const Visit& visit) {
    const OneSidedVoxels at_end(field, end);
    const auto visit_voxel = [&](const VoxelSegment& s) {
        const BrickRecords records = at_end.cuts(s) ? at_end.in_front(s) : records_of(field, s.brick);
        return visit_parts(s, std::max(parts, parts_of(field, s)), [&](double t, float length) {
            const vec3 p = position_in_brick(s, t);
            Part part{
                interpolated(records.own, p), field.sample_similar(s.brick, p), {}, length, static_cast<float>(t)};
            if (records.outside)
                part.outside = interpolated(records.outside, p);
            return visit(part);
        });
    };
    walk_voxels(field, ray, visit_voxel, end.distance);
}

// Parts of a ray in one brick, on their way to the kernel.
class PartsOfBrick {
public:
    PartsOfBrick(const SourceField& field, const VoxelSegment& brick, RecordSums& sums)
        : PartsOfBrick(field, brick, records_of(field, brick.brick), sums) {}
    // By other records: those of a voxel that a surface cuts.
    PartsOfBrick(const SourceField& field, const VoxelSegment& brick, const BrickRecords& records, RecordSums& sums)
        : ray_{records.own, records.outside, vec3(brick.origin + brick.direction * brick.begin), vec3(brick.direction),
               float(brick.begin)},
          begin_(brick.begin),
          emits_(field.direct_emission()),
          sums_(sums) {}

    // Both return whether what lies behind can be seen, as far as the parts of before are added. `splits`: that of
    // RayPart.
    bool take(double t, float length, bool splits) {
        parts_[count_++] = {static_cast<float>(t - begin_), length, splits};
        return count_ < kMost || add();
    }
    bool take(const SourceField& field, const VoxelSegment& s, int parts) {
        const int of_voxel = parts_of(field, s);
        if (parts == 2 && of_voxel == 1)
            return take(0.5 * (s.begin + s.end), static_cast<float>(s.end - s.begin), true);
        return visit_parts(s, std::max(parts, of_voxel),
                           [&](double t, float length) { return take(t, length, false); });
    }
    bool add() { return add_parts(ray_, emits_, parts_.data(), std::exchange(count_, 0), sums_); }

private:
    static constexpr std::size_t kMost = 64;  // more than a brick of thin voxels has, and few enough to stay near
    RayInBrick ray_;
    double begin_;
    bool emits_;
    RecordSums& sums_;
    std::array<RayPart, kMost> parts_;
    std::size_t count_ = 0;
};

RaySum ray_sum(const RecordSums& seen, const SourceField& field) {
    RaySum out;
    out.depth = out.similar_depth = seen.depth;
    out.cells.at(Cell::V) = slot(field.direct_emission() ? seen.emitted : seen.own, SourceRecord::V);
    out.cells.at(Cell::MV) = slot(seen.own, SourceRecord::MV);
    out.cells.at(Cell::MM) = slot(seen.own, SourceRecord::MM);
    out.cells.at(Cell::MS) = slot(seen.outside, SurroundingsRecord::MS);
    out.cells.at(Cell::MA) = field.emitters_share() * slot(seen.outside, SurroundingsRecord::MA);
    out.albedo_sum = Rgb(seen.own[SourceRecord::Albedo]);
    out.distance_weight = seen.opacity;
    out.distance_sum = seen.distance;
    return out;
}

// What add_part() sums, where light scatters in the medium itself: records as a whole.
RaySum integrate_whole_records(const SourceField& field, const Ray& ray, int parts, const RayEnd& end) {
    RecordSums light;
    const OneSidedVoxels at_end(field, end);
    const auto visit_brick = [&](const VoxelSegment& brick) {
        PartsOfBrick taken(field, brick, light);
        const bool may_cut = at_end.may_cut(brick);
        const auto visit_voxel = [&](const VoxelSegment& s) {
            if (!may_cut || !at_end.cuts(s))
                return taken.take(field, s, parts);
            if (!taken.add())
                return false;
            PartsOfBrick one_sided(field, brick, at_end.in_front(s), light);
            return one_sided.take(field, s, parts) && one_sided.add();
        };
        return walk_cubes<1>(brick, visit_voxel) && taken.add();
    };
    walk_bricks(field.bricks(), lattice_ray(field.bricks(), field.medium(), ray, end.distance), visit_brick);
    return ray_sum(light, field);
}

// Where light was traced through a similar medium.
RaySum integrate_two_media(const SourceField& field, const Ray& ray, int parts, const RayEnd& end) {
    RaySum sum;
    walk_parts(field, ray, parts, end, [&](const Part& part) {
        add_part(sum, field, part);
        return sum.similar_depth < kOpaqueDepth;
    });
    return sum;
}

}  // namespace

RaySum integrate(const SourceField& field, const Ray& ray, int parts, const RayEnd& end) {
    RaySum sum = field.has_similar() ? integrate_two_media(field, ray, parts, end)
                                     : integrate_whole_records(field, ray, parts, end);
    sum.alpha = -std::expm1(-sum.depth);
    sum.through = 1.0f - sum.alpha;
    return sum;
}

void guide_by_emitters(const SourceField& field, const Ray& ray, double end, StepDensity& guide) {
    guide.clear();
    if (!field.has_emitters())
        return;
    float depth = 0.0f;
    const auto add_voxel = [&](const VoxelSegment& s) {
        const vec3 middle = position_in_brick(s, 0.5 * (s.begin + s.end));
        const SourceRecord own = field.sample(s.brick, middle);
        const SurroundingsRecord outside = field.sample_outside(s.brick, middle);
        const Shown seen = shown(own.value[SourceRecord::Extinction], static_cast<float>(s.end - s.begin), depth);
        guide.add(s.begin, s.end, seen.opacity * luminance(slot(outside.value, SurroundingsRecord::MA)));
        return depth < kOpaqueDepth;
    };
    walk_voxels(field, ray, add_voxel, end);
}

}  // namespace brisance
