#include "render/shutter/screen_movement.h"

#include <algorithm>
#include <optional>

namespace brisance {

namespace {

// Of a mesh: enough of them for its movement as a whole.
constexpr std::size_t kMostVertices = 20000;
// Rays along a side of the picture, for surfaces whose vertices are out of sight.
constexpr int kRays = 32;

// Positions of one thing at the three instants, local [m].
using Way = std::array<dvec3, 3>;

class Screen {
public:
    explicit Screen(const std::array<Instant, 3>& instants) : instants_(instants) {}

    void look(const Way& way) {
        std::array<std::optional<glm::dvec2>, 3> seen;
        bool within = false;
        for (int k = 0; k < 3; ++k) {
            seen[k] = instants_[k].camera->project(way[k]);
            if (!seen[k])
                return;
            within = within || is_within(*seen[k]);
        }
        if (within)
            longest_ = std::max(longest_, glm::distance(*seen[0], *seen[1]) + glm::distance(*seen[1], *seen[2]));
    }

    double longest() const { return longest_; }

private:
    bool is_within(const glm::dvec2& p) const {
        const CameraSettings& s = instants_[1].camera->settings();
        return p.x >= 0.0 && p.y >= 0.0 && p.x <= s.width && p.y <= s.height;
    }

    const std::array<Instant, 3>& instants_;
    double longest_ = 0.0;
};

// The fastest node of each brick.
void look_at_smoke(const Medium& medium, const std::array<Instant, 3>& instants, Screen& screen) {
    for (std::size_t b = 0; b < medium.lattice.brick_count(); ++b) {
        std::size_t fastest = b * BrickLattice::kNodes;
        float most = -1.0f;
        for (std::size_t i = fastest; i < (b + 1) * BrickLattice::kNodes; ++i) {
            const bool there =
                medium.extinction[i] > 0.0f || (!medium.emission.empty() && medium.emission[i] != Rgb(0.0f));
            const float square = medium.velocity.empty() ? 0.0f : glm::dot(medium.velocity[i], medium.velocity[i]);
            if (there && square > most) {
                most = square;
                fastest = i;
            }
        }
        if (most < 0.0f)
            continue;
        const dvec3 here(medium.local_of_node(medium.lattice.node(fastest)));
        const dvec3 velocity = medium.velocity.empty() ? dvec3(0.0) : dvec3(medium.velocity[fastest]);
        Way way;
        for (int k = 0; k < 3; ++k)
            way[k] = here + instants[k].frames * velocity;
        screen.look(way);
    }
}

void look_at_surfaces(const std::array<Instant, 3>& instants, Screen& screen) {
    const std::vector<SceneMesh>& first = instants[0].surroundings->scene().meshes;
    for (std::size_t m = 0; m < first.size(); ++m) {
        const std::size_t vertices = first[m].positions.size(), stride = vertices / kMostVertices + 1;
        for (std::size_t v = 0; v < vertices; v += stride) {
            Way way;
            for (int k = 0; k < 3; ++k)
                way[k] = dvec3(instants[k].surroundings->scene().meshes[m].positions[v]);
            screen.look(way);
        }
    }
}

// Where rays of the middle instant hit, the point of the triangle at the other instants.
void look_along_rays(const std::array<Instant, 3>& instants, Screen& screen) {
    const CameraSettings& s = instants[1].camera->settings();
    for (int y = 0; y < kRays; ++y)
        for (int x = 0; x < kRays; ++x) {
            const Ray ray = instants[1].camera->ray((x + 0.5) * s.width / kRays, (y + 0.5) * s.height / kRays);
            const std::optional<SurfaceHit> hit = instants[1].surroundings->intersector().first_hit(ray);
            if (!hit)
                continue;
            Way way;
            for (int k = 0; k < 3; ++k) {
                const SceneMesh& mesh = instants[k].surroundings->scene().meshes[hit->mesh];
                const glm::uvec3& t = mesh.triangles[hit->triangle];
                const vec2 b = hit->barycentric;
                way[k] = dvec3((1.0f - b.x - b.y) * mesh.positions[t.x] + b.x * mesh.positions[t.y] +
                               b.y * mesh.positions[t.z]);
            }
            screen.look(way);
        }
}

// What is behind everything moves as the camera turns.
void look_far_away(const std::array<Instant, 3>& instants, Screen& screen) {
    constexpr double kFar = 1e9;  // [m]
    constexpr int kPoints = 4;    // along a side of the picture
    const CameraSettings& s = instants[1].camera->settings();
    for (int y = 0; y <= kPoints; ++y)
        for (int x = 0; x <= kPoints; ++x) {
            const Ray ray = instants[1].camera->ray(double(x) * s.width / kPoints, double(y) * s.height / kPoints);
            const dvec3 there = kFar * ray.direction;
            screen.look({there, there, there});
        }
}

bool same_meshes(const std::array<Instant, 3>& instants) {
    const auto& meshes = instants[0].surroundings->scene().meshes;
    for (const Instant& instant : instants) {
        const auto& other = instant.surroundings->scene().meshes;
        if (other.size() != meshes.size())
            return false;
        for (std::size_t m = 0; m < meshes.size(); ++m)
            if (other[m].positions.size() != meshes[m].positions.size() ||
                other[m].triangles.size() != meshes[m].triangles.size())
                return false;
    }
    return true;
}

}  // namespace

double largest_movement(const Medium& medium, const std::array<Instant, 3>& instants) {
    Screen screen(instants);
    look_at_smoke(medium, instants, screen);
    if (instants[0].surroundings) {
        // Triangles without area are left out, and may be others at another moment.
        if (same_meshes(instants)) {
            look_at_surfaces(instants, screen);
            look_along_rays(instants, screen);
        }
        look_far_away(instants, screen);
    }
    return screen.longest();
}

}  // namespace brisance
