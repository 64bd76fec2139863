#include "tracking/tracking_field.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "core/parallel.h"

namespace brisance {

namespace {

constexpr int kSide = BrickLattice::kSize + 1;
constexpr int kRecords = kSide * kSide * kSide;

struct Corner {
    std::size_t first;  // of the voxel's eight corners
    vec3 fraction;
};

Corner corner_of(std::size_t records, const vec3& p) {
    const ivec3 base = glm::min(ivec3(p), ivec3(BrickLattice::kSize - 1));
    return {records + (base.x * kSide + base.y) * kSide + base.z, p - vec3(base)};
}

// `load(i)`: the i-th record from the voxel's first corner.
template <class Load>
auto trilinear(const Load& load, const vec3& f) {
    const auto along_z = [&](int at) {
        const auto low = load(at);
        return low + f.z * (load(at + 1) - low);
    };
    const auto plane = [&](int at) {
        const auto low = along_z(at);
        return low + f.y * (along_z(at + kSide) - low);
    };
    const auto low = plane(0);
    return low + f.x * (plane(kSide * kSide) - low);
}

float interpolate(const float* v, const vec3& f) {
    return trilinear([v](int i) { return v[i]; }, f);
}

// A colour and whatever follows it, in one register: kPadding records behind a field's last may be read.
typedef float Float4 __attribute__((vector_size(16)));
constexpr std::size_t kPadding = 1;

Rgb interpolate(const Rgb* v, const vec3& f) {
    const auto load = [v](int i) {
        Float4 record;
        std::memcpy(&record, v + i, sizeof record);
        return record;
    };
    const Float4 c = trilinear(load, f);
    return {c[0], c[1], c[2]};
}

// Of a colour field with that many records; none: empty.
std::size_t padded(std::size_t records) {
    return records > 0 ? records + kPadding : 0;
}

void copy_rgb(const Medium& medium, const std::vector<Rgb>& field, const ivec3& low, Rgb* out) {
    std::vector<float> box(3 * kRecords);
    copy_box(medium.lattice, {reinterpret_cast<const float*>(field.data()), field.size() * 3}, 3, low, ivec3(kSide),
             box);
    for (int i = 0; i < kRecords; ++i)
        out[i] = {box[i], box[kRecords + i], box[2 * kRecords + i]};
}

// Whether a node of the medium glows: by its own emission, or as the source of what absorbs around it.
bool glows(const Medium& medium, std::size_t node) {
    return (!medium.source.empty() && medium.source[node] != Rgb(0.0f)) ||
           (!medium.emission.empty() && medium.emission[node] != Rgb(0.0f));
}

// Of the medium's bricks, those with a node that glows.
std::vector<std::uint8_t> glowing_bricks(const Medium& medium) {
    std::vector<std::uint8_t> out(medium.lattice.brick_count());
    if (medium.emits())
        parallel_for(
            out.size(),
            [&](std::size_t b) {
                for (std::size_t n = b * BrickLattice::kNodes; !out[b] && n < (b + 1) * BrickLattice::kNodes; ++n)
                    out[b] = glows(medium, n);
            },
            64);
    return out;
}

// Whether a record of a brick glows, whose first node is `low`. Most bricks are known by the medium's.
bool any_glows(const Medium& medium, const std::vector<std::uint8_t>& glowing, const ivec3& low) {
    bool may = false;
    for (int k = 0; k < 8; ++k) {
        const int b = medium.lattice.find((low >> 3) + ivec3(k >> 2, k >> 1 & 1, k & 1));
        may = may || (b >= 0 && glowing[b]);
    }
    for (int i = 0; may && i < kRecords; ++i) {
        const std::int64_t n = medium.lattice.find_node(low + ivec3(i / (kSide * kSide), i / kSide % kSide, i % kSide));
        if (n >= 0 && glows(medium, n))
            return true;
    }
    return false;
}

}  // namespace

TrackingField::TrackingField(const Medium& medium)
    : medium_(&medium),
      index_from_local_(glm::inverse(dmat3(medium.world_from_index))),
      bricks_(voxel_lattice(medium)),
      extinction_(bricks_.brick_count() * kRecords),
      albedo_(medium.albedo_nodes.empty() ? 0 : padded(bricks_.brick_count() * kRecords)),
      fire_index_(bricks_.brick_count(), -1),
      minimum_(bricks_.brick_count()),
      majorant_(bricks_.brick_count()),
      mean_(bricks_.brick_count()) {
    const std::vector<std::uint8_t> glowing = glowing_bricks(medium);
    parallel_for(bricks_.brick_count(), [&](std::size_t b) { copy_brick(b, glowing); });
    std::int32_t burning = 0;
    for (std::int32_t& f : fire_index_)
        f = f < 0 ? -1 : burning++;
    source_.resize(medium.source.empty() ? 0 : padded(burning * std::size_t(kRecords)));
    emission_.resize(medium.emission.empty() ? 0 : padded(burning * std::size_t(kRecords)));
    burning_voxel_.resize(burning * std::size_t(BrickLattice::kNodes));
    parallel_for(bricks_.brick_count(), [&](std::size_t b) { copy_fire(b); });
}

void TrackingField::copy_brick(std::size_t brick, const std::vector<std::uint8_t>& glowing) {
    const Medium& medium = *medium_;
    const ivec3 low = bricks_.first_node(brick);
    float* sigma = &extinction_[brick * kRecords];
    copy_box(medium.lattice, medium.extinction, 1, low, ivec3(kSide), {sigma, std::size_t(kRecords)});
    const auto [least, greatest] = std::minmax_element(sigma, sigma + kRecords);
    minimum_[brick] = *least;
    majorant_[brick] = *greatest;
    mean_[brick] = float(std::accumulate(sigma, sigma + kRecords, 0.0) / kRecords);
    for (int i = 0; !albedo_.empty() && i < kRecords; ++i) {
        const std::int64_t n = medium.lattice.find_node(low + ivec3(i / (kSide * kSide), i / kSide % kSide, i % kSide));
        albedo_[brick * kRecords + i] = n < 0 ? medium.albedo : medium.albedo_nodes[n];
    }
    fire_index_[brick] = any_glows(medium, glowing, low) ? 0 : -1;
}

void TrackingField::copy_fire(std::size_t brick) {
    const std::int32_t fire = fire_index_[brick];
    if (fire < 0)
        return;
    const ivec3 low = bricks_.first_node(brick);
    const std::size_t first = fire * std::size_t(kRecords);
    if (!source_.empty())
        copy_rgb(*medium_, medium_->source, low, &source_[first]);
    if (!emission_.empty())
        copy_rgb(*medium_, medium_->emission, low, &emission_[first]);
    const auto record_glows = [&](const ivec3& p) {
        const std::size_t i = first + (p.x * kSide + p.y) * kSide + p.z;
        return (!source_.empty() && source_[i] != Rgb(0.0f)) || (!emission_.empty() && emission_[i] != Rgb(0.0f));
    };
    for (int c = 0; c < BrickLattice::kNodes; ++c)
        for (int k = 0; k < 8; ++k)
            if (record_glows(BrickLattice::node_in_brick(c) + ivec3(k >> 2, k >> 1 & 1, k & 1)))
                burning_voxel_[fire * std::size_t(BrickLattice::kNodes) + c] = 1;
}

float TrackingField::extinction(std::size_t brick, const vec3& p) const {
    const Corner c = corner_of(brick * kRecords, p);
    return interpolate(&extinction_[c.first], c.fraction);
}

Rgb TrackingField::albedo(std::size_t brick, const vec3& p) const {
    if (albedo_.empty())
        return medium_->albedo;
    const Corner c = corner_of(brick * kRecords, p);
    return interpolate(&albedo_[c.first], c.fraction);
}

Rgb TrackingField::source(std::size_t brick, const vec3& p) const {
    const Corner c = corner_of(fire_index_[brick] * std::size_t(kRecords), p);
    return interpolate(&source_[c.first], c.fraction);
}

Rgb TrackingField::emission(std::size_t brick, const vec3& p) const {
    const Corner c = corner_of(fire_index_[brick] * std::size_t(kRecords), p);
    return interpolate(&emission_[c.first], c.fraction);
}

// The trilinear polynomial a + bx + cy + dz + exy + fxz + gyz + hxyz of the voxel, along p(u) = q + u w.
Cubic TrackingField::extinction_along(const VoxelSegment& s) const {
    const ivec3& voxel = s.cube;
    const float* v = &extinction_[s.brick * kRecords + (voxel.x * kSide + voxel.y) * kSide + voxel.z];
    const double v000 = v[0], v001 = v[1], v010 = v[kSide], v011 = v[kSide + 1];
    const float* x = v + kSide * kSide;
    const double v100 = x[0], v101 = x[1], v110 = x[kSide], v111 = x[kSide + 1];
    const double b = v100 - v000, c = v010 - v000, d = v001 - v000;
    const double e = v110 - v100 - c, f = v101 - v100 - d, g = v011 - v010 - d;
    const double h = v111 - v110 - v101 + v100 - g;
    const dvec3 q = s.origin + s.direction * s.begin - dvec3(voxel), w = s.direction * (s.end - s.begin);
    Cubic out;
    out.c[0] = v000 + q.x * (b + q.y * (e + q.z * h) + q.z * f) + q.y * (c + q.z * g) + q.z * d;
    out.c[1] = w.x * (b + q.y * (e + q.z * h) + q.z * f) + w.y * (c + q.x * (e + q.z * h) + q.z * g) +
               w.z * (d + q.x * (f + q.y * h) + q.y * g);
    out.c[2] = w.x * w.y * (e + q.z * h) + w.x * w.z * (f + q.y * h) + w.y * w.z * (g + q.x * h);
    out.c[3] = w.x * w.y * w.z * h;
    return out;
}

bool TrackingField::voxel_burns(const VoxelSegment& s) const {
    const std::int32_t fire = fire_index_[s.brick];
    return fire >= 0 &&
           burning_voxel_[fire * std::size_t(BrickLattice::kNodes) + BrickLattice::offset_in_brick(s.cube)];
}

double TrackingField::smoke_volume() const {
    const auto bricks = std::count_if(majorant_.begin(), majorant_.end(), [](float m) { return m > 0.0f; });
    return double(bricks) * BrickLattice::kNodes * std::abs(glm::determinant(dmat3(medium().local_from_index)));
}

std::uint64_t TrackingField::bytes() const {
    return (extinction_.size() + minimum_.size() + majorant_.size() + mean_.size() + fire_index_.size()) *
               sizeof(float) +
           (albedo_.size() + source_.size() + emission_.size()) * sizeof(Rgb) + burning_voxel_.size() + bricks_.bytes();
}

}  // namespace brisance
