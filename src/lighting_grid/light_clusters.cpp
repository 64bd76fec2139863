#include "lighting_grid/light_clusters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

#include "core/parallel.h"
#include "core/rng.h"
#include "medium/lattice/local_bounds.h"
#include "medium/phase.h"

namespace brisance {

namespace {

constexpr int kMostIterations = 16;

// Of the level that lamps make, so that they have shadow maps (gathering/gather.h).
constexpr int kLevelOfLamps = 1;

float square_of_distance(const vec3& a, const vec3& b) {
    const vec3 d = a - b;
    return glm::dot(d, d);
}

// That shines evenly. `extinction`: [1/m].
LightBall homogeneous_ball(double radius, double extinction) {
    const double t = radius * extinction;
    // Below, the closed form loses its digits: the first terms of its series.
    const double escape = t < 0.02 ? 1.0 - 0.75 * t + 0.4 * t * t
                                   : 0.375 / (t * t * t) * (2.0 * t * t - 1.0 + (1.0 + 2.0 * t) * std::exp(-2.0 * t));
    const double inside = t < 0.02 ? 1.0 - 8.0 / 15.0 * t : 4.0 / 3.0 * (1.0 - escape) / t;
    return {float(radius), float(inside), float(escape)};
}

// Voxels that shine, brick by brick, and their clusters. Bricks whose voxels cannot change are left out by the bounds
// of their voxels, so that the result is that of comparing all voxels with all centres.
class Clusters {
public:
    Clusters(const Medium& medium, const std::vector<Rgb>& intensity) : medium_(medium), intensity_(intensity) {
        for (std::size_t b = 0; b < medium.lattice.brick_count(); ++b) {
            Brick brick{node_.size(), node_.size(), {}};
            for (std::size_t i = b * BrickLattice::kNodes; i < (b + 1) * BrickLattice::kNodes; ++i)
                if (luminance(intensity[i]) > 0.0f)
                    add(i, brick);
            if (brick.end > brick.begin)
                bricks_.push_back(brick);
        }
    }

    // k-means++: each centre is a voxel drawn in proportion to power times the square of the distance to the centres
    // before it.
    void seed(int count) {
        Rng rng(stream_of("light_clusters/seed"), 0);
        square_.assign(node_.size(), 1.0f);
        for (std::optional<std::size_t> next = draw(rng); next; next = draw(rng)) {
            if (centre_.empty())
                square_.assign(node_.size(), std::numeric_limits<float>::max());
            centre_.push_back(position_[*next]);
            if (int(centre_.size()) == count)
                break;
            lower_squares(centre_.back());
        }
        cluster_.assign(node_.size(), 0);
    }

    // Moves centres to the centroids of the voxels nearest to them, until no voxel changes its centre.
    void settle() {
        for (int k = 0; k < kMostIterations && assign(); ++k)
            move_centres();
    }

    GridLevel lamps() const {
        std::vector<Lamp> lamps = sums();
        std::erase_if(lamps, [](const Lamp& l) { return l.weight == 0.0; });
        const float scale = 1.0f / float(1 << kLevelOfLamps);
        const auto vertex_of = [&](const Lamp& lamp) {
            const vec3 node = medium_.index_from_local * vec3(lamp.centroid()) + vec3(medium_.reference_node);
            return ivec3(glm::round(node * scale));
        };
        std::stable_sort(lamps.begin(), lamps.end(), [&](const Lamp& one, const Lamp& other) {
            const ivec3 a = vertex_of(one), b = vertex_of(other);
            return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
        });
        const double voxel = std::cbrt(3.0f * medium_.voxel_volume / (4.0f * kPi));
        GridLevel level;
        level.level = kLevelOfLamps;
        level.spacing = medium_.spacing * float(1 << kLevelOfLamps);
        for (const Lamp& lamp : lamps) {
            level.vertex.push_back(vertex_of(lamp));
            level.position.emplace_back(lamp.centroid());
            level.intensity.emplace_back(lamp.intensity);
            const double radius = std::sqrt(5.0 / 3.0 * lamp.variance() + voxel * voxel);
            level.ball.push_back(homogeneous_ball(radius, lamp.extinction / lamp.weight));
        }
        level.index_rows();
        return level;
    }

private:
    struct Brick {
        std::size_t begin, end;  // of its voxels
        LocalBounds bounds;      // of them
    };

    // Sums over a cluster's voxels. Weights are luminances.
    struct Lamp {
        double weight = 0.0;
        dvec3 intensity{0.0}, moment{0.0};
        double square = 0.0;  // of the distance to the local origin
        double extinction = 0.0;
        dvec3 centroid() const { return moment / weight; }
        double variance() const { return std::max(0.0, square / weight - glm::dot(centroid(), centroid())); }
    };

    void add(std::size_t i, Brick& brick) {
        const vec3 p = medium_.local_of_node(medium_.lattice.node(i));
        node_.push_back(static_cast<std::uint32_t>(i));
        position_.push_back(p);
        brick.bounds.low = glm::min(brick.bounds.low, p);
        brick.bounds.high = glm::max(brick.bounds.high, p);
        brick.end = node_.size();
    }

