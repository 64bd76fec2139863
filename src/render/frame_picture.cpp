#include "render/frame_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "camera/pixel_samples.h"
#include "camera_rays/automatic_samples.h"
#include "camera_rays/moment_mean.h"
#include "core/cpu_clock.h"
#include "core/stopwatch.h"
#include "render/bound_layers.h"
#include "render/typical_luminance.h"
#include "scattering_methods/scattering_pass.h"

namespace brisance {

namespace {

// What a single pixel may err by for want of rays, in parts of `lighting.error`. Most pixels err by far less.
constexpr float kShareOfSampling = 0.35f;

constexpr std::pair<Cell, SharedBounce::Apart> kSharedCells[] = {
    {Cell::SV, SharedBounce::Apart::SV}, {Cell::SM, SharedBounce::Apart::SM}, {Cell::SA, SharedBounce::Apart::SA}};

// Standard error of a pixel of surfaces for want of shaded samples, in parts of `lighting.error` (SurfaceRounds). Most
// have less: together they err by less than `lighting.error` of the picture.
constexpr float kShareOfShading = 1.5f;

// Few rays first, and more where they err. Not where each ray carries random estimates, which want all rays, nor where
// the layers of bounces have to add up, nor where moments of the shutter share the rays of a pixel.
bool looks_twice(const DrawInput& input, bool moments) {
    const Plan& plan = input.plan;
    return !moments && !plan.scattering_method && !plan.lights_on_rays() && plan.emitters_by_rays == 0.0f &&
           !input.shot.output.bounce_layers;
}

PictureSettings picture_settings(const DrawInput& input, const ManyLights& lights, bool moments) {
    const CameraSettings& camera = input.camera.settings();
    PictureSettings settings;
    settings.samples_per_axis = camera.samples_per_axis;
    if (camera.samples_per_axis == 0) {
        const AutomaticSamples of_medium = automatic_samples(input.camera, lights.medium().field().medium());
        const int first = looks_twice(input, moments) ? of_medium.few : of_medium.enough;
        settings.samples_per_axis = input.plan.surfaces ? std::max(first, kSurfaceSamples) : first;
        settings.medium_samples_per_axis = first;
        settings.finest_medium_samples_per_axis = of_medium.enough;
        settings.tolerance = kShareOfSampling * static_cast<float>(input.shot.lighting.error);
    }
    settings.edge_refinement = camera.edge_refinement;
    settings.cells = input.shot.output.cell_layers;
    settings.layers = input.plan.needed;
    settings.by_rays = input.plan.on_rays;
    if (!input.medium.lattice.empty())
        settings.layers.set(Cell::V, true);
    return settings;
}

// Those of the plan's on_rays; empty where it has none.
ManyLightsOnRay many_lights_on_rays(const Plan& plan, const MomentLights& lights) {
    if (const UnifiedLights* const all = lights.unified_in_smoke())
        return [all](const RayMedium& seen, const PixelRay& r, LightOnRay& light) {
            Rng rng = all->ray_rng(r.pixel, r.number);
            const LightBySender found = all->along(seen, r.ray, rng);
            light.fire += found.fire;
            light.surfaces += found.surfaces;
            light.emitters += found.emitters;
        };
    if (plan.on_rays.contains(Cell::MV))
        return [fire = lights.fire()](const RayMedium& seen, const PixelRay& r, LightOnRay& light) {
            Rng rng = fire->rng(r.pixel, r.number);
            light.fire += fire->along(seen, r.ray, rng);
        };
    return {};
}

// Rays of a pixel are divided among the moments of the shutter.
int share_of_moment(int per_axis, std::size_t moments) {
    return per_axis == 0 ? 0 : std::max(1, static_cast<int>(std::ceil(per_axis / std::sqrt(double(moments)) - 1e-9)));
}

// Evenly spread over the unit square (Roberts' sequence), so that together the moments' rays fill a pixel.
glm::dvec2 shift_of_moment(std::size_t moment) {
    const glm::dvec2 p = double(moment) * glm::dvec2(0.7548776662466927, 0.5698402909980532);
    return p - glm::floor(p);
}

// Adds light per pixel to a cell's layer, where there is one, and to the picture.
void add_to_cell(Image& image, Cell cell, const std::vector<Rgb>& light) {
    for (Layer& layer : image.layers) {
        if (!layer.name.empty() && layer.name != name_of(cell))
            continue;
        const std::size_t channels = layer.channels.size();
        for (std::size_t p = 0; p < light.size(); ++p)
            for (int c = 0; c < 3; ++c)
                layer.pixels[p * channels + c] += light[p][c];
    }
}

// All threads of the process work on it.
void add_compensation(Image& image, ScreenSpaceCompensation& compensated, BoundAccount* bound) {
    const double start = bound ? process_cpu_seconds() : 0.0;
    const std::vector<Rgb> pixels = compensated.take_pixels();
    if (bound) {
        bound->costs().compensation_seconds += process_cpu_seconds() - start;
        bound->add_residual(pixels);
    }
    add_to_cell(image, Cell::SS, pixels);
}

}  // namespace

FramePicture::FramePicture(const DrawInput& input, const ManyLights& lights, const LitStretch* stretch,
                           Progress& progress)
    : input_(input),
      lights_(lights),
      stretch_(stretch),
      settings_(picture_settings(input, lights, stretch != nullptr)),
      progress_(progress) {
    if (input.shot.output.virtual_lights && !why_no_virtual_lights(input.shot, input.plan))
        lengths_.emplace(std::size_t(input.camera.settings().width) * input.camera.settings().height);
    if (!stretch)
        return;
    const std::size_t moments = stretch->shutter.moments().size();
    settings_.samples_per_axis = share_of_moment(settings_.samples_per_axis, moments);
    settings_.medium_samples_per_axis = share_of_moment(settings_.medium_samples_per_axis, moments);
    settings_.finest_medium_samples_per_axis = 0;
    settings_.edge_refinement = share_of_moment(settings_.edge_refinement, moments);
}

double FramePicture::samples_per_pixel() const {
    const ScatteringMethod* const method = input_.plan.scattering_method;
    return double(rays_of_pixel()) * (method ? method->passes(input_.shot.scattering_methods) : light_passes()) *
           double(stretch_ ? stretch_->shutter.moments().size() : 1);
}

int FramePicture::light_passes() const {
    return lights_.virtual_lights() && input_.plan.needs(Cell::SS) ? input_.shot.virtual_lights.passes : 1;
}

Image FramePicture::mean_of_light_passes(const std::function<void(int pass)>& place_again) {
    Image mean = pass(nullptr, 0);
    for (int k = 1; k < light_passes(); ++k) {
        const Stopwatch watch;
        place_again(k);
        seconds_on_estimators_ += watch.seconds();
        progress_.stage(fmt::format("camera, pass {} of {}", k + 1, light_passes()));
        add_to_mean(mean, pass(nullptr, k), k + 1);
    }
    return mean;
}

Image FramePicture::draw(Statistics& statistics, const std::function<void(int pass)>& place_again) {
    const ScatteringMethod* const method = input_.plan.scattering_method;
    if (!method)
        return mean_of_light_passes(place_again);
    return mean_of_passes(
        *method, input_.shot.scattering_methods, input_.shot.scattering.bounces, *lights_.direct(), input_.camera,
        [&](const InScattering& estimator, int number) { return pass(&estimator, number); }, seconds_on_estimators_,
        statistics, progress_);
}

template <class Draw>
Image FramePicture::mean_of_moments(const Draw& draw) {
    MomentMean mean;
    for (std::size_t k = stretch_->first; k < stretch_->first + stretch_->count; ++k) {
        settings_.sample_shift = shift_of_moment(k);
        mean.add(draw(stretch_->shutter.instant(k), static_cast<int>(k)));
    }
    return mean.take();
}

Image FramePicture::pass(const InScattering* estimator, int number) {
    if (!stretch_)
        return picture(estimator, number, MomentLights(lights_), input_.camera, input_.surroundings);
    const int moments = static_cast<int>(stretch_->shutter.moments().size());
    return mean_of_moments([&](const Instant& instant, int moment) {
        const MomentLights lights(input_, lights_, stretch_->shutter, stretch_->lit, instant);
        return picture(estimator, number * moments + moment, lights, *instant.camera, instant.surroundings);
    });
}

// None where samples reuse nothing.
std::optional<LightReuse> FramePicture::light_reuse(const Camera& camera, SharedBounce* shared,
                                                    BoundAccount* bound) const {
    const VirtualLightSettings& s = input_.shot.virtual_lights;
    const ReservoirLights* const lights =
        lights_.virtual_lights() && input_.plan.needs(Cell::SS) ? lights_.virtual_lights()->reservoirs() : nullptr;
    if (!lights || s.resampling_neighbours == 0)
        return std::nullopt;
    return LightReuse(
        *lights, camera.settings().width, camera.settings().height,
        {s.resampling_neighbours, s.resampling_radius, s.resampling_visibility, s.resampling_rounds, s.seed}, shared,
        bound);
}

// None where no light is bounded, or nothing on the screen is to make up for it.
std::optional<ScreenSpaceCompensation> FramePicture::compensation(const Camera& camera) const {
    const VirtualLightSettings& s = input_.shot.virtual_lights;
    if (s.compensation != BoundCompensation::ScreenSpace || !input_.plan.needs(Cell::SS) || !lights_.virtual_lights() ||
        lights_.virtual_lights()->lights().empty())
        return std::nullopt;
    return ScreenSpaceCompensation(camera.settings().width, camera.settings().height, s, samples_of_pixel(camera));
}

// Wider filters have more.
int FramePicture::samples_of_pixel(const Camera& camera) const {
    return static_cast<int>(
        pixel_samples(camera.settings(), settings_.samples_per_axis, settings_.sample_shift).size());
}

// Passes of a scattering method divide the error among them, and compensation in screen space looks at all samples. Who
// states the samples of a pixel wants them all.
void FramePicture::set_tolerances(const Camera& camera, SurfaceLightingInput& lighting) {
    if (input_.plan.scattering_method || input_.camera.settings().samples_per_axis > 0 ||
        input_.shot.virtual_lights.compensation == BoundCompensation::ScreenSpace ||
        !SurfaceRounds::split(std::size_t(lighting.samples)))
        return;
    if (!typical_)
        typical_ = typical_luminance(camera, settings_, lighting);
    const auto error = static_cast<float>(input_.shot.lighting.error);
    lighting.tolerance = {kShareOfShading * error, *typical_};
    lighting.tolerance_of_bases = {error, 0.0f};
}

// What rough lobes reflect is shared as a whole, but where lights are to be seen one by one: in the smoke, in
// reservoirs, and where their bound is asked for.
std::vector<SharedBounce::Apart> FramePicture::told_of_shared(const InScattering* estimator,
                                                              bool asks_for_bound) const {
    if (asks_for_bound)
        return {SharedBounce::Apart::Residual};
    const VirtualLightSettings& s = input_.shot.virtual_lights;
    if (estimator || s.compensation == BoundCompensation::ScreenSpace || s.resampling_neighbours > 0)
        return {};
    return {SharedBounce::Apart::SV, SharedBounce::Apart::SM, SharedBounce::Apart::SA};
}

void FramePicture::add_shared(Image& image, SharedBounce& shared) {
    add_to_cell(image, Cell::SS, shared.take_pixels());
    square_errors_of_shared_[int(Cell::SS)] += shared.square_error();
    for (const auto& [cell, part] : kSharedCells)
        if (shared.tells(part)) {
            add_to_cell(image, cell, shared.told_pixels(part));
            square_errors_of_shared_[int(cell)] += shared.square_error(part);
        }
}

// Of the mean of all pictures.
nlohmann::ordered_json FramePicture::errors_of_shared() const {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (int cell = 0; cell < kCells; ++cell)
        if (square_errors_of_shared_[cell] > 0.0)
            json[kCellNames[cell]] = std::sqrt(square_errors_of_shared_[cell]) / pictures_;
    return json;
}

double FramePicture::error_of_shading() const {
    return square_error_of_shading_ > 0.0 ? std::sqrt(square_error_of_shading_) / pictures_ : 0.0;
}

Image FramePicture::picture(const InScattering* estimator, int number, const MomentLights& lights, const Camera& camera,
                            const Surroundings* surroundings) {
    settings_.pass = number;
    settings_.light_rays = light_rays_by(estimator, lights.direct(), lights.field(),
                                         input_.plan.on_rays.contains(Cell::MA) ? 0.0f : input_.plan.emitters_by_rays,
                                         many_lights_on_rays(input_.plan, lights));
    settings_.surroundings = surroundings;
    settings_.once = lights.once();
    settings_.once_by_rays = takes_peaks_for_straight(input_) ? input_.plan.emitters_by_rays : 0.0f;
    if (!input_.plan.surfaces)
        return render_picture(lights.field(), camera, settings_, progress_);
    const bool asks_for_bound = has_bound_layers(input_.shot, input_.plan);
    std::optional<BoundAccount> bound;
    if (asks_for_bound)
        bound.emplace(std::size_t(camera.settings().width) * camera.settings().height);
    // Parts of points and spheres, which are there for comparison, have to add up.
    const bool calms = input_.shot.virtual_lights.kind == VirtualLightSettings().kind;
    std::optional<SharedBounce> shared;
    const double radius = input_.shot.virtual_lights.sharing_radius;
    if (lights_.virtual_lights() && input_.plan.needs(Cell::SS) && radius > 0.0)
        shared.emplace(camera.settings().width, camera.settings().height, radius, rays_of_pixel(),
                       told_of_shared(estimator, asks_for_bound), calms);
    std::optional<SharedBounce> shared_sky;
    if (radius > 0.0 && input_.plan.needs(Cell::SA) && !lights.unified() &&
        surroundings->emitters().has_even_background())
        shared_sky.emplace(camera.settings().width, camera.settings().height, radius, rays_of_pixel());
    std::optional<LightReuse> reuse = light_reuse(camera, shared ? &*shared : nullptr, bound ? &*bound : nullptr);
    std::optional<ScreenSpaceCompensation> compensated = compensation(camera);
    std::optional<DividedGrains> grains;
    const bool compares = bound || reuse || compensated || estimator || lights.unified() || lights.fire_on_surfaces();
    if (radius > 0.0 && calms && !compares && samples_of_pixel(camera) >= GrainFinder::kFewestSamples)
        grains.emplace(camera.settings().width, camera.settings().height);
    SurfaceLightingInput lighting{input_.plan.needed,
                                  lights.field(),
                                  *lights.paths(),
                                  lights_.medium().lighting(),
                                  lights_.virtual_lights(),
                                  estimator,
                                  takes_peaks_for_straight(input_) ? 0.0f : input_.plan.emitters_by_rays,
                                  settings_.parts,
                                  camera.settings().width,
                                  static_cast<float>(input_.shot.lighting.error),
                                  {},
                                  {},
                                  samples_of_pixel(camera),
                                  lengths_ ? &*lengths_ : nullptr,
                                  shared ? &*shared : nullptr,
                                  shared_sky ? &*shared_sky : nullptr,
                                  camera.pixel_angle(),
                                  reuse ? &*reuse : nullptr,
                                  compensated ? &*compensated : nullptr,
                                  lights.fire_on_surfaces(),
                                  lights.unified(),
                                  bound ? &*bound : nullptr,
                                  grains ? &*grains : nullptr,
                                  input_.shot.virtual_lights.seed};
    set_tolerances(camera, lighting);
    SurfaceShader shader(lighting);
    Image image = render_picture(lights.field(), camera, settings_, progress_,
                                 [&](const auto& samples, auto& light) { shader.shade(samples, light); });
    if (reuse)
        add_to_cell(image, Cell::SS, reuse->take_pixels());
    ++pictures_;
    square_error_of_shading_ += shader.square_error();
    if (shared)
        add_shared(image, *shared);
    if (shared_sky) {
        add_to_cell(image, Cell::SA, shared_sky->take_pixels());
        square_errors_of_shared_[int(Cell::SA)] += shared_sky->square_error();
    }
    if (grains && !grains->empty()) {
        grains->divide();
        for (const Cell cell : DividedGrains::kOfSurfaces) {
            add_to_cell(image, cell, grains->pixels(cell));
            square_errors_of_shared_[int(cell)] += grains->square_error(cell);
        }
    }
    if (shared && bound)
        bound->add_residual(shared->told_pixels(SharedBounce::Apart::Residual));
    if (compensated)
        add_compensation(image, *compensated, bound ? &*bound : nullptr);
    if (bound) {
        bound_costs_ += bound->costs();
        add_bound_sums(image, input_.shot, *bound);
    }
    return image;
}

Image FramePicture::order_picture(const NodeSources& order, PictureSettings settings) {
    const LitMedium& lit = lights_.medium();
    if (!stretch_)
        return render_picture(SourceField(input_.medium, order, lit.similar()), input_.camera, settings, progress_);
    return mean_of_moments([&](const Instant& instant, int) {
        settings.sample_shift = settings_.sample_shift;
        if (instant.medium == stretch_->lit.medium)
            return render_picture(SourceField(input_.medium, order, lit.similar()), *instant.camera, settings,
                                  progress_);
        const Origins origins = stretch_->shutter.origins(stretch_->lit, instant);
        const MovedField moved(moved_sources(order, input_.medium, origins), *instant.medium, lit.bounces(), 0.0f);
        return render_picture(moved.field(), *instant.camera, settings, progress_);
    });
}

void FramePicture::add_order_layers(Image& image) {
    PictureSettings settings = settings_;
    settings.cells = true;
    settings.once = nullptr;
    settings.light_rays = {};
    settings.by_rays = {};
    const auto add = [&](const std::string& name, const Layer& from) {
        Layer layer = from;
        layer.name = name;
        image.layers.push_back(std::move(layer));
    };
    const NodeLighting& nodes = lights_.medium().lighting()->at_nodes();
    if (settings.layers.contains(Cell::MV)) {
        NodeSources single;
        single.single = nodes.single;
        add("bounce1", settings_.cells ? Layer(image.layer("MV")) : order_picture(single, settings).layer("MV"));
    }
    settings.layers.set(Cell::MV, false);
    for (std::size_t k = 0; k < nodes.orders.size(); ++k) {
        NodeSources order;
        order.multiple = nodes.orders[k];
        const bool tail = k + 1 == nodes.orders.size() && k > 0;
        add(tail ? "bounces_beyond" + std::to_string(k + 1) : "bounce" + std::to_string(k + 2),
            order_picture(order, settings).layer("MM"));
    }
}

}  // namespace brisance
