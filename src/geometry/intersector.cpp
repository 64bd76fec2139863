#include "geometry/intersector.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <atomic>
#include <cmath>
#include <cstring>
#include <vector>

#include "core/error.h"
#include "core/rng.h"
#include "geometry/surface_point.h"

namespace brisance {

namespace {

// What a filter needs to look a hit's alpha up.
struct Cutout {
    const Scene* scene;
    std::uint32_t mesh;
};

// A number in [0, 1) that stays with the ray and the triangle, so that nobody has to carry random numbers to here.
float number_of(const float* origin, const float* direction, std::uint32_t mesh, std::uint32_t triangle) {
    std::uint32_t bits[6];
    std::memcpy(bits, origin, 3 * sizeof(float));
    std::memcpy(bits + 3, direction, 3 * sizeof(float));
    const auto pair = [&](int i) { return std::uint64_t(bits[i]) << 32 | bits[i + 1]; };
    Rng rng(Stream::Cutout, pair(0) ^ (pair(2) * 0x9e3779b97f4a7c15), pair(4) ^ (std::uint64_t(mesh) << 32 | triangle));
    return rng.next();
}

bool lets_through(const Cutout& cutout, const SurfaceHit& hit, const float* origin, const float* direction) {
    const SceneMesh& mesh = cutout.scene->meshes[cutout.mesh];
    const SceneMaterial& material = cutout.scene->materials[mesh.material];
    const float alpha = alpha_at(*cutout.scene, hit);
    if (material.alpha_mode == AlphaMode::Mask)
        return alpha < material.alpha_cutoff;
    return number_of(origin, direction, hit.mesh, hit.triangle) >= alpha;
}

void filter(const RTCFilterFunctionNArguments* a) {
    const auto& cutout = *static_cast<const Cutout*>(a->geometryUserPtr);
    for (unsigned i = 0; i < a->N; ++i) {
        if (a->valid[i] == 0)
            continue;
        const SurfaceHit hit{0.0, cutout.mesh, RTCHitN_primID(a->hit, a->N, i),
                             vec2(RTCHitN_u(a->hit, a->N, i), RTCHitN_v(a->hit, a->N, i))};
        const float origin[3] = {RTCRayN_org_x(a->ray, a->N, i), RTCRayN_org_y(a->ray, a->N, i),
                                 RTCRayN_org_z(a->ray, a->N, i)};
        const float direction[3] = {RTCRayN_dir_x(a->ray, a->N, i), RTCRayN_dir_y(a->ray, a->N, i),
                                    RTCRayN_dir_z(a->ray, a->N, i)};
        if (lets_through(cutout, hit, origin, direction))
            a->valid[i] = 0;
    }
}

void fill_ray(const Ray& ray, double end, RTCRay& out) {
    out.org_x = float(ray.origin.x), out.org_y = float(ray.origin.y), out.org_z = float(ray.origin.z);
    out.dir_x = float(ray.direction.x), out.dir_y = float(ray.direction.y), out.dir_z = float(ray.direction.z);
    out.tnear = 0.0f;
    out.tfar = float(end);
    out.time = 0.0f;
    out.mask = ~0u;
    out.id = 0;
    out.flags = 0;
}

struct Nearby {
    const Scene* scene;
    bool found = false;
};

// Tests the plane of triangles whose box is near enough.
bool look_nearby(RTCPointQueryFunctionArguments* a) {
    Nearby& nearby = *static_cast<Nearby*>(a->userPtr);
    const Triangle t = triangle_of(*nearby.scene, a->geomID, a->primID);
    const dvec3 normal = t.normal(), offset = dvec3(a->query->x, a->query->y, a->query->z) - t.a;
    const double radius = a->query->radius;
    if (std::abs(glm::dot(normal, offset)) > radius * glm::length(normal))
        return false;
    nearby.found = true;
    a->query->radius = 0.0f;  // no need to look any further
    return true;
}

}  // namespace

struct Intersector::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<Cutout> cutouts;  // per mesh: filters point here
    std::atomic<std::int64_t> bytes{0};

