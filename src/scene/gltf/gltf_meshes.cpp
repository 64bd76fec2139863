#include "scene/gltf/gltf_meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/gltf/gltf_accessor.h"
#include "scene/gltf/gltf_morph.h"
#include "scene/gltf/gltf_skins.h"

namespace brisance {
namespace {

using glm::uvec3;

bool finite(const vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Twice the area, along the normal.
dvec3 cross_of(const SceneMesh& mesh, const uvec3& t) {
    const dvec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
    return glm::cross(b - a, c - a);
}

// One primitive of one node.
struct Job {
    const PlacedNode& placed;
    const tinygltf::Node& node;
    const tinygltf::Primitive& primitive;
    int position = -1;  // accessor
    std::string name;   // "mesh 3 (Floor), primitive 0"
};

int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
    const auto found = primitive.attributes.find(name);
    return found != primitive.attributes.end() ? found->second : -1;
}

std::size_t triangle_count(int mode, std::size_t corners) {
    if (mode == TINYGLTF_MODE_TRIANGLES)
        return corners / 3;
    return corners < 3 ? 0 : corners - 2;
}

uvec3 triangle_at(int mode, std::uint32_t i) {
    if (mode == TINYGLTF_MODE_TRIANGLES)
        return {3 * i, 3 * i + 1, 3 * i + 2};
    if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
        return {i + 1, i + 2, 0};
    return {i, i + 1 + i % 2, i + 2 - i % 2};
}

// Drops vertices that no triangle uses.
void compact(SceneMesh& mesh) {
    constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> new_index(mesh.positions.size(), kUnused);
    SceneMesh kept;
    for (uvec3& t : mesh.triangles)
        for (int c = 0; c < 3; ++c) {
            const std::uint32_t old = t[c];
            if (new_index[old] == kUnused) {
                new_index[old] = static_cast<std::uint32_t>(kept.positions.size());
                kept.positions.push_back(mesh.positions[old]);
                if (!mesh.normals.empty())
                    kept.normals.push_back(mesh.normals[old]);
                if (!mesh.uv.empty())
                    kept.uv.push_back(mesh.uv[old]);
            }
            t[c] = new_index[old];
        }
    mesh.positions = std::move(kept.positions);
    mesh.normals = std::move(kept.normals);
    mesh.uv = std::move(kept.uv);
}

// Where a file's normal has no direction, the mean of the triangles around it stands in.
void repair_normals(SceneMesh& mesh, const std::string& where, Progress& progress) {
    const auto broken = [](const vec3& n) { return n == vec3(0.0f); };
    const auto count = std::count_if(mesh.normals.begin(), mesh.normals.end(), broken);
    if (count == 0)
        return;
    progress.warning("normals",
                     fmt::format("{}: {} normals without direction, those of the triangles are used", where, count));
    std::vector<dvec3> sums(mesh.normals.size(), dvec3(0.0));
    for (const uvec3& t : mesh.triangles)
        for (int c = 0; c < 3; ++c)
            sums[t[c]] += cross_of(mesh, t);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double length = glm::length(sums[i]);
        if (broken(mesh.normals[i]))
            mesh.normals[i] = length > 0.0 ? vec3(sums[i] / length) : vec3(0.0f, 0.0f, 1.0f);
    }
}

class MeshReader {
public:
    MeshReader(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene, MemoryBudget& budget,
               Progress& progress, const Scene* same_pictures)
        : file_(file),
          nodes_(nodes),
          scene_(scene),
          budget_(budget),
          progress_(progress),
          materials_(file, scene, budget, progress, same_pictures),
          skins_(file, nodes, scene.origin, budget) {}

    void read() {
        std::vector<Job> jobs;
        for (const PlacedNode& placed : nodes_)
            add_jobs(placed, jobs);
        claim_memory(jobs);
        for (const Job& job : jobs)
            read_primitive(job);
        left_out_.warn(file_.path.string(), progress_);
    }

private:
    void claim_memory(const std::vector<Job>& jobs) {
        double triangles = 0.0, vertices = 0.0, passing = 0.0;  // passing: what moving one primitive takes for a while
        for (const Job& job : jobs) {
            const auto n = static_cast<double>(element_count(file_, job.position, job.name + ": positions"));
            triangles += static_cast<double>(triangle_count(job.primitive.mode, corner_count(job)));
            vertices += n;
            if (!job.primitive.targets.empty())
                passing = std::max(passing, n * kMorphBytes);
            if (job.node.skin >= 0)
                passing = std::max(passing, n * skin_bytes(skin_set_count(file_, job.primitive, job.name)));
        }
        budget_.claim(file_.path.string(), bytes_with_tree(triangles, vertices) + passing, triangles);
    }

