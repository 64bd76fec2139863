// Pictures with an open shutter: surfaces and cameras of glTF files move.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "render/input/carried_volume.h"
#include "render/input/load_medium.h"
#include "render/render_frame.h"
#include "volume/temp_folder.h"

namespace brisance {
namespace {

using nlohmann::json;

constexpr double kDistance = 10.0, kHalfSide = 1.0;  // [m]
constexpr double kSpeed = 1.0;                       // [m per frame]
constexpr double kTurn = 0.01;                       // about the axis of the camera [radians per frame]

// A glTF file with a square that shines with radiance 1 toward a camera, one of which moves along x, or turns.
class Square {
public:
    explicit Square(int moving_node, bool turns = false) {
        const float s = float(kHalfSide), d = float(kDistance), way = 100.0f * float(kSpeed);
        const int corners = add("VEC3", {-s, -s, 0, s, -s, 0, s, s, 0, -s, -s, 0, s, s, 0, -s, s, 0});
        const int times = add("SCALAR", {0, 100});
        const float z = moving_node == 0 ? 0.0f : d;
        const float half = 50.0f * float(kTurn);
        const int places =
            turns ? add("VEC4", {0, 0, 0, 1, 0, 0, std::sin(half), std::cos(half)}) : add("VEC3", {0, 0, z, way, 0, z});
        file_["asset"]["version"] = "2.0";
        file_["scene"] = 0;
        file_["scenes"] = json::array({{{"nodes", {0, 1}}}});
        file_["nodes"] = json::array({{{"mesh", 0}, {"name", "square"}}, {{"camera", 0}, {"translation", {0, 0, d}}}});
        file_["cameras"] = json::array({{{"type", "perspective"}, {"perspective", {{"yfov", 0.4}, {"znear", 0.1}}}}});
        file_["materials"] = json::array(
            {{{"emissiveFactor", {1, 1, 1}}, {"pbrMetallicRoughness", {{"baseColorFactor", {0, 0, 0, 1}}}}}});
        file_["meshes"] =
            json::array({{{"primitives", json::array({{{"attributes", {{"POSITION", corners}}}, {"material", 0}}})}}});
        file_["animations"] = json::array(
            {{{"samplers", json::array({{{"input", times}, {"output", places}}})},
              {"channels",
               json::array({{{"sampler", 0},
                             {"target", {{"node", moving_node}, {"path", turns ? "rotation" : "translation"}}}}})}}});
        file_["buffers"] = json::array({{{"byteLength", bytes_.size()}, {"uri", "square.bin"}}});
        write_bytes(folder_ / "square.bin", bytes_);
        write_bytes(folder_ / "square.gltf", file_.dump());
    }

    Shot shot() const {
        Shot shot;
        shot.folder = folder_.path();
        SceneFile file;
        file.file = "square.gltf";
        shot.scene.files.push_back(file);
        shot.scene.frames_per_second = 1.0;
        shot.camera.width = 80;
        shot.camera.height = 40;
        shot.shutter.most_moments = 64;
        shot.certify.belief = 0.0;
        shot.correction.samples = 0;  // by lights alone
        return shot;
    }

private:
    int add(const std::string& type, const std::vector<float>& numbers) {
        const std::size_t bytes = numbers.size() * sizeof(float);
        file_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes}});
        bytes_.append(reinterpret_cast<const char*>(numbers.data()), bytes);
        file_["accessors"].push_back({{"bufferView", file_["bufferViews"].size() - 1},
                                      {"componentType", 5126},
                                      {"count", numbers.size() / (type == "SCALAR" ? 1 : type[3] - '0')},
                                      {"type", type}});
        return static_cast<int>(file_["accessors"].size()) - 1;
    }

    TempFolder folder_;
    json file_;
    std::string bytes_;
};

// How long a point is covered by an edge-to-edge interval that moves evenly, as a part of the shutter's time.
double covered(double x, double middle, double half, double way) {
    const double from = std::max(x - half, middle - 0.5 * way), to = std::min(x + half, middle + 0.5 * way);
    return std::clamp((to - from) / way, 0.0, 1.0);
}

// The row through the middle of a picture, against the closed form. `middle`: of the square at the frame [m].
void expect_streak(const Image& image, double middle, double way) {
    const double metres_per_pixel = 2.0 * kDistance * std::tan(0.2) / image.height;
    for (int x = 0; x < image.width; ++x) {
        const double position = (x + 0.5 - 0.5 * image.width) * metres_per_pixel;
        const float seen = image.layer("").pixels[4 * std::size_t(20 * image.width + x)];
        EXPECT_NEAR(seen, covered(position, middle, kHalfSide, way), 0.06) << x;
    }
}

Image render(const Shot& shot, int frame) {
    Progress silent;
    return render_frame(shot, "", frame, silent).image;
}

TEST(AnimatedSets, AMovingSurfaceIsAStreak) {
    const Square square(0);
    Shot shot = square.shot();
    shot.shutter.length = 0.8;
    expect_streak(render(shot, 1), kSpeed, 0.8 * kSpeed);
    shot.shutter.position = ShutterPosition::Start;
    expect_streak(render(shot, 1), 1.4 * kSpeed, 0.8 * kSpeed);
}

