// Light gathered at the resolution that the picture needs: as good as asked for, for fewer nodes, wherever it is seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "core/parallel.h"
#include "fixtures/media.h"
#include "layer_difference.h"
#include "render/render_frame.h"
#include "small_view.h"

namespace brisance {
namespace {

using namespace testing;

// Ragged smoke of 32 nodes across that burns to one side; `shift`: of the whole volume, in nodes; `border`: of empty
// nodes around it.
Medium burst(float extinction, const ivec3& shift = ivec3(0), int border = 0) {
    Recipe r;
    r.box = {ivec3(-16 - border) + shift, ivec3(16 + border) + shift};
    r.world_from_index = cubic(0.075);
    r.density = [shift](const ivec3& n) {
        return ball(n - shift, dvec3(0.0), 15.0) * (0.4f + noise((n - shift) >> 2, 1));
    };
    r.flame = [shift](const ivec3& n) {
        return ball(n - shift, dvec3(3.0, -4.0, 0.0), 6.0) * noise((n - shift) >> 1, 2);
    };
    r.settings.smoke.extinction_per_metre = extinction;
    r.settings.smoke.albedo = Rgb(0.7f);
    r.settings.fire.convention = EmissionConvention::Direct;
    return make_medium(r);
}

Shot shot_of(float error, int size = 32) {
    Shot shot = small_view(size);
    shot.lighting.interpolation = error;
    return shot;
}

RenderedFrame picture(const Medium& medium, const Shot& shot) {
    Progress silent;
    return render_medium(shot, medium, silent);
}

// Nodes gathered at each level, for the fire's light.
std::map<int, std::size_t> lit_nodes(const RenderedFrame& frame) {
    std::map<int, std::size_t> out;
    for (const StageCost& stage : frame.statistics.stages)
        if (stage.name == "light from the fire (MV)")
            for (const auto& row : stage.detail.at("lit_nodes"))
                out[row.at("level").get<int>()] = row.at("nodes").get<std::size_t>();
    return out;
}

// What the error bounds is the light in smoke; interpolation errors of single nodes vary by a factor of two.
TEST(AdaptiveGather, IsAsNearToTheFullLightingAsItIsAskedToBe) {
    const Medium medium = burst(3.0f);
    const RenderedFrame full = picture(medium, shot_of(0.0f));
    ASSERT_EQ(lit_nodes(full).size(), 1u) << "without an error every node is lit by itself";
    std::size_t before = lit_nodes(full).at(0);
    EXPECT_GT(before, std::size_t{10000});
    for (const float error : {0.005f, 0.02f, 0.08f}) {
        const RenderedFrame frame = picture(medium, shot_of(error));
        const std::size_t nodes = lit_nodes(frame).at(0);
        std::printf("error %.3f: picture %.4f, MV %.4f, MM %.4f, %zu nodes\n", error,
                    layer_difference(frame.image, full.image), layer_difference(frame.image, full.image, "MV"),
                    layer_difference(frame.image, full.image, "MM"), nodes);
        for (const char* layer : {"", "MV", "MM"})
            EXPECT_LT(layer_difference(frame.image, full.image, layer), 2.0 * error) << layer;
        EXPECT_LT(nodes, before);
        before = nodes;
    }
}

// Behind opaque smoke nothing is seen.
TEST(AdaptiveGather, HiddenSmokeStaysCoarse) {
    const Medium medium = burst(200.0f);
    const auto nodes = lit_nodes(picture(medium, shot_of(0.02f)));
    EXPECT_LT(nodes.at(0), lit_nodes(picture(medium, shot_of(0.0f))).at(0) / 2);
}

TEST(AdaptiveGather, ConservesEnergy) {
    for (const StageCost& stage : picture(burst(6.0f), shot_of(0.05f)).statistics.stages)
        if (stage.detail.contains("balance")) {
            for (const auto& row : stage.detail["balance"])
                EXPECT_NEAR(row["sum"].get<double>(), 1.0, 0.01 + 4.0 * row["escape_standard_error"].get<double>())
                    << stage.name;
        }
}

TEST(AdaptiveGather, IsTheSameOnAnyNumberOfThreads) {
    const Medium medium = burst(3.0f);
    const auto pixels = [&](int threads) {
        const ThreadLimit limit(threads);
        return picture(medium, shot_of(0.02f, 16)).image.layer("").pixels;
    };
    EXPECT_EQ(pixels(1), pixels(2));
}

// Moved by whole nodes that are no multiple of the coarse lattices': only what is interpolated where changes.
RenderedFrame moved_picture() {
    const ivec3 shift(3, -1, 2);
    Shot moved = shot_of(0.02f);
    for (dvec3* p : {&moved.camera.eye, &moved.camera.target})
        *p += 0.075 * dvec3(shift);
    return picture(burst(3.0f, shift), moved);
}

RenderedFrame turned_picture() {
    const auto turned = [](const dvec3& p) { return dvec3(-p.y, p.x, p.z); };
    Recipe r;
    r.box = cube(-16, 16);
    r.world_from_index = cubic(0.075);
    const auto upright = [](const ivec3& n) { return ivec3(n.y, -n.x, n.z); };
    r.density = [=](const ivec3& n) { return ball(upright(n), dvec3(0.0), 15.0) * (0.4f + noise(upright(n) >> 2, 1)); };
    r.flame = [=](const ivec3& n) { return ball(upright(n), dvec3(3.0, -4.0, 0.0), 6.0) * noise(upright(n) >> 1, 2); };
    r.settings.smoke.extinction_per_metre = 3.0f;
    r.settings.smoke.albedo = Rgb(0.7f);
    r.settings.fire.convention = EmissionConvention::Direct;
    Shot shot = shot_of(0.02f);
    shot.camera.eye = turned(shot.camera.eye);
    return picture(make_medium(r), shot);
}

// One test, so that the picture that all others are compared with is lit once.
TEST(AdaptiveGather, DependsOnTheViewAndNotOnThePlace) {
    const Medium medium = burst(3.0f);
    const RenderedFrame frame = picture(medium, shot_of(0.02f));
    // What surrounds the smoke without absorbing or scattering does not change how it is lit.
    const RenderedFrame padded = picture(burst(3.0f, ivec3(0), 21), shot_of(0.02f)), moved = moved_picture(),
                        turned = turned_picture();
    for (const char* layer : {"", "MV", "MM"}) {
        EXPECT_LT(layer_difference(padded.image, frame.image, layer), 0.02)
            << "empty voxels around the volume, " << layer;
        EXPECT_LT(layer_difference(turned.image, frame.image, layer), 0.02) << "turned with its volume, " << layer;
    }
    EXPECT_LT(layer_difference(moved.image, frame.image), 0.02) << "moved with its volume";
    // Smoke smaller than a pixel stays coarse: a picture of 4 x 4 pixels needs three quarters of the nodes of one of
    // 32 x 32 at most.
    EXPECT_LT(4 * lit_nodes(picture(medium, shot_of(0.02f, 4))).at(0), 3 * lit_nodes(frame).at(0));
}

// Smooth smoke that burns to one side, the same in space at any spacing of its nodes [m] and any offset of them.
Medium smooth_burst(double spacing, const dvec3& offset = dvec3(0.0)) {
    const auto at = [=](const ivec3& n) { return spacing * (dvec3(n) + offset); };
    const auto bell = [](const dvec3& p, double width) {
        const double s = glm::length(p) / width;
        return s < 1.0 ? float(std::pow(1.0 - s * s, 2)) : 0.0f;
    };
    Recipe r;
    const int half = int(std::ceil(1.25 / spacing)) + 1;
    r.box = cube(-half, half);
    r.world_from_index = cubic(spacing);
    r.world_from_index[3] = glm::dvec4(spacing * offset, 1.0);
    r.density = [=](const ivec3& n) {
        const dvec3 p = at(n);
        return bell(p, 1.2) * float(1.0 + 0.5 * std::sin(5.0 * p.x) * std::sin(4.0 * p.y) * std::sin(6.0 * p.z));
    };
    r.flame = [=](const ivec3& n) { return bell(at(n) - dvec3(0.25, -0.3, 0.0), 0.6); };
    r.settings.smoke.extinction_per_metre = 6.0f;
    r.settings.smoke.albedo = Rgb(0.7f);
    r.settings.fire.convention = EmissionConvention::Direct;
    return make_medium(r);
}

// The picture is that of the smoke and not of its voxels: it stays within the error that shadows may add, 2 %.
TEST(AdaptiveGather, TheSameSmokeInOtherVoxelsLooksTheSame) {
    const Shot shot = shot_of(-1.0f);  // auto
    const RenderedFrame frame = picture(smooth_burst(0.075), shot), finer = picture(smooth_burst(0.0375), shot),
                        moved = picture(smooth_burst(0.075, {0.4, 0.3, -0.2}), shot);
    for (const char* layer : {"", "MV", "MM"}) {
        std::printf("%s voxels half as wide: %.4f, moved by a part of a voxel: %.4f\n", layer,
                    layer_difference(finer.image, frame.image, layer),
                    layer_difference(moved.image, frame.image, layer));
        EXPECT_LT(layer_difference(finer.image, frame.image, layer), 0.02) << layer;
        EXPECT_LT(layer_difference(moved.image, frame.image, layer), 0.02) << layer;
    }
}

}  // namespace
}  // namespace brisance
