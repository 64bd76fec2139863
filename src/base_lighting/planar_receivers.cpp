#include "base_lighting/planar_receivers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "medium/lattice/local_bounds.h"

namespace brisance {

namespace lit_planes {

// Side of the smallest and of the largest cells, powers of two of a voxel.
constexpr int kFinest = -1, kCoarsest = 8;
// Largest side of a cell, relative to the distance from the smoke, and in voxels where that is more.
constexpr float kSideOfDistance = 0.25f, kSideInVoxels = 4.0f;
// Largest difference between what a cell's corners predict and what is found between them, relative to the light there.
// Parabolas through all of them are off by far less: on a floor that cuts an explosion, by 0.2 % of the picture.
constexpr float kPredicted = 0.12f;
// A cell has nine points, most of which it shares.
constexpr std::size_t kWorthACell = 5;

// Of normals, and of the distance of planes from the origin in voxels: those of one surface differ by rounding alone.
constexpr float kNormalStep = 0x1p-15f, kOffsetStep = 0.02f, kOffsetShift = 0.37f;

struct Plane {
    ivec3 normal;
    std::int64_t offset;
    auto operator<=>(const Plane& o) const {
        return std::tie(normal.x, normal.y, normal.z, offset) <=>
               std::tie(o.normal.x, o.normal.y, o.normal.z, o.offset);
    }
    bool operator==(const Plane&) const = default;
};

// Coordinates on a plane, in voxels. The largest cells begin at the same places of the world wherever the medium's
// local origin lies, which another frame's bounds may move.
class PlaneFrame {
public:
    PlaneFrame(const Plane& plane, const Medium& medium)
        : voxel_(medium.spacing), normal_(glm::normalize(vec3(plane.normal))) {
        const vec3 a = glm::abs(normal_);
        const vec3 other = a.x <= a.y && a.x <= a.z ? vec3(1, 0, 0) : (a.y <= a.z ? vec3(0, 1, 0) : vec3(0, 0, 1));
        u_ = glm::normalize(glm::cross(normal_, other));
        v_ = glm::cross(normal_, u_);
        origin_ = normal_ * ((float(plane.offset) + 0.5f - kOffsetShift) * kOffsetStep * voxel_);
        const dvec3 from_world = dmat3(medium.local_from_index) * dvec3(medium.reference_node) / double(voxel_);
        const double side = std::ldexp(1.0, kCoarsest);
        shift_ =
            vec2(std::fmod(glm::dot(from_world, dvec3(u_)), side), std::fmod(glm::dot(from_world, dvec3(v_)), side));
    }
    vec2 on_plane(const vec3& local) const { return vec2(glm::dot(local, u_), glm::dot(local, v_)) / voxel_ + shift_; }
    vec3 local(const vec2& p) const {
        const vec2 q = p - shift_;
        return origin_ + voxel_ * (q.x * u_ + q.y * v_);
    }
    const vec3& normal() const { return normal_; }

private:
    float voxel_;
    vec3 normal_, u_, v_, origin_;
    vec2 shift_;
};

// All four of a receiver's lights.
struct Light {
    std::array<Rgb, 2> fire{}, smoke{};
};

template <class Use>
void for_parts(const Use& use) {
    for (int part = 0; part < 2; ++part) {
        use([part](auto& light) -> auto& { return light.fire[part]; });
        use([part](auto& light) -> auto& { return light.smoke[part]; });
    }
}

float total(const Light& light) {
    float sum = 0.0f;
    for_parts([&](const auto& part) { sum += luminance(part(light)); });
    return sum;
}

// a (1 - t) + b t
Light between(const Light& a, const Light& b, float t) {
    Light out;
    for_parts([&](const auto& part) { part(out) = part(a) * (1.0f - t) + part(b) * t; });
    return out;
}

// Through values at 0, 1/2 and 1, and never below zero.
Light parabola(const std::array<Light, 3>& at, float t) {
    Light out;
    for_parts([&](const auto& part) {
        const Rgb sum = part(at[0]) * ((1.0f - t) * (1.0f - 2.0f * t)) + part(at[1]) * (4.0f * t * (1.0f - t)) +
                        part(at[2]) * (t * (2.0f * t - 1.0f));
        part(out) = glm::max(sum, Rgb(0.0f));
    });
    return out;
}

float difference(const Light& a, const Light& b) {
    float sum = 0.0f;
    for_parts([&](const auto& part) { sum += luminance(glm::abs(part(a) - part(b))); });
    return sum;
}

struct PlaneCell {
    int level;
    std::int32_t x, y;
    std::vector<std::uint32_t> receivers;

    float side() const { return std::ldexp(1.0f, level); }
};

// Points of all levels, in half sides of the finest cells.
std::uint64_t point_key(std::int32_t x, std::int32_t y) {
    return std::uint64_t(std::uint32_t(x)) << 32 | std::uint32_t(y);
}

// The lattice of one plane. Receivers are lit in rounds: in each, cells ask for the points they lack, and then either
// interpolate or are divided.
class LitPlane {
public:
    LitPlane(const Plane& plane, const Medium& medium)
        : bounds_(local_bounds(medium)), voxel_(medium.spacing), frame_(plane, medium) {}

