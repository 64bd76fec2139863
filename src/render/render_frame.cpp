#include "render/render_frame.h"

#include <sys/resource.h>

#include <chrono>

#include "render/camera.h"
#include "render/cell_field.h"
#include "render/integrate.h"
#include "render/lighting.h"
#include "render/plan.h"
#include "volume/mapping.h"

namespace brisance {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kGridMemory = std::uint64_t{16} << 30;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

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

Medium load_medium(const Shot& shot, const std::filesystem::path& volume, Statistics& statistics, Progress& progress) {
    progress.stage("reading " + volume.filename().string());
    Clock::time_point start = Clock::now();
    const GridMapping mapping = map_grids(list_grids(volume), shot.volume, volume.string());
    progress.notice("grids: " + mapping.describe());
    for (const std::string& note : mapping.notes)
        progress.notice(note);
    const FireModel fire = shot.medium.fire.model;
    const bool black_body = fire == FireModel::Blackbody || fire == FireModel::NormalizedBlackbody;
    const auto read = [&](const std::optional<GridChoice>& choice, bool used) -> std::optional<BlockGrid> {
        if (!choice || !used)
            return std::nullopt;
        return read_grid(volume, choice->name, choice->index, kGridMemory);
    };
    MediumGrids grids;
    grids.density = read(mapping.density, true);
    grids.temperature = read(mapping.temperature, black_body);
    grids.flame = read(mapping.flame, fire == FireModel::Flame || (black_body && shot.medium.fire.modulate_by_flame));
    grids.colour = read(mapping.colour, true);
    if (!mapping.density)
        progress.notice("no density grid: nothing absorbs or scatters");
    if (black_body && !mapping.temperature)
        progress.warning("no-temperature", "fire.model asks for a temperature grid and none is mapped: nothing emits");
    if (fire == FireModel::Flame && !mapping.flame)
        progress.warning("no-flame", "fire.model is flame and no flame grid is mapped: nothing emits");
    std::uint64_t bytes = 0;
    for (const auto* g : {&grids.density, &grids.temperature, &grids.flame, &grids.colour})
        bytes += *g ? (*g)->values.size() * sizeof(float) : 0;
    statistics.stages.push_back(
        {"reading", seconds_since(start), bytes, {{"file", volume.string()}, {"mapping", mapping.describe()}}});

    progress.stage("medium");
    start = Clock::now();
    Medium medium = build_medium(grids, shot.medium, shot.volume.half_voxel_shift, progress);
    std::size_t nodes = 0;
    for (float e : medium.extinction)
        nodes += e > 0.0f;
    statistics.stages.push_back({"medium",
                                 seconds_since(start),
                                 medium.bytes(),
                                 {{"bricks", medium.lattice.brick_count()},
                                  {"absorbing_nodes", nodes},
                                  {"voxel_metres", medium.spacing},
                                  {"largest_extinction_per_metre", medium.max_extinction}}});
    if (medium.lattice.empty())
        progress.notice("the volume is empty: a black frame");
    return medium;
}

void add_order_layers(Image& image, const CellField& field, const NodeLighting& lighting, const Medium& medium,
                      const Camera& camera, const PictureSettings& settings, Progress& progress) {
    const auto add = [&](const std::string& name, const Layer& from) {
        Layer layer = from;
        layer.name = name;
        image.layers.push_back(std::move(layer));
    };
    PictureSettings one = settings;
    one.cells = true;
    if (settings.has_single) {
        const Image picture = settings.cells ? Image{} : render_picture(field, camera, one, {}, progress);
        add("bounce1", settings.cells ? Layer(image.layer("MV")) : picture.layer("MV"));
    }
    for (std::size_t k = 0; k < lighting.orders.size(); ++k) {
        const CellField order(medium, {}, lighting.orders[k]);
        one.has_single = false;
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

Image draw(const Shot& shot, const Plan& plan, const Medium& medium, const Camera& camera, Statistics& statistics,
           ImageMetadata& metadata, Progress& progress) {
    std::unique_ptr<Lighting> lighting;
    if (plan.single)
        lighting = std::make_unique<Lighting>(shot, plan, medium, camera, statistics, progress);
    progress.stage("camera");
    const Clock::time_point start = Clock::now();
    const bool marching = shot.lighting.gather == GatherMethod::RayMarch;
    const NodeLighting none;
    const NodeLighting& nodes = lighting && !marching ? lighting->at_nodes() : none;
    const CellField field(medium, nodes.single, nodes.multiple);
    PictureSettings settings;
    settings.samples_per_axis =
        camera.settings().samples_per_axis > 0 ? camera.settings().samples_per_axis : automatic_samples(camera, field);
    settings.cells = shot.output.cell_layers;
    settings.has_single = plan.single;
    settings.has_multiple = plan.multiple;
    LightPoints light_points;
    if (lighting && marching)
        light_points = [&](const auto& points, auto& out) { lighting->at_points(points, out); };
    Image image = render_picture(field, camera, settings, light_points, progress);
    if (shot.output.bounce_layers && marching)
        progress.warning("bounce-layers", "output.layers.bounces needs lighting.gather = cache; left out");
    else if (shot.output.bounce_layers && lighting)
        add_order_layers(image, field, nodes, medium, camera, settings, progress);
    metadata.samples_per_pixel = double(settings.samples_per_axis) * settings.samples_per_axis;
    statistics.stages.push_back(
        {"camera", seconds_since(start), field.bytes(), {{"samples_per_pixel", metadata.samples_per_pixel}}});
    return image;
}

}  // namespace

RenderedFrame render_frame(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& to) {
    const Clock::time_point start = Clock::now();
    RenderedFrame out;
    Recorder progress(to, out.statistics);
    const Medium medium = load_medium(shot, volume, out.statistics, progress);
    const Plan plan = plan_cells(shot, medium);
    out.statistics.cells = plan.cells();
    out.statistics.skipped = plan.skipped;
    const CameraSettings camera_settings = shot.camera_given ? shot.camera : framed_camera(medium, shot.camera);
    const Camera camera(camera_settings, medium);
    out.image = draw(shot, plan, medium, camera, out.statistics, out.metadata, progress);
    out.metadata.frame = frame;
    out.metadata.camera_from_world = camera.camera_from_world();
    out.metadata.vertical_fov_degrees = camera_settings.vertical_fov_degrees;
    out.metadata.text["brisance/cells"] = [&] {
        std::string names;
        for (const std::string& c : plan.cells())
            names += (names.empty() ? "" : "+") + c;
        return names;
    }();
    out.statistics.seconds = out.metadata.render_seconds = seconds_since(start);
    out.statistics.peak_resident_bytes = peak_resident_bytes();
    return out;
}

Statistics plan_frame(const Shot& shot, const std::filesystem::path& volume, Progress& to) {
    Statistics statistics;
    Recorder progress(to, statistics);
    const Medium medium = load_medium(shot, volume, statistics, progress);
    const Plan plan = plan_cells(shot, medium);
    statistics.cells = plan.cells();
    statistics.skipped = plan.skipped;
    return statistics;
}

}  // namespace brisance