    float weight(std::size_t voxel) const { return luminance(intensity_[node_[voxel]]); }
    double density(std::size_t voxel) const { return double(weight(voxel)) * square_[voxel]; }

    // A voxel in proportion to its density; none where all of it is zero.
    std::optional<std::size_t> draw(Rng& rng) const {
        std::vector<double> passed(bricks_.size());
        parallel_for(
            bricks_.size(),
            [&](std::size_t b) {
                for (std::size_t v = bricks_[b].begin; v < bricks_[b].end; ++v)
                    passed[b] += density(v);
            },
            16);
        std::partial_sum(passed.begin(), passed.end(), passed.begin());
        if (passed.empty() || !(passed.back() > 0.0))
            return std::nullopt;
        const double goal = rng.next_double() * passed.back();
        const auto b = std::size_t(std::upper_bound(passed.begin(), passed.end() - 1, goal) - passed.begin());
        double sum = b > 0 ? passed[b - 1] : 0.0;
        std::optional<std::size_t> last;
        for (std::size_t v = bricks_[b].begin; v < bricks_[b].end; ++v) {
            if (!(density(v) > 0.0))
                continue;
            last = v;
            sum += density(v);
            if (sum > goal)
                break;
        }
        return last;
    }

    void lower_squares(const vec3& centre) {
        parallel_for(
            bricks_.size(),
            [&](std::size_t b) {
                const Brick& brick = bricks_[b];
                const float nearest = brick.bounds.distance(centre);
                const auto begin = square_.begin() + std::ptrdiff_t(brick.begin),
                           end = square_.begin() + std::ptrdiff_t(brick.end);
                if (nearest * nearest > *std::max_element(begin, end))
                    return;
                for (std::size_t v = brick.begin; v < brick.end; ++v)
                    square_[v] = std::min(square_[v], square_of_distance(position_[v], centre));
            },
            16);
    }

    // Centres that may be the nearest one of some voxel of the brick, in order.
    std::vector<std::uint32_t> candidates(const Brick& brick) const {
        float least = std::numeric_limits<float>::max();
        for (const vec3& c : centre_)
            least =
                std::min(least, glm::length(glm::max(glm::abs(brick.bounds.low - c), glm::abs(brick.bounds.high - c))));
        std::vector<std::uint32_t> out;
        for (std::uint32_t c = 0; c < centre_.size(); ++c)
            if (brick.bounds.distance(centre_[c]) <= least * 1.0001f)
                out.push_back(c);
        return out;
    }

    // Returns whether some voxel has changed its centre, or has none yet.
    bool assign() {
        std::vector<std::uint8_t> changed(bricks_.size(), !assigned_);
        assigned_ = true;
        parallel_for(bricks_.size(), [&](std::size_t b) {
            const std::vector<std::uint32_t> near = candidates(bricks_[b]);
            for (std::size_t v = bricks_[b].begin; v < bricks_[b].end; ++v) {
                std::uint32_t nearest = near.front();
                float least = std::numeric_limits<float>::max();
                for (const std::uint32_t c : near)
                    if (const float square = square_of_distance(position_[v], centre_[c]); square < least) {
                        least = square;
                        nearest = c;
                    }
                changed[b] |= cluster_[v] != nearest;
                cluster_[v] = nearest;
            }
        });
        return std::any_of(changed.begin(), changed.end(), [](std::uint8_t c) { return c != 0; });
    }

    // In voxel order, so that threads do not matter.
    std::vector<Lamp> sums() const {
        std::vector<Lamp> sums(centre_.size());
        for (std::size_t v = 0; v < node_.size(); ++v) {
            Lamp& lamp = sums[cluster_[v]];
            const dvec3 p(position_[v]);
            const double w = weight(v);
            lamp.weight += w;
            lamp.intensity += dvec3(intensity_[node_[v]]);
            lamp.moment += w * p;
            lamp.square += w * glm::dot(p, p);
            lamp.extinction += w * double(medium_.extinction[node_[v]]);
        }
        return sums;
    }

    // A centre that has lost its voxels stays where it is.
    void move_centres() {
        const std::vector<Lamp> now = sums();
        for (std::size_t c = 0; c < centre_.size(); ++c)
            if (now[c].weight > 0.0)
                centre_[c] = vec3(now[c].centroid());
    }

    const Medium& medium_;
    const std::vector<Rgb>& intensity_;
    std::vector<Brick> bricks_;
    std::vector<std::uint32_t> node_;     // per voxel that shines
    std::vector<vec3> position_;          // local [m]
    std::vector<float> square_;           // of the distance to the nearest centre so far [m^2]
    std::vector<vec3> centre_;            // local [m]
    std::vector<std::uint32_t> cluster_;  // of each voxel
    bool assigned_ = false;
};

}  // namespace

GridLevel cluster_lights(const Medium& medium, const std::vector<Rgb>& intensity, int count) {
    Clusters clusters(medium, intensity);
    clusters.seed(count);
    clusters.settle();
    return clusters.lamps();
}

}  // namespace brisance