    void begin(const std::vector<SurfaceReceiver>& receivers, const std::vector<std::uint32_t>& on_plane) {
        cells_ = cells_of(receivers, on_plane);
    }
    bool done() const { return cells_.empty(); }

    // Appends the points of the lattice that the cells of this round lack.
    void ask(const std::vector<SurfaceReceiver>& receivers, std::vector<SurfaceReceiver>& points) {
        while (divide_too_large(receivers)) {
        }
        asked_.clear();
        for (const PlaneCell& cell : cells_)
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i)
                    if (points_.try_emplace(key(cell, i, j)).second) {
                        const vec2 p = (vec2(cell.x, cell.y) + 0.5f * vec2(i, j)) * cell.side();
                        points.push_back({frame_.local(p), frame_.normal()});
                        asked_.push_back(key(cell, i, j));
                    }
    }

    // `lit`: begins with the points that the plane asked for; returns the rest.
    std::span<const SurfaceReceiver> answer(std::span<const SurfaceReceiver> lit,
                                            std::vector<SurfaceReceiver>& receivers) {
        for (std::size_t k = 0; k < asked_.size(); ++k)
            points_[asked_[k]] = {lit[k].fire, lit[k].smoke};
        std::vector<PlaneCell> next;
        for (const PlaneCell& cell : cells_)
            if (predicted(cell))
                interpolate(cell, receivers);
            else
                divide(cell, receivers, next);
        cells_ = std::move(next);
        return lit.subspan(asked_.size());
    }

    // Those that are to be gathered themselves.
    std::vector<std::uint32_t> take_alone() { return std::exchange(alone_, {}); }

private:
    using Corners = std::array<std::array<Light, 3>, 3>;  // [y][x]

    std::vector<PlaneCell> cells_of(const std::vector<SurfaceReceiver>& receivers,
                                    const std::vector<std::uint32_t>& on_plane) const {
        std::map<std::pair<std::int32_t, std::int32_t>, std::vector<std::uint32_t>> sorted;
        for (const std::uint32_t r : on_plane) {
            const vec2 p = glm::floor(frame_.on_plane(receivers[r].local) / std::ldexp(1.0f, kCoarsest));
            sorted[{std::int32_t(p.x), std::int32_t(p.y)}].push_back(r);
        }
        std::vector<PlaneCell> cells;
        cells.reserve(sorted.size());
        for (auto& [at, inside] : sorted)
            cells.push_back({kCoarsest, at.first, at.second, std::move(inside)});
        return cells;
    }

    bool too_large(const PlaneCell& cell) const {
        if (cell.level == kFinest)
            return false;
        const vec3 middle = frame_.local((vec2(cell.x, cell.y) + 0.5f) * cell.side());
        return cell.side() * voxel_ > std::max(kSideOfDistance * bounds_.distance(middle), kSideInVoxels * voxel_);
    }

    // Sorts out cells with too few receivers and divides those that are too large, once. Returns whether it divided
    // any.
    bool divide_too_large(const std::vector<SurfaceReceiver>& receivers) {
        std::vector<PlaneCell> kept;
        bool divided = false;
        for (PlaneCell& cell : cells_)
            if (cell.receivers.size() < kWorthACell) {
                alone_.insert(alone_.end(), cell.receivers.begin(), cell.receivers.end());
            } else if (too_large(cell)) {
                divide(cell, receivers, kept);
                divided = true;
            } else {
                kept.push_back(std::move(cell));
            }
        cells_ = std::move(kept);
        return divided;
    }

    std::uint64_t key(const PlaneCell& cell, int i, int j) const {
        const int half = 1 << (cell.level - kFinest);
        return point_key((2 * cell.x + i) * half, (2 * cell.y + j) * half);
    }

    Corners corners(const PlaneCell& cell) const {
        Corners c;
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i)
                c[j][i] = points_.at(key(cell, i, j));
        return c;
    }

