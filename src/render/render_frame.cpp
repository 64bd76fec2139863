#include "render/render_frame.h"

#include <sys/resource.h>

#include <ctime>

#include "camera/camera.h"
#include "certificate/certify.h"
#include "core/stopwatch.h"
#include "reference/trace_picture.h"
#include "render/checkpoint_key.h"
#include "render/choose_method.h"
#include "render/draw.h"
#include "render/frame_input.h"
#include "render/plan.h"

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

std::uint64_t peak_resident_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return std::uint64_t(usage.ru_maxrss) * 1024;
}

std::string joined(const std::vector<std::string>& names) {
    std::string all;
    for (const std::string& name : names)
        all += (all.empty() ? "" : "+") + name;
    return all;
}

void add_certificate(RenderedFrame& out, const DrawInput& input, Progress& progress) {
    const Stopwatch watch;
    const std::clock_t cpu = std::clock();
    const CertifiedScene scene{input.medium,
                               input.camera,
                               input.surroundings,
                               input.shot.tracing,
                               input.shot.scattering.bounces,
                               input.plan.emission || input.plan.emitters};
    const Certificate certificate = certify(out.image, scene, input.shot.certify, progress);
    out.statistics.certificate = certificate.to_json();
    out.statistics.stages.push_back(
        {"certificate",
         watch.seconds(),
         0,
         {{"samples", certificate.samples}, {"cpu_seconds", double(std::clock() - cpu) / CLOCKS_PER_SEC}}});
    out.metadata.text["brisance/certificate"] = certificate.to_json().dump();
    progress.notice("certificate: " + certificate.line());
}

void trace_into(RenderedFrame& out, const DrawInput& input, const Checkpoint& checkpoint, Progress& progress) {
    const TracedScene scene{
        input.medium,      input.camera,     input.surroundings, input.shot.tracing, input.shot.scattering.bounces,
        input.plan.needed, input.shot.output};
    TracedPicture traced = trace_picture(scene, checkpoint, out.statistics, progress);
    out.image = std::move(traced.image);
    out.halves = {std::move(traced.halves[0]), std::move(traced.halves[1])};
    out.metadata.samples_per_pixel = traced.samples_per_pixel;
}

void draw_into(RenderedFrame& out, const DrawInput& input, Progress& progress) {
    Drawn drawn = draw_by_many_lights(input, out.statistics, progress);
    out.image = std::move(drawn.image);
    out.light_pictures = std::move(drawn.light_pictures);
    out.metadata.samples_per_pixel = drawn.samples_per_pixel;
}

// Resolves method=auto for this frame alone.
Shot with_chosen_method(const Shot& shot, const Medium& medium, const Surroundings* surroundings,
                        const CameraSettings& camera, RenderedFrame& out, Progress& progress) {
    if (shot.method != RenderMethod::Automatic)
        return shot;
    const MethodForecast forecast = forecast_methods(shot, medium, surroundings, camera, progress);
    out.statistics.stages.push_back(forecast.cost);
    out.metadata.text["brisance/method"] = forecast.name();
    return with_method(shot, forecast);
}

void render_into(RenderedFrame& out, const Shot& given, const Medium& medium, const Surroundings* surroundings,
                 const CameraSettings& camera_settings, const Checkpoint& checkpoint, Progress& progress) {
    const Shot shot = with_chosen_method(given, medium, surroundings, camera_settings, out, progress);
    const Plan plan = plan_cells(shot, medium, surroundings);
    out.statistics.cells = plan.cells();
    out.statistics.skipped = plan.skipped;
    const Camera camera(camera_settings, medium);
    const DrawInput input{shot, plan, medium, surroundings, camera};
    if (shot.output.virtual_lights)
        if (const std::optional<std::string> reason = why_no_virtual_lights(shot, plan))
            progress.warning("virtual-lights", kNoLightPictures + *reason);
    if (shot.method == RenderMethod::Path)
        trace_into(out, input, checkpoint, progress);
    else
        draw_into(out, input, progress);
    if (shot.certify.enabled)
        add_certificate(out, input, progress);
    out.metadata.camera_from_world = camera.camera_from_world();
    out.metadata.vertical_fov_degrees = camera_settings.vertical_fov_degrees;
    out.metadata.text["brisance/cells"] = joined(plan.cells());
    out.statistics.peak_resident_bytes = peak_resident_bytes();
}

// Seconds in all; what no stage reports is a stage, too.
void finish(RenderedFrame& out, double seconds) {
    double reported = 0.0;
    for (const StageCost& stage : out.statistics.stages)
        reported += stage.seconds;
    if (seconds > reported)
        out.statistics.stages.push_back({"between the stages", seconds - reported, 0, {}});
    out.statistics.seconds = out.metadata.render_seconds = seconds;
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
    finish(out, watch.seconds());
    return out;
}

RenderedFrame render_medium(const Shot& shot, const Medium& medium, Progress& to, const Surroundings* surroundings) {
    const Stopwatch watch;
    RenderedFrame out;
    Recorder progress(to, out.statistics);
    const CameraSettings camera = shot.camera_given ? shot.camera : framed_camera(medium, shot.camera);
    render_into(out, shot, medium, surroundings, camera, {}, progress);
    finish(out, watch.seconds());
    return out;
}

Statistics plan_frame(const Shot& shot, const std::filesystem::path& volume, int frame, Progress& to) {
    Statistics statistics;
    Recorder progress(to, statistics);
    const FrameInput input = load_frame(shot, volume, frame, statistics, progress);
    const Shot chosen =
        shot.method != RenderMethod::Automatic
            ? shot
            : with_method(shot, forecast_methods(shot, input.medium, input.surroundings.get(), input.camera, progress));
    const Plan plan = plan_cells(chosen, input.medium, input.surroundings.get());
    statistics.cells = plan.cells();
    statistics.skipped = plan.skipped;
    return statistics;
}

}  // namespace brisance