    // The primitives of a node that are triangles.
    void add_jobs(const PlacedNode& placed, std::vector<Job>& jobs) const {
        const tinygltf::Node& node = file_.model.nodes[static_cast<std::size_t>(placed.node)];
        if (node.mesh < 0)
            return;
        const tinygltf::Mesh& mesh = checked(file_, file_.model.meshes, node.mesh, "mesh");
        for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
            const tinygltf::Primitive& primitive = mesh.primitives[i];
            const std::string name = fmt::format("{}, primitive {}", label("mesh", node.mesh, mesh.name), i);
            const int position = attribute(primitive, "POSITION");
            if (primitive.mode >= TINYGLTF_MODE_POINTS && primitive.mode <= TINYGLTF_MODE_LINE_STRIP)
                progress_.notice(file_.path.string() + ": points and lines are left out");
            else if (primitive.mode < 0 || primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)
                file_.reject(fmt::format("{} has mode {}, which glTF does not know", name, primitive.mode));
            else if (position < 0)
                progress_.warning("no-positions",
                                  fmt::format("{}: {} has no positions, it is left out", file_.path.string(), name));
            else
                jobs.push_back({placed, node, primitive, position, name});
        }
    }

    std::size_t corner_count(const Job& job) const {
        return job.primitive.indices >= 0 ? element_count(file_, job.primitive.indices, job.name + ": indices")
                                          : element_count(file_, job.position, job.name + ": positions");
    }

    void read_primitive(const Job& job) {
        SceneMesh mesh;
        mesh.name = job.node.name.empty() ? job.name : job.node.name;
        mesh.positions = read_vectors<vec3>(file_, job.position, job.name + ": positions");
        if (mesh.positions.size() >= std::numeric_limits<std::uint32_t>::max())
            file_.reject(job.name + " has more vertices than can be counted with 32 bits");
        mesh.triangles = read_triangles(job, mesh.positions.size());
        if (const int normal = attribute(job.primitive, "NORMAL"); normal >= 0)
            mesh.normals = read_matching<vec3>(job, normal, "normals", mesh.positions.size());
        mesh.material = materials_.scene_material(job.primitive.material);
        mesh.uv = read_uv(job, mesh);
        place(job, mesh);
        leave_out_unusable(mesh, left_out_);
        if (mesh.triangles.empty()) {
            progress_.warning("empty-mesh", fmt::format("{}: nothing can be seen of {}, it is left out",
                                                        file_.path.string(), job.name));
            return;
        }
        repair_normals(mesh, file_.path.string() + ": " + job.name, progress_);
        if (attribute(job.primitive, "COLOR_0") >= 0)
            progress_.notice(file_.path.string() + ": colours of vertices are left out");
        scene_.meshes.push_back(std::move(mesh));
    }

    std::vector<uvec3> read_triangles(const Job& job, std::size_t vertices) const {
        const int mode = job.primitive.mode;
        const std::size_t corners = corner_count(job);
        if (mode == TINYGLTF_MODE_TRIANGLES && corners % 3 != 0)
            progress_.warning("odd-corners", fmt::format("{}: {} has {} corners, which is not three for each triangle; "
                                                         "the last are left out",
                                                         file_.path.string(), job.name, corners));
        if (corners >= std::numeric_limits<std::uint32_t>::max())
            file_.reject(job.name + " has more corners than can be counted with 32 bits");
        std::vector<uvec3> triangles(triangle_count(mode, corners));
        for (std::size_t i = 0; i < triangles.size(); ++i)
            triangles[i] = triangle_at(mode, static_cast<std::uint32_t>(i));
        if (job.primitive.indices < 0)
            return triangles;
        const std::vector<std::uint32_t> indices = read_indices(file_, job.primitive.indices, job.name + ": indices");
        const auto largest = std::max_element(indices.begin(), indices.end());
        if (largest != indices.end() && *largest >= vertices)
            file_.reject(fmt::format("{} has an index of {}, and {} vertices", job.name, *largest, vertices));
        for (uvec3& t : triangles)
            t = {indices[t.x], indices[t.y], indices[t.z]};
        return triangles;
    }

