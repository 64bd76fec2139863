#include "render/render_frame.h"

#include <sys/resource.h>

#include <ctime>

#include "camera/camera.h"
#include "camera_rays/integrate.h"
#include "camera_rays/source_field.h"
#include "certificate/certify.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "medium/similar_medium.h"
#include "medium_lighting/medium_lighting.h"
#include "medium_lighting/virtual_lights_as_points.h"
#include "reference/trace_picture.h"
#include "render/frame_input.h"
#include "render/load_medium.h"
#include "render/plan.h"
#include "render/scattering_pass.h"
#include "shot/write_shot.h"
#include "surface_lighting/surface_shader.h"

namespace brisance {

namespace {

// Passes everything on and keeps notices and warnings for the statistics.
class Recorder : public Progress {
public:
    Recorder(Progress& to, Statistics& statistics) : to_(to), statistics_(statistics) {}
    void stage(const std::string& name) override { to_.stage(name); }
    void fraction(double done) override { to_.fraction(done); }
    void notice(const std::string& line) override {
        statistics_.notices.push_back(line);
        to_.notice(line);
    }
    void warning(const std::string& code, const std::string& line) override {
        statistics_.warnings.push_back(code + ": " + line);
        to_.warning(code, line);
    }

private:
    Progress& to_;
    Statistics& statistics_;
};

void add_order_layers(Image& image, const SourceField& field, const NodeLighting& lighting, const Medium& medium,
                      const Medium* similar, const Camera& camera, const PictureSettings& settings,
                      Progress& progress) {
    const auto add = [&](const std::string& name, const Layer& from) {
        Layer layer = from;
        layer.name = name;
        image.layers.push_back(std::move(layer));
    };
    PictureSettings one = settings;
    one.cells = true;
    if (settings.layers[static_cast<int>(Cell::MV)]) {
        const Image picture = settings.cells ? Image{} : render_picture(field, camera, one, {}, progress);
        add("bounce1", settings.cells ? Layer(image.layer("MV")) : picture.layer("MV"));
    }
    for (std::size_t k = 0; k < lighting.orders.size(); ++k) {
        const SourceField order(medium, {{}, lighting.orders[k], {}, {}}, similar);
        one.layers[static_cast<int>(Cell::MV)] = false;
        const Image picture = render_picture(order, camera, one, {}, progress);
        const bool tail = k + 1 == lighting.orders.size() && k > 0;
        add(tail ? "bounces_beyond" + std::to_string(k + 1) : "bounce" + std::to_string(k + 2), picture.layer("MM"));
    }
}

std::uint64_t peak_resident_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024;
}

std::unique_ptr<VirtualLights> place_virtual_lights(const Shot& shot, const DirectLight& scene, const Camera& camera,
                                                    Statistics& statistics, Progress& progress) {
    progress.stage("virtual lights");
    const Stopwatch watch;
    const PixelCamera pixels{camera.settings().width, camera.settings().height,
                             [&](double x, double y) { return camera.ray(x, y); }};
    auto lights = std::make_unique<VirtualLights>(scene, pixels, shot.virtual_lights);
    const VirtualLightReport& r = lights->report();
    statistics.stages.push_back({"virtual lights",
                                 watch.seconds(),
                                 r.bytes + r.photon_bytes,
                                 {{"candidates", r.candidates},
                                  {"lights", r.lights},
                                  {"with_profiles", r.profiles},
                                  {"reflected_watts", {r.flux.x, r.flux.y, r.flux.z}},
                                  {"photons", r.photons.photons},
                                  {"photons_from_fire", r.photons.from_fire},
                                  {"photons_not_finite", r.photons.not_finite},
                                  {"unshared_fraction", r.photons.unshared_fraction()},
                                  {"candidate_seconds", r.candidate_seconds},
                                  {"elimination_seconds", r.elimination_seconds},
                                  {"area_seconds", r.area_seconds},
                                  {"photon_seconds", r.photon_seconds},
                                  {"profile_seconds", r.profile_seconds}}});
    return lights;
}

// Anti-aliasing samples along a pixel's side where there are surfaces: their edges are sharp.
constexpr int kSurfaceSamples = 4;

// What the lighting grid and virtual lights cannot do with surfaces is said, not left out in silence.
void check_surroundings(const Shot& shot) {
    if (shot.lighting.gather == GatherMethod::RayMarch)
        throw Error(ExitCode::Usage, "lighting.gather: ray_march knows no surfaces and lights; use cache");
    if (shot.scattering.bounces > 1)
        throw Error(ExitCode::Usage,
                    "scattering.bounces: with a scene it may be 0, 1 or \"all\", as virtual lights hold light of all "
                    "orders; other numbers need method path");
}

// A picture, and what else is known of how it came about.
struct Drawn {
    Image image;
    std::optional<LightPictures> light_pictures;
};

constexpr const char* kNoLightPictures = "no pictures of virtual lights are written: ";

std::optional<LightPictures> picture_lights(const VirtualLights& lights, const Surroundings& surroundings,
                                            const Camera& camera, const Image& image, const PathLengths& lengths,
                                            Statistics& statistics, Progress& progress) {
    if (lights.lights().empty()) {
        progress.warning("virtual-lights",
                         kNoLightPictures + std::string("none was placed, as no path of the camera meets a surface "
                                                        "that could hold one"));
        return std::nullopt;
    }
    progress.stage("pictures of virtual lights");
    const Stopwatch watch;
    LightPictures out = make_light_pictures(lights, surroundings, camera, image.layer(""), lengths.means());
    if (out.profiles.layers.empty())
        progress.notice("no virtual light has a profile: all surfaces are plain Lambert; no picture of profiles");
    statistics.stages.push_back(
        {"pictures of virtual lights", watch.seconds(), 0, {{"lights_seen_by_camera", out.seen}}});
    return out;
}

Drawn draw_once(const Shot& shot, const Plan& plan, const Medium& medium, const Surroundings* surroundings,
                const Camera& camera, Statistics& statistics, ImageMetadata& metadata, Progress& progress) {
    if (surroundings)
        check_surroundings(shot);
    if (plan.scattered_lights)
        check_scattered_lights(shot, plan);
    std::optional<PathTracer> paths;
    if (plan.surfaces)
        paths.emplace(medium, shot.tracing, shot.scattering.bounces, surroundings);
    std::unique_ptr<VirtualLights> virtual_lights;
    if (shot.virtual_lights.count > 0 && (plan.needs(Cell::SS) || plan.needs(Cell::MS)))
        virtual_lights = place_virtual_lights(shot, paths->direct(), camera, statistics, progress);
    std::optional<DirectLight> own_scene;
    if ((plan.scattered_lights || plan.emitters_by_rays) && !paths)
        own_scene.emplace(medium, shot.tracing, surroundings);
    const DirectLight* const scene = paths ? &paths->direct() : own_scene ? &*own_scene : nullptr;
    // Orders of scattering that the grid follows.
    const int grid_bounces = plan.scattered_lights ? bounces_beside_scattered_lights(plan) : shot.scattering.bounces;
    const Plan grid_plan = plan.scattered_lights ? without_scattered_lights(plan) : plan;
    std::unique_ptr<MediumLighting> lighting;
    std::optional<Medium> similar;
    if (plan.single || plan.needs(Cell::SV) || grid_plan.needs(Cell::MA) || plan.needs(Cell::MS)) {
        similar = similar_medium(medium, grid_bounces);
        std::optional<PointsOfSides> reflecting;
        std::optional<SpecularPhotons> cast;
        if (plan.needs(Cell::MS)) {
            const VirtualLights* const shining = plan.reflected_by_particles ? nullptr : virtual_lights.get();
            if (shining)
                reflecting = points_of_virtual_lights(*shining);
            cast.emplace(paths->direct(), shining, shot.virtual_lights);
        }
        const ReflectedLight reflected{reflecting ? &*reflecting : nullptr, cast && !cast->empty() ? &*cast : nullptr};
        lighting = std::make_unique<MediumLighting>(shot, grid_plan, similar ? *similar : medium, camera, statistics,
                                                    progress, surroundings, reflected);
    }
    progress.stage("camera");
    const Stopwatch watch;
    const bool marching = shot.lighting.gather == GatherMethod::RayMarch;
    const NodeLighting none;
    const NodeLighting& nodes = lighting && !marching ? lighting->at_nodes() : none;
    const float forward = forward_left_out(medium.mean_cosine, grid_bounces);
    const SourceField field(medium, nodes, similar ? &*similar : nullptr, forward);
    PictureSettings settings;
    settings.samples_per_axis =
        camera.settings().samples_per_axis > 0 ? camera.settings().samples_per_axis : automatic_samples(camera, field);
    settings.edge_refinement = camera.settings().edge_refinement;
    settings.cells = shot.output.cell_layers;
    settings.layers = plan.needed;
    settings.layers[static_cast<int>(Cell::V)] |= !medium.lattice.empty();
    settings.surroundings = surroundings;
    if (plan.surfaces && camera.settings().samples_per_axis == 0)
        settings.samples_per_axis = std::max(settings.samples_per_axis, kSurfaceSamples);
    std::optional<PathLengths> lengths;
    if (shot.output.virtual_lights && !why_no_virtual_lights(shot, plan))
        lengths.emplace(std::size_t(camera.settings().width) * camera.settings().height);
    LightPoints light_points;
    if (lighting && marching)
        light_points = [&](const auto& points, auto& out) { lighting->at_points(points, out); };
    const auto picture = [&](const InScattering* scattered_lights, int pass) {
        settings.pass = pass;
        settings.light_rays = light_rays_by(scattered_lights, scene, plan);
        if (!plan.surfaces)
            return render_picture(field, camera, settings, light_points, progress);
        const SurfaceShader shader(plan, field, lighting.get(), virtual_lights.get(), *paths, settings.parts,
                                   scattered_lights, lengths ? &*lengths : nullptr);
        return render_picture(field, camera, settings, light_points, progress,
                              [&](const auto& samples, auto& light) { shader.shade(samples, light); });
    };
    double on_lights = 0.0;
    const auto pass = [&](const InScattering& lights, int number) { return picture(&lights, number); };
    Image image = plan.scattered_lights
                      ? mean_of_passes(shot, plan, *scene, camera, pass, on_lights, statistics, progress)
                      : picture(nullptr, 0);
    if (shot.output.bounce_layers && marching)
        progress.warning("bounce-layers", "output.layers.bounces needs lighting.gather = cache; left out");
    else if (shot.output.bounce_layers && surroundings)
        progress.warning("bounce-layers", "output.layers.bounces with a scene needs method = path; left out");
    else if (shot.output.bounce_layers && plan.scattered_lights)
        progress.warning("bounce-layers", "output.layers.bounces needs scattering.method = lighting_grid; left out");
    else if (shot.output.bounce_layers && lighting)
        add_order_layers(image, field, nodes, medium, similar ? &*similar : nullptr, camera, settings, progress);
    metadata.samples_per_pixel = double(settings.samples_per_axis) * settings.samples_per_axis *
                                 (plan.scattered_lights ? passes_of(shot, plan) : 1);
    statistics.stages.push_back(
        {"camera", watch.seconds() - on_lights, field.bytes(), {{"samples_per_pixel", metadata.samples_per_pixel}}});
    Drawn out{std::move(image), std::nullopt};
    if (lengths)
        out.light_pictures =
            picture_lights(*virtual_lights, *surroundings, camera, out.image, *lengths, statistics, progress);
    return out;
}

// Where forward peaks count as no scattering (similar_medium.h), MV and MA hold light that was scattered more than
// once: they are then drawn by themselves, and MM is the rest, so that every path stands in its own layer.
void file_single_scattering(Image& image, const Image& single, const Plan& plan) {
    Layer& mm = image.layer("MM");
    for (const Cell cell : {Cell::MV, Cell::MA}) {
        if (!plan.needs(cell))
            continue;
        Layer& once = image.layer(name_of(cell));
        const Layer& found = single.layer(name_of(cell));
        for (std::size_t i = 0; i < once.pixels.size(); ++i) {
            const float both = once.pixels[i] + mm.pixels[i];
            once.pixels[i] = std::clamp(found.pixels[i], 0.0f, std::max(both, 0.0f));
            mm.pixels[i] = both - once.pixels[i];
        }
    }
}

Drawn draw(const Shot& shot, const Plan& plan, const Medium& medium, const Surroundings* surroundings,
           const Camera& camera, Statistics& statistics, ImageMetadata& metadata, Progress& progress) {
    Drawn drawn = draw_once(shot, plan, medium, surroundings, camera, statistics, metadata, progress);
    const bool mixed = plan.multiple && !plan.scattered_lights && shot.scattering.bounces < 0 &&
                       forward_share(medium.mean_cosine) > 0.0f;
    if (!mixed || !shot.output.cell_layers)
        return drawn;
    Shot alone = shot;
    alone.scattering.bounces = 1;
    alone.output.bounce_layers = alone.output.virtual_lights = false;
    Plan single = plan;
    single.multiple = false;
    for (int cell = 0; cell < kCells; ++cell)
        single.needed[cell] &= cell == int(Cell::MV) || cell == int(Cell::MA);
    Statistics costs;
    ImageMetadata ignored;
    file_single_scattering(
        drawn.image, draw_once(alone, single, medium, surroundings, camera, costs, ignored, progress).image, plan);
    for (StageCost& stage : costs.stages) {
        stage.name += ", for its own layer";
        statistics.stages.push_back(std::move(stage));
    }
    return drawn;
}

// All that decides a path tracer's bits, but for when it stops and what becomes of them.
std::string checkpoint_key(Shot shot, const std::filesystem::path& volume, int frame) {
    const TracingSettings given = shot.tracing;
    shot.tracing = TracingSettings{};
    shot.tracing.seed = given.seed;
    shot.tracing.emission = given.emission;
    shot.tracing.light_sampling = given.light_sampling;
    shot.tracing.free_flight = given.free_flight;
    shot.tracing.transmittance = given.transmittance;
    const bool bounces = shot.output.bounce_layers;
    shot.certify = CertifySettings{};
    shot.virtual_lights = VirtualLightSettings{};
    shot.ray_lights = RayLightSettings{};
    shot.point_lights = VolumetricVplSettings{};
    shot.particles = VolumetricPhotonSettings{};
    shot.output = OutputSettings{};
    shot.output.bounce_layers = bounces;
    const auto size_of = [](const std::filesystem::path& file) {
        std::error_code ignored;
        return std::to_string(std::filesystem::file_size(file, ignored));
    };
    std::string key = to_json(shot) + volume.filename().string() + " " + size_of(volume) + " " + std::to_string(frame);
    for (const std::filesystem::path& file : further_files(shot, frame))
        key.append(" ").append(size_of(file));
    for (const SceneFile& file : shot.scene.files)
        key.append(" ").append(size_of(shot.folder / file.file));
    return key;
}

std::string joined(const std::vector<std::string>& names) {
    std::string all;
    for (const std::string& name : names)
        all += (all.empty() ? "" : "+") + name;
    return all;
}

void add_certificate(RenderedFrame& out, const Shot& shot, const Plan& plan, const Medium& medium,
                     const Surroundings* surroundings, const Camera& camera, Progress& progress) {
    const Stopwatch watch;
    const std::clock_t cpu = std::clock();
    const Certificate certificate =
        certify(out.image, shot, plan, medium, camera, shot.certify, progress, surroundings);
    out.statistics.certificate = certificate.to_json();
    out.statistics.stages.push_back(
        {"certificate",
         watch.seconds(),
         0,
         {{"samples", certificate.samples}, {"cpu_seconds", double(std::clock() - cpu) / CLOCKS_PER_SEC}}});
    out.metadata.text["brisance/certificate"] = certificate.to_json().dump();
    progress.notice("certificate: " + certificate.line());
}

void render_into(RenderedFrame& out, const Shot& shot, const Medium& medium, const Surroundings* surroundings,
                 const CameraSettings& camera_settings, const Checkpoint& checkpoint, Progress& progress) {
    const Plan plan = plan_cells(shot, medium, surroundings);
    out.statistics.cells = plan.cells();
    out.statistics.skipped = plan.skipped;
    const Camera camera(camera_settings, medium);
    if (shot.output.virtual_lights)
        if (const std::optional<std::string> reason = why_no_virtual_lights(shot, plan))
            progress.warning("virtual-lights", kNoLightPictures + *reason);
    if (shot.method == RenderMethod::Path) {
        TracedPicture traced =
            trace_picture(shot, plan, medium, surroundings, camera, checkpoint, out.statistics, progress);
        out.image = std::move(traced.image);
        out.halves = {std::move(traced.halves[0]), std::move(traced.halves[1])};
        out.metadata.samples_per_pixel = traced.samples_per_pixel;
    } else {
        Drawn drawn = draw(shot, plan, medium, surroundings, camera, out.statistics, out.metadata, progress);
        out.image = std::move(drawn.image);
        out.light_pictures = std::move(drawn.light_pictures);
    }
    if (shot.certify.enabled)
        add_certificate(out, shot, plan, medium, surroundings, camera, progress);
    out.metadata.camera_from_world = camera.camera_from_world();
    out.metadata.vertical_fov_degrees = camera_settings.vertical_fov_degrees;
    out.metadata.text["brisance/cells"] = joined(plan.cells());
    out.statistics.peak_resident_bytes = peak_resident_bytes();
}

}  // namespace

