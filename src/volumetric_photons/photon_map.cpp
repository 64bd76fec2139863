#include "volumetric_photons/photon_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nanoflann.hpp>
#include <numbers>

#include "transport/particle_walk.h"

namespace brisance {

namespace {

// Least cosine between the normals of the point and of a photon.
constexpr float kSameFacing = 0.7f;
// Largest distance of a photon from the tangent plane of the point, relative to its distance from the point.
constexpr float kOutOfPlane = 0.3f;
// The BSDF times cosine is divided by at least this cosine, so that light at grazing incidence is not overestimated.
constexpr float kLeastCosine = 1e-2f;

struct Points {
    const std::vector<SurfacePhoton>& photons;
    std::size_t kdtree_get_point_count() const { return photons.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return photons[i].position[int(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
        return false;
    }
};

struct Near {
    float distance2;
    std::uint32_t photon;
    // Ties in distance are broken by the lower index, so that the order of visits does not matter.
    bool operator<(const Near& other) const {
        return distance2 != other.distance2 ? distance2 < other.distance2 : photon < other.photon;
    }
};

// The nearest photons that are accepted: a nanoflann result set.
class Nearest {
public:
    using DistanceType = float;

    Nearest(std::span<const SurfacePhoton> photons, const vec3& point, const vec3& normal, std::size_t most,
            std::vector<Near>& found)
        : photons_(photons), point_(point), normal_(normal), most_(most), found_(found) {
        found_.clear();
    }
    std::size_t size() const { return found_.size(); }
    bool full() const { return found_.size() == most_; }
    // NOLINTBEGIN(readability-identifier-naming): names that nanoflann calls
    float worstDist() const { return full() ? found_.front().distance2 : std::numeric_limits<float>::max(); }
    bool addPoint(float distance2, std::uint32_t index) {
        const Near next{distance2, index};
        if ((full() && !(next < found_.front())) || !counts(photons_[index], distance2))
            return true;
        if (full()) {
            std::pop_heap(found_.begin(), found_.end());
            found_.pop_back();
        }
        found_.push_back(next);
        std::push_heap(found_.begin(), found_.end());
        return true;
    }
    // NOLINTEND(readability-identifier-naming)

private:
    bool counts(const SurfacePhoton& l, float distance2) const {
        const float above = glm::dot(l.position - point_, normal_);
        return glm::dot(l.normal, normal_) > kSameFacing && above * above <= kOutOfPlane * kOutOfPlane * distance2;
    }

    std::span<const SurfacePhoton> photons_;
    vec3 point_, normal_;
    std::size_t most_;
    std::vector<Near>& found_;
};

}  // namespace

std::optional<SurfacePhoton> landed_photon(const ParticleFlight& flight) {
    const SurfacePoint* point = flight.landing();
    if (!point)
        return std::nullopt;
    const dvec3 &normal = point->frame.normal, &direction = flight.ray().direction;
    const bool above = glm::dot(normal, direction) < 0.0;
    return SurfacePhoton{vec3(point->position), vec3(above ? normal : -normal), vec3(direction), flight.power};
}

class PhotonMap::Tree {
public:
    explicit Tree(const std::vector<SurfacePhoton>& photons) : points_{photons}, index_(3, points_) {}
    void find(Nearest& nearest, const vec3& point) const {
        index_.findNeighbors(nearest, &point.x, nanoflann::SearchParams());
    }

private:
    Points points_;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Points>, Points, 3, std::uint32_t> index_;
};

PhotonMap::PhotonMap(std::vector<SurfacePhoton> photons) : photons_(std::move(photons)) {
    if (!photons_.empty())
        tree_ = std::make_unique<Tree>(photons_);
}

PhotonMap::~PhotonMap() = default;

Rgb PhotonMap::scattered(const SurfacePoint& point, const Bsdf& bsdf, const dvec3& toward_viewer,
                         int neighbours) const {
    thread_local std::vector<Near> near;
    if (!tree_)
        return Rgb(0.0f);
    const bool above = glm::dot(point.frame.normal, toward_viewer) >= 0.0;
    const vec3 position(point.position), normal(above ? point.frame.normal : -point.frame.normal);
    // One photon more, whose distance is the radius of the disc.
    Nearest nearest(photons_, position, normal, static_cast<std::size_t>(neighbours) + 1, near);
    tree_->find(nearest, position);
    if (near.size() < 2)
        return Rgb(0.0f);
    std::sort_heap(near.begin(), near.end());
    const double area = std::numbers::pi * near.back().distance2;
    Rgb sum(0.0f);
    for (std::size_t i = 0; i + 1 < near.size(); ++i) {
        const SurfacePhoton& l = photons_[near[i].photon];
        const dvec3 toward_source(-l.direction);
        const float cosine = std::abs(glm::dot(vec3(point.frame.normal), l.direction));
        sum += bsdf.evaluate(toward_viewer, toward_source) / std::max(cosine, kLeastCosine) * l.power;
    }
    return area > 0.0 ? sum * float(1.0 / area) : Rgb(0.0f);
}

}  // namespace brisance
