// Camera rays of pixels.
#include <gtest/gtest.h>

#include "camera/camera.h"
#include "core/error.h"
#include "fixtures/media.h"

namespace brisance {
namespace {

Medium any_medium(const dvec3& origin = dvec3(0.0)) {
    testing::Recipe r;
    r.box = testing::cube(0, 15);
    r.world_from_index = testing::cubic(0.1, origin);
    r.density = [](const ivec3&) { return 1.0f; };
    return testing::make_medium(r);
}

CameraSettings plain() {
    CameraSettings s;
    s.eye = {1.0, -5.0, 2.0};
    s.target = {1.0, 0.0, 2.0};
    s.vertical_fov_degrees = 90.0;
    s.width = 200;
    s.height = 100;
    return s;
}

TEST(Camera, TheMiddleOfThePictureIsTheTargetAndUpIsUp) {
    const Medium medium = any_medium();
    const Camera camera(plain(), medium);
    EXPECT_LT(glm::length(camera.ray(100.0, 50.0).direction - dvec3(0.0, 1.0, 0.0)), 1e-12);
    EXPECT_GT(camera.ray(100.0, 0.0).direction.z, 0.0);
    EXPECT_GT(camera.ray(200.0, 50.0).direction.x, 0.0);
    EXPECT_LT(glm::length(camera.ray(0, 0).direction) - 1.0, 1e-12);
}

TEST(Camera, TheFieldOfViewSpansThePicturesHeight) {
    const Medium medium = any_medium();
    const Camera camera(plain(), medium);
    const dvec3 top = camera.ray(100.0, 0.0).direction, bottom = camera.ray(100.0, 100.0).direction;
    EXPECT_NEAR(glm::dot(top, bottom), 0.0, 1e-12);  // 90 degrees
    EXPECT_NEAR(camera.pixel_angle() * 100.0, 2.0, 1e-12);
}

TEST(Camera, AMatrixSaysTheSameAsEyeAndTarget) {
    const Medium medium = any_medium();
    const Camera look(plain(), medium);
    CameraSettings s = plain();
    s.world_from_camera = glm::inverse(look.camera_from_world());
    s.eye = s.target = dvec3(9.0);  // overridden
    const Camera matrix(s, medium);
    for (const double x : {0.0, 33.0, 200.0}) {
        EXPECT_LT(glm::length(look.ray(x, 20.0).direction - matrix.ray(x, 20.0).direction), 1e-12);
        EXPECT_LT(glm::length(look.ray(x, 20.0).origin - matrix.ray(x, 20.0).origin), 1e-12);
    }
}

TEST(Camera, FarFromTheOriginRaysAreTheSame) {
    const dvec3 far(1e6, -1e6, 1e6);
    CameraSettings s = plain();
    const Medium here = any_medium(), there = any_medium(far);
    const Camera near(s, here);
    s.eye += far;
    s.target += far;
    const Camera away(s, there);
    const Ray a = near.ray(17.0, 31.0), b = away.ray(17.0, 31.0);
    EXPECT_LT(glm::length(a.direction - b.direction), 1e-8);
    const dvec3 world_a = here.world_of_local(vec3(a.origin)), world_b = there.world_of_local(vec3(b.origin)) - far;
    EXPECT_LT(glm::length(world_a - world_b), 1e-4);
}

TEST(Camera, ImpossibleCamerasAreErrorsThatSayWhy) {
    const Medium medium = any_medium();
    const auto message = [&](const CameraSettings& s) -> std::string {
        try {
            const Camera camera(s, medium);
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), ExitCode::Usage);
            return e.what();
        }
        return "accepted";
    };
    CameraSettings s = plain();
    s.target = s.eye;
    EXPECT_NE(message(s).find("coincide"), std::string::npos);
    s = plain();
    s.up = {0.0, 2.0, 0.0};
    EXPECT_NE(message(s).find("parallel"), std::string::npos);
    s = plain();
    s.world_from_camera = dmat4(0.0);
    EXPECT_NE(message(s).find("singular"), std::string::npos);
}

TEST(Camera, FramingSeesAllOfTheSmoke) {
    for (const auto& [width, height] : {std::pair{1280, 720}, std::pair{300, 900}}) {
        const Medium medium = any_medium({5.0, 6.0, 7.0});
        CameraSettings like;
        like.width = width;
        like.height = height;
        const CameraSettings framed = framed_camera(medium, like);
        const Camera camera(framed, medium);
        for (int k = 0; k < 8; ++k) {
            const dvec3 corner = dvec3(5.0, 6.0, 7.0) + 1.5 * dvec3(k & 1, k >> 1 & 1, k >> 2 & 1);
            const glm::dvec4 p = camera.camera_from_world() * glm::dvec4(corner, 1.0);
            const double half = std::tan(0.5 * framed.vertical_fov_degrees * 3.14159265358979 / 180.0);
            EXPECT_LT(p.z, 0.0);
            EXPECT_LT(std::abs(p.y / p.z), half);
            EXPECT_LT(std::abs(p.x / p.z), half * width / height);
        }
    }
}

}  // namespace
}  // namespace brisance
