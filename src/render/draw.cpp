#include "render/draw.h"

#include "camera_rays/picture.h"
#include "core/available_memory.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "forecast/memory_need.h"
#include "render/many_lights.h"
#include "scattering_methods/scattering_pass.h"
#include "surface_lighting/path_lengths.h"
#include "surface_lighting/surface_shader.h"

namespace brisance {

namespace {

// Anti-aliasing samples along a pixel's side where there are surfaces: their edges are sharp.
constexpr int kSurfaceSamples = 4;

// What virtual lights cannot do is said, not left out in silence.
void check_surroundings(const Shot& shot) {
    if (shot.scattering.bounces > 1)
        throw Error(ExitCode::Usage,
                    "scattering.bounces: with a scene it may be 0, 1 or \"all\", as virtual lights hold light of all "
                    "orders; other numbers need method path");
}

PictureSettings picture_settings(const DrawInput& input, const ManyLights& lights) {
    const CameraSettings& camera = input.camera.settings();
    PictureSettings settings;
    settings.samples_per_axis = camera.samples_per_axis;
    if (camera.samples_per_axis == 0) {
        const int of_medium = automatic_samples(input.camera, lights.medium().field());
        settings.samples_per_axis = std::max(of_medium, input.plan.surfaces ? kSurfaceSamples : 1);
        settings.medium_samples_per_axis = of_medium;
    }
    settings.edge_refinement = camera.edge_refinement;
    settings.cells = input.shot.output.cell_layers;
    settings.layers = input.plan.needed;
    if (!input.medium.lattice.empty())
        settings.layers.set(Cell::V, true);
    settings.surroundings = input.surroundings;
    settings.once = lights.once() ? &lights.once()->field() : nullptr;
    return settings;
}

// Draws the frame's picture from its lights: once, or pass by pass.
class FramePicture {
public:
    FramePicture(const DrawInput& input, const ManyLights& lights, Progress& progress)
        : input_(input), lights_(lights), settings_(picture_settings(input, lights)), progress_(progress) {
        if (input.shot.output.virtual_lights && !why_no_virtual_lights(input.shot, input.plan))
            lengths_.emplace(std::size_t(input.camera.settings().width) * input.camera.settings().height);
    }

    Image draw(Statistics& statistics) {
        const ScatteringMethod* const method = input_.plan.scattering_method;
        if (!method)
            return pass(nullptr, 0);
        return mean_of_passes(
            *method, input_.shot.scattering_methods, input_.shot.scattering.bounces, *lights_.direct(), input_.camera,
            [&](const InScattering& estimator, int number) { return pass(&estimator, number); }, seconds_on_estimators_,
            statistics, progress_);
    }

    double samples_per_pixel() const {
        const ScatteringMethod* const method = input_.plan.scattering_method;
        return double(settings_.samples_per_axis) * settings_.samples_per_axis *
               (method ? method->passes(input_.shot.scattering_methods) : 1);
    }
    const PictureSettings& settings() const { return settings_; }
    double seconds_on_estimators() const { return seconds_on_estimators_; }
    const PathLengths* path_lengths() const { return lengths_ ? &*lengths_ : nullptr; }

private:
    Image pass(const InScattering* estimator, int number) {
        settings_.pass = number;
        settings_.light_rays = light_rays_by(estimator, lights_.direct(), input_.plan.emitters_by_rays);
        const SourceField& field = lights_.medium().field();
        if (!input_.plan.surfaces)
            return render_picture(field, input_.camera, settings_, progress_);
        const SurfaceShader shader({input_.plan.needed, field, *lights_.paths(), lights_.medium().lighting(),
                                    lights_.virtual_lights(), estimator, input_.plan.emitters_by_rays, settings_.parts,
                                    input_.camera.settings().width, lengths_ ? &*lengths_ : nullptr});
        return render_picture(field, input_.camera, settings_, progress_,
                              [&](const auto& samples, auto& light) { shader.shade(samples, light); });
    }