    template <class Vector>
    std::vector<Vector> read_matching(const Job& job, int accessor, const char* what, std::size_t count) const {
        if (element_count(file_, accessor, job.name + ": " + what) != count)
            file_.reject(fmt::format("{} has not as many {} as positions", job.name, what));
        return read_vectors<Vector>(file_, accessor, job.name + ": " + what);
    }

    std::vector<vec2> read_uv(const Job& job, const SceneMesh& mesh) const {
        const int set = materials_.uv_set(mesh.material);
        if (set < 0)
            return {};
        const int accessor = attribute(job.primitive, fmt::format("TEXCOORD_{}", set));
        if (accessor >= 0)
            return read_matching<vec2>(job, accessor, "texture coordinates", mesh.positions.size());
        progress_.warning("no-uv", fmt::format("{}: {} has no TEXCOORD_{}, its textures are left out",
                                               file_.path.string(), job.name, set));
        return {};
    }

    // From the mesh's own space to local space: morph targets first, then the skin or else the node.
    void place(const Job& job, SceneMesh& mesh) {
        if (!job.primitive.targets.empty()) {
            morph(file_, job.primitive, morph_weights(file_, job.placed), job.name, mesh, progress_);
            scene_.animated = scene_.animated || job.placed.morphs;
        }
        if (job.node.skin >= 0) {
            const Skin& skin = skins_.skin(job.node.skin);
            pose_by_skin(file_, job.primitive, skin, job.name, mesh, progress_);
            scene_.animated = scene_.animated || skin.moves;
        } else {
            transform(Affine::local(job.placed.world_from_node, scene_.origin), mesh);
            scene_.animated = scene_.animated || job.placed.moves;
        }
    }

    static void transform(const Affine& local_from_node, SceneMesh& mesh) {
        for (vec3& p : mesh.positions)
            p = local_from_node.position(p);
        if (local_from_node.mirrors())
            for (uvec3& t : mesh.triangles)
                std::swap(t.y, t.z);
        const NormalMap map(local_from_node);
        for (vec3& n : mesh.normals)
            n = map.normal(n);
    }

    const GltfFile& file_;
    const std::vector<PlacedNode>& nodes_;
    Scene& scene_;
    MemoryBudget& budget_;
    Progress& progress_;
    GltfMaterials materials_;
    GltfSkins skins_;
    LeftOut left_out_;
};

}  // namespace

void LeftOut::warn(const std::string& where, Progress& progress) const {
    if (without_area > 0)
        progress.warning("no-area", fmt::format("{}: {} triangles without area are left out", where, without_area));
    if (not_finite > 0)
        progress.warning("not-finite", fmt::format("{}: {} triangles with positions that are NaN or infinite are left "
                                                   "out",
                                                   where, not_finite));
}

void leave_out_unusable(SceneMesh& mesh, LeftOut& left_out) {
    const auto unusable = [&](const uvec3& t) {
        if (!finite(mesh.positions[t.x]) || !finite(mesh.positions[t.y]) || !finite(mesh.positions[t.z]))
            return ++left_out.not_finite > 0;
        const dvec3 cross = cross_of(mesh, t);
        return !(glm::dot(cross, cross) >= std::numeric_limits<float>::min()) && ++left_out.without_area > 0;
    };
    std::erase_if(mesh.triangles, unusable);
    if (!std::all_of(mesh.positions.begin(), mesh.positions.end(), finite))
        compact(mesh);
}

double bytes_with_tree(double triangles, double vertices) {
    constexpr double kTree = 150.0;  // Embree's, measured per triangle
    return triangles * (sizeof(uvec3) + kTree) + vertices * (2 * sizeof(vec3) + sizeof(vec2));
}

void read_meshes(const GltfFile& file, const std::vector<PlacedNode>& nodes, Scene& scene, MemoryBudget& budget,
                 Progress& progress, const Scene* same_pictures) {
    MeshReader(file, nodes, scene, budget, progress, same_pictures).read();
}

}  // namespace brisance