TEST(AnimatedSets, AMovingCameraStreaksWhatRests) {
    const Square square(1);
    Shot shot = square.shot();
    shot.shutter.length = 0.8;
    expect_streak(render(shot, 1), -kSpeed, 0.8 * kSpeed);
}

TEST(AnimatedSets, PathsDrawTheSameStreak) {
    const Square square(0);
    Shot shot = square.shot();
    shot.shutter.length = 0.8;
    shot.method = RenderMethod::Path;
    shot.tracing.samples = 1024;
    expect_streak(render(shot, 1), kSpeed, 0.8 * kSpeed);
}

TEST(AnimatedSets, WithoutAShutterEdgesAreSharp) {
    const Square square(0);
    Shot shot = square.shot();
    shot.shutter.length = 0.0;
    const Image image = render(shot, 0);
    int partly = 0;
    for (int x = 0; x < image.width; ++x) {
        const float seen = image.layer("").pixels[4 * std::size_t(20 * image.width + x)];
        partly += seen > 0.01f && seen < 0.99f;
    }
    EXPECT_LE(partly, 2);
}

Shot with_carried_box(const Square& square, double shutter) {
    Shot shot = square.shot();
    FurtherVolume box;
    box.volume.box = FogBox{dvec3(-1.0, -2.0, 0.0), dvec3(1.0, 2.0, 1.0), 0.25};
    box.volume.node = "square";
    shot.volumes.push_back(box);
    shot.medium.smoke.extinction_per_metre = 1.0f;
    shot.shutter.length = shutter;
    return shot;
}

// Calls what with place [m] and velocity [m per frame] of all nodes that hold smoke.
template <class What>
void at_smoke(const Medium& medium, const What& what) {
    for (std::size_t i = 0; i < medium.lattice.node_count(); ++i)
        if (medium.extinction[i] > 0.0f) {
            const ivec3 node = medium.lattice.first_node(i / BrickLattice::kNodes) +
                               BrickLattice::node_in_brick(int(i % BrickLattice::kNodes));
            what(dvec3(medium.world_from_index * glm::dvec4(dvec3(node), 1.0)),
                 medium.velocity.empty() ? vec3(0.0f) : medium.velocity[i]);
        }
}

TEST(CarriedVolumes, AreWhereTheirNodeIsAndMoveAsItDoes) {
    const Square square(0);
    Progress silent;
    Statistics statistics;
    for (const double shutter : {0.0, 0.8}) {
        const Medium medium = load_medium(with_carried_box(square, shutter), "", 3, statistics, silent);
        double low = 1e9, high = -1e9;
        at_smoke(medium, [&](const dvec3& place, const vec3& v) {
            low = std::min(low, place.x);
            high = std::max(high, place.x);
            EXPECT_NEAR(glm::length(v - vec3(shutter > 0.0 ? float(kSpeed) : 0.0f, 0.0f, 0.0f)), 0.0f, 1e-4f);
        });
        EXPECT_NEAR(0.5 * (low + high), 3.0 * kSpeed, 1e-6);
        EXPECT_NEAR(high - low, 2.0, 0.51);  // to a voxel at either end
    }
}

TEST(CarriedVolumes, TurnWithTheirNode) {
    const Square square(0, true);
    Progress silent;
    Statistics statistics;
    int found = 0;
    const Medium medium = load_medium(with_carried_box(square, 0.5), "", 10, statistics, silent);
    at_smoke(medium, [&](const dvec3& place, const vec3& v) {
        const vec3 expected = float(kTurn) * vec3(-place.y, place.x, 0.0f);
        EXPECT_NEAR(glm::length(v - expected), 0.0f, 1e-4f);
        ++found;
    });
    EXPECT_GT(found, 100);
}

TEST(CarriedVolumes, NeedANodeThatIsThere) {
    const Square square(0);
    Shot shot = with_carried_box(square, 0.0);
    shot.volumes[0].volume.node = "cart";
    Progress silent;
    Statistics statistics;
    try {
        load_medium(shot, "", 3, statistics, silent);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::Usage);
        EXPECT_EQ(std::string(error.what()),
                  "a volume's node: no glTF file of the shot has a node \"cart\"; there are square");
    }
}

// A velocity of the file's own and that of the node add up.
TEST(CarriedVolumes, KeepTheirOwnVelocity) {
    MediumGrids grids;
    grids.density.emplace();
    grids.velocity.emplace();
    grids.velocity->channels = 3;
    grids.velocity->block_origin = {ivec3(0), ivec3(16, 0, 0)};
    grids.velocity->values.assign(2 * 3 * 512, 2.0f);
    dmat4 carried(0.0);
    carried[3] = glm::dvec4(0.5, 0.0, 0.0, 0.0);
    add_carried_velocity(carried, grids);
    EXPECT_EQ(grids.velocity->block_origin.size(), 45u);
    double sum = 0.0;
    for (const float v : grids.velocity->values)
        sum += v;
    EXPECT_NEAR(sum, 512 * (45 * 0.5 + 2 * 3 * 2.0), 1e-3);
}

}  // namespace
}  // namespace brisance