RenderedFrame render_frame(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& to,
                           const std::filesystem::path& checkpoint) {
    const Stopwatch watch;
    RenderedFrame out;
    Recorder progress(to, out.statistics);
    const FrameInput input = load_frame(shot, volume, frame, out.statistics, progress);
    render_into(out, shot, input.medium, input.surroundings.get(), input.camera,
                {checkpoint, checkpoint_key(shot, volume, frame)}, progress);
    out.metadata.frame = frame;
    out.statistics.seconds = out.metadata.render_seconds = watch.seconds();
    return out;
}

RenderedFrame render_medium(const Shot& shot, const Medium& medium, Progress& to, const Surroundings* surroundings) {
    const Stopwatch watch;
    RenderedFrame out;
    Recorder progress(to, out.statistics);
    const CameraSettings camera = shot.camera_given ? shot.camera : framed_camera(medium, shot.camera);
    render_into(out, shot, medium, surroundings, camera, {}, progress);
    out.statistics.seconds = out.metadata.render_seconds = watch.seconds();
    return out;
}

Statistics plan_frame(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& to) {
    Statistics statistics;
    Recorder progress(to, statistics);
    const FrameInput input = load_frame(shot, volume, frame, statistics, progress);
    const Plan plan = plan_cells(shot, input.medium, input.surroundings.get());
    statistics.cells = plan.cells();
    statistics.skipped = plan.skipped;
    return statistics;
}

}  // namespace brisance