    ~Embree() {
        if (scene)
            rtcReleaseScene(scene);
        if (device)
            rtcReleaseDevice(device);
    }

    void check() const {
        const RTCError error = rtcGetDeviceError(device);
        if (error == RTC_ERROR_OUT_OF_MEMORY)
            throw Error(ExitCode::Temporary, "out of memory for the surfaces' hierarchy; use coarser meshes");
        if (error != RTC_ERROR_NONE)
            throw Error(ExitCode::RenderFailed, "Embree failed, error " + std::to_string(int(error)));
    }

    void add(const SceneMesh& mesh, bool cut, std::uint32_t id) {
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        // Embree reads past the last vertex of a buffer: it keeps a copy that allows for that.
        void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3),
                                                 mesh.positions.size());
        if (vertices)
            std::memcpy(vertices, mesh.positions.data(), mesh.positions.size() * sizeof(vec3));
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles.data(), 0,
                                   sizeof(glm::uvec3), mesh.triangles.size());
        if (cut) {
            rtcSetGeometryUserData(geometry, &cutouts[id]);
            rtcSetGeometryIntersectFilterFunction(geometry, filter);
            rtcSetGeometryOccludedFilterFunction(geometry, filter);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene, geometry, id);
        rtcReleaseGeometry(geometry);
        check();
    }

    static bool count(void* user, ssize_t bytes, bool) {
        static_cast<Embree*>(user)->bytes += bytes;
        return true;
    }
};

Intersector::Intersector(const Scene& scene) : scene_(scene) {
    if (scene.triangle_count() == 0)
        return;
    embree_ = std::make_unique<Embree>();
    Embree& e = *embree_;
    e.device = rtcNewDevice(nullptr);
    if (!e.device)
        throw Error(ExitCode::RenderFailed, "Embree cannot start on this processor");
    rtcSetDeviceMemoryMonitorFunction(e.device, Embree::count, &e);
    e.scene = rtcNewScene(e.device);
    rtcSetSceneFlags(e.scene, RTC_SCENE_FLAG_ROBUST);
    e.cutouts.resize(scene.meshes.size());
    for (std::uint32_t m = 0; m < scene.meshes.size(); ++m) {
        e.cutouts[m] = {&scene, m};
        const SceneMesh& mesh = scene.meshes[m];
        if (!mesh.triangles.empty())
            e.add(mesh, scene.materials[mesh.material].alpha_mode != AlphaMode::Opaque, m);
    }
    rtcCommitScene(e.scene);
    e.check();
}

Intersector::~Intersector() = default;

bool Intersector::empty() const {
    return !embree_;
}

std::uint64_t Intersector::bytes() const {
    return embree_ ? static_cast<std::uint64_t>(embree_->bytes.load()) : 0;
}

bool Intersector::any_within(const dvec3& position, double radius) const {
    if (!embree_)
        return false;
    // The query is in single precision, as the triangles are, so its radius is a little larger.
    RTCPointQuery query{float(position.x), float(position.y), float(position.z), 0.0f, float(radius * 1.0001)};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    Nearby nearby{&scene_};
    rtcPointQuery(embree_->scene, &query, &context, look_nearby, &nearby);
    return nearby.found;
}

std::optional<SurfaceHit> Intersector::first_hit(const Ray& ray, double end) const {
    if (!embree_)
        return std::nullopt;
    RTCRayHit query{};
    fill_ray(ray, end, query.ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
#if RTC_VERSION_MAJOR >= 4
    rtcIntersect1(embree_->scene, &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(embree_->scene, &context, &query);
#endif
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return std::nullopt;
    return SurfaceHit{query.ray.tfar, query.hit.geomID, query.hit.primID, vec2(query.hit.u, query.hit.v)};
}

bool Intersector::occluded(const Ray& ray, double end) const {
    if (!embree_)
        return false;
    RTCRay query{};
    fill_ray(ray, end, query);
#if RTC_VERSION_MAJOR >= 4
    rtcOccluded1(embree_->scene, &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(embree_->scene, &context, &query);
#endif
    return query.tfar < 0.0f;
}

}  // namespace brisance