    bool predicted(const PlaneCell& cell) const {
        const Corners c = corners(cell);
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) {
                const Light by_corners =
                    between(between(c[0][0], c[0][2], 0.5f * i), between(c[2][0], c[2][2], 0.5f * i), 0.5f * j);
                if (!(difference(by_corners, c[j][i]) <= kPredicted * total(c[j][i])))
                    return false;
            }
        return true;
    }

    void interpolate(const PlaneCell& cell, std::vector<SurfaceReceiver>& receivers) const {
        const Corners c = corners(cell);
        for (const std::uint32_t r : cell.receivers) {
            const vec2 p = glm::clamp(frame_.on_plane(receivers[r].local) / cell.side() - vec2(cell.x, cell.y),
                                      vec2(0.0f), vec2(1.0f));
            const Light light = parabola({parabola(c[0], p.x), parabola(c[1], p.x), parabola(c[2], p.x)}, p.y);
            receivers[r].fire = light.fire;
            receivers[r].smoke = light.smoke;
        }
    }

    void divide(const PlaneCell& cell, const std::vector<SurfaceReceiver>& receivers, std::vector<PlaneCell>& out) {
        if (cell.level == kFinest) {
            alone_.insert(alone_.end(), cell.receivers.begin(), cell.receivers.end());
            return;
        }
        std::array<PlaneCell, 4> parts;
        for (int k = 0; k < 4; ++k)
            parts[k] = {cell.level - 1, 2 * cell.x + (k & 1), 2 * cell.y + (k >> 1), {}};
        const float side = parts[0].side();
        for (const std::uint32_t r : cell.receivers) {
            const vec2 p = frame_.on_plane(receivers[r].local) / side;
            parts[(p.x >= float(parts[3].x) ? 1 : 0) + (p.y >= float(parts[3].y) ? 2 : 0)].receivers.push_back(r);
        }
        for (PlaneCell& part : parts)
            if (!part.receivers.empty())
                out.push_back(std::move(part));
    }

    LocalBounds bounds_;
    float voxel_;
    PlaneFrame frame_;
    std::unordered_map<std::uint64_t, Light> points_;
    std::vector<PlaneCell> cells_;      // of this round
    std::vector<std::uint64_t> asked_;  // points
    std::vector<std::uint32_t> alone_;
};

// Farther from the origin, in voxels, lattices are not numbered.
constexpr float kFarthest = 0x1p26f;

// None where its numbers would not fit.
std::optional<Plane> plane_of(const SurfaceReceiver& r, float voxel) {
    const vec3 at = glm::abs(r.local) / voxel;
    if (!(at.x + at.y + at.z < kFarthest) || !(glm::dot(r.normal, r.normal) < 2.0f))
        return std::nullopt;
    const double offset = glm::dot(dvec3(r.local), dvec3(r.normal)) / (double(kOffsetStep) * voxel);
    return Plane{ivec3(glm::round(r.normal / kNormalStep)), std::int64_t(std::floor(offset + kOffsetShift))};
}

// Calls after which a plane that none of them met is forgotten: rows of a picture, and what mirrors show from them,
// come in calls of their own and meet each other's planes again.
constexpr std::uint64_t kCallsKept = 16;

struct KnownPlane {
    LitPlane plane;
    std::uint64_t last_met;  // call
};

struct Planes {
    std::map<Plane, KnownPlane> lit;
    std::uint64_t call = 0;
};

}  // namespace lit_planes

using namespace lit_planes;

PlanarLight::PlanarLight(const Medium& medium) : medium_(medium), planes_(std::make_unique<Planes>()) {}
PlanarLight::~PlanarLight() = default;

// Returns those that are to be gathered themselves.
std::vector<std::uint32_t> PlanarLight::interpolate(std::vector<SurfaceReceiver>& receivers,
                                                    const GatherReceivers& gather) {
    std::map<Plane, std::vector<std::uint32_t>> seen;
    std::vector<std::uint32_t> alone;
    for (std::uint32_t i = 0; i < receivers.size(); ++i)
        if (const std::optional<Plane> plane = plane_of(receivers[i], medium_.spacing))
            seen[*plane].push_back(i);
        else
            alone.push_back(i);
    const std::uint64_t call = ++planes_->call;
    std::vector<LitPlane*> busy;
    for (const auto& [plane, on_plane] : seen)
        if (on_plane.size() < kWorthACell) {
            alone.insert(alone.end(), on_plane.begin(), on_plane.end());
        } else {
            KnownPlane& known =
                planes_->lit.try_emplace(plane, KnownPlane{LitPlane(plane, medium_), call}).first->second;
            known.last_met = call;
            known.plane.begin(receivers, on_plane);
            busy.push_back(&known.plane);
        }
    std::erase_if(planes_->lit, [&](const auto& known) { return call - known.second.last_met > kCallsKept; });
    while (!busy.empty()) {
        std::vector<SurfaceReceiver> points;
        for (LitPlane* plane : busy)
            plane->ask(receivers, points);
        gather(points);
        std::span<const SurfaceReceiver> lit = points;
        for (LitPlane* plane : busy)
            lit = plane->answer(lit, receivers);
        std::erase_if(busy, [](const LitPlane* plane) { return plane->done(); });
    }
    for (auto& [at, known] : planes_->lit) {
        const std::vector<std::uint32_t> rest = known.plane.take_alone();
        alone.insert(alone.end(), rest.begin(), rest.end());
    }
    return alone;
}

void PlanarLight::light(std::vector<SurfaceReceiver>& receivers, const GatherReceivers& gather) {
    const std::vector<std::uint32_t> alone = interpolate(receivers, gather);
    std::vector<SurfaceReceiver> at;
    at.reserve(alone.size());
    for (const std::uint32_t r : alone)
        at.push_back(receivers[r]);
    gather(at);
    for (std::size_t k = 0; k < alone.size(); ++k)
        receivers[alone[k]] = at[k];
}

}  // namespace brisance