    const DrawInput& input_;
    const ManyLights& lights_;
    PictureSettings settings_;
    Progress& progress_;
    std::optional<PathLengths> lengths_;
    double seconds_on_estimators_ = 0.0;
};

// One layer for each order of scattering.
void add_order_layers(Image& image, const DrawInput& input, const LitMedium& lit, PictureSettings settings,
                      Progress& progress) {
    const bool has_single = settings.cells;
    settings.cells = true;
    settings.once = nullptr;
    const auto add = [&](const std::string& name, const Layer& from) {
        Layer layer = from;
        layer.name = name;
        image.layers.push_back(std::move(layer));
    };
    if (settings.layers.contains(Cell::MV)) {
        const Image picture = has_single ? Image{} : render_picture(lit.field(), input.camera, settings, progress);
        add("bounce1", has_single ? Layer(image.layer("MV")) : picture.layer("MV"));
    }
    const std::vector<std::vector<Rgb>>& orders = lit.lighting()->at_nodes().orders;
    for (std::size_t k = 0; k < orders.size(); ++k) {
        const SourceField order(input.medium, {{}, orders[k], {}, {}}, lit.similar());
        settings.layers.set(Cell::MV, false);
        const Image picture = render_picture(order, input.camera, settings, progress);
        const bool tail = k + 1 == orders.size() && k > 0;
        add(tail ? "bounces_beyond" + std::to_string(k + 1) : "bounce" + std::to_string(k + 2), picture.layer("MM"));
    }
}

// What keeps orders of scattering from having layers; empty: nothing does.
std::string why_no_order_layers(const DrawInput& input) {
    if (input.surroundings)
        return "output.layers.bounces with a scene needs method = path; left out";
    if (input.plan.scattering_method)
        return "output.layers.bounces needs scattering.method = lighting_grid; left out";
    return {};
}

void add_layers(Image& image, const DrawInput& input, const ManyLights& lights, const PictureSettings& settings,
                Progress& progress) {
    if (!input.shot.output.bounce_layers)
        return;
    if (const std::string why = why_no_order_layers(input); !why.empty())
        progress.warning("bounce-layers", why);
    else if (lights.medium().lighting())
        add_order_layers(image, input, lights.medium(), settings, progress);
}

std::optional<LightPictures> picture_lights(const DrawInput& input, const VirtualLights& lights, const Image& image,
                                            const PathLengths& lengths, Statistics& statistics, Progress& progress) {
    if (lights.lights().empty()) {
        progress.warning("virtual-lights",
                         kNoLightPictures + std::string("none was placed, as no path of the camera meets a surface "
                                                        "that could hold one"));
        return std::nullopt;
    }
    progress.stage("pictures of virtual lights");
    const Stopwatch watch;
    LightPictures out =
        make_light_pictures(lights, *input.surroundings, input.camera, image.layer(""), lengths.means());
    if (out.profiles.layers.empty())
        progress.notice("no virtual light has a profile: all surfaces are plain Lambert; no picture of profiles");
    statistics.stages.push_back(
        {"pictures of virtual lights", watch.seconds(), 0, {{"lights_seen_by_camera", out.seen}}});
    return out;
}

}  // namespace

Drawn draw_by_many_lights(const DrawInput& input, Statistics& statistics, Progress& progress) {
    if (input.surroundings)
        check_surroundings(input.shot);
    if (input.plan.single || input.plan.multiple)
        check_memory(input.medium,
                     bytes_to_light(input.medium, input.plan.directional, input.shot.lighting.memory_limit_bytes),
                     available_memory());
    const ManyLights lights(input, statistics, progress);
    progress.stage("camera");
    const Stopwatch watch;
    FramePicture picture(input, lights, progress);
    Drawn out{picture.draw(statistics), std::nullopt, picture.samples_per_pixel()};
    add_layers(out.image, input, lights, picture.settings(), progress);
    statistics.stages.push_back({"camera",
                                 watch.seconds() - picture.seconds_on_estimators(),
                                 lights.medium().field().bytes() + (lights.once() ? lights.once()->field().bytes() : 0),
                                 {{"samples_per_pixel", out.samples_per_pixel}}});
    if (const PathLengths* const lengths = picture.path_lengths())
        out.light_pictures = picture_lights(input, *lights.virtual_lights(), out.image, *lengths, statistics, progress);
    return out;
}

std::optional<std::string> why_no_virtual_lights(const Shot& shot, const Plan& plan) {
    if (shot.method == RenderMethod::Path)
        return "method path uses none";
    if (!plan.surfaces)
        return "there are no surfaces";
    if (shot.virtual_lights.count == 0)
        return "virtual_lights.count is 0";
    if (shot.virtual_lights.photons == 0)
        return "virtual_lights.photons is 0";
    if (!plan.emission && !plan.emitters)
        return "nothing shines";
    if (!plan.needs(Cell::SS))
        return "with this scattering.bounces no light goes from surface to surface";
    return std::nullopt;
}

}  // namespace brisance
