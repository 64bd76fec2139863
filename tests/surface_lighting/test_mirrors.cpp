// Smoke and surfaces seen in mirrors, glass and glossy surfaces.
#include <gtest/gtest.h>

#include <cmath>

#include "fixtures/cell_means.h"
#include "fixtures/media.h"
#include "fixtures/sets.h"
#include "render/render_frame.h"

namespace brisance {
namespace {

using namespace testing;

SceneMaterial mirror() {
    SceneMaterial m = lambert(1.0f);
    m.surface.metallic = 1.0f;
    m.surface.roughness = 0.0f;
    return m;
}

SceneMaterial pane() {
    SceneMaterial m = lambert(1.0f);
    m.surface.specular = 1.0f;
    m.surface.transmission = 1.0f;
    m.surface.roughness = 0.0f;
    m.surface.thin = true;
    return m;
}

// A ball of fire and smoke between a mirror and a pane, over a floor: the camera sees it by way of both.
Scene hall(const Medium& medium) {
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    add_quad(scene, {-3, -2.5f, -1.3f}, {6, 0, 0}, {0, 4.5f, 0}, lambert(0.6f));
    add_quad(scene, {-3, 2, -1.3f}, {6, 0, 0}, {0, 0, 4}, mirror());
    add_quad(scene, {-3, -2.5f, -1.3f}, {0, 0, 4}, {0, 4.5f, 0}, mirror());
    add_quad(scene, {0.2f, -1.8f, -1.3f}, {0, 0, 2.5f}, {1.6f, 0.4f, 0}, pane());
    return scene;
}

Shot hall_shot(RenderMethod method) {
    Shot shot;
    shot.method = method;
    shot.camera_given = true;
    shot.camera.eye = {1.0, -6.0, 0.6};
    shot.camera.target = {0.0, 0.0, -0.3};
    shot.camera.vertical_fov_degrees = 38.0;
    shot.camera.width = 40;
    shot.camera.height = 30;
    shot.camera.samples_per_axis = 5;
    shot.tracing.samples = 400;
    shot.certify.belief = 0.0;    // nobody looks at it
    shot.correction.samples = 0;  // by lights alone
    shot.virtual_lights.count = 1500;
    shot.virtual_lights.photons = 300000;
    return shot;
}

TEST(Mirrors, EveryCellIsThePathTracers) {
    Recipe r = glowing_ball(20, 2.0f);
    r.settings.smoke.albedo = Rgb(0.8f);
    const Medium medium = make_medium(r);
    const Surroundings surroundings(hall(medium), {});
    Progress silent;
    const RenderedFrame grid = render_medium(hall_shot(RenderMethod::LightingGrid), medium, silent, &surroundings);
    const RenderedFrame paths = render_medium(hall_shot(RenderMethod::Path), medium, silent, &surroundings);
    for (const std::string& cell : grid.statistics.cells) {
        const double ours = mean_of(grid.image, cell), truth = mean_of(paths.image, cell);
        const double noise = std::abs(mean_of(paths.halves[0], cell) - mean_of(paths.halves[1], cell));
        EXPECT_NEAR(ours, truth, 0.04 * truth + 1.5 * noise) << cell;
        std::printf("%s %.5f, paths %.5f (%+.2f %%)\n", cell.c_str(), ours, truth, 100.0 * (ours / truth - 1.0));
    }
}

// A floor beside a ball of fire and smoke, and between them nothing or a sheet of what is as good as air.
Image lit_floor(const Medium& medium, bool sheet) {
    Scene scene;
    scene.origin = medium.world_of_local(vec3(0.0f));
    add_quad(scene, {-3, -3, -1.4f}, {6, 0, 0}, {0, 6, 0}, lambert(0.6f));
    if (sheet) {
        SceneMaterial air = pane();
        air.surface.ior = 1.0f;
        add_quad(scene, {-3, -3, -1.2f}, {6, 0, 0}, {0, 6, 0}, air);
    }
    const Surroundings surroundings(std::move(scene), {});
    Shot shot = hall_shot(RenderMethod::LightingGrid);
    shot.camera.eye = {0.5, -4.0, -1.3};
    shot.camera.target = {0.0, 0.0, -1.45};
    Progress silent;
    return render_medium(shot, medium, silent, &surroundings).image;
}

// Seen under the sheet, light comes by SV and SM without it, and straight through it by SS.
TEST(Panes, OfAirAreAsIfTheyWereNotThere) {
    const Medium medium = make_medium(glowing_ball(16, 2.0f));
    const Image without = lit_floor(medium, false), with = lit_floor(medium, true);
    const std::vector<float>&a = without.layer("").pixels, &b = with.layer("").pixels;
    double difference = 0.0, sum = 0.0, squares = 0.0, bias = 0.0;
    for (std::size_t i = 0; i < a.size(); i += 4) {
        sum += a[i], bias += b[i] - a[i];
        squares += double(a[i]) * a[i], difference += double(b[i] - a[i]) * (b[i] - a[i]);
    }
    EXPECT_GT(mean_of(with, "SS"), 0.9 * mean_of(without, "SV"));
    EXPECT_NEAR(bias / sum, 0.0, 0.003);
    EXPECT_LT(std::sqrt(difference / squares), 0.01);
}

}  // namespace
}  // namespace brisance
