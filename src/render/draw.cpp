#include "render/draw.h"

#include <utility>

#include "camera_rays/moment_mean.h"
#include "core/available_memory.h"
#include "core/error.h"
#include "core/stopwatch.h"
#include "forecast/memory_need.h"
#include "medium_lighting/levels/lighting_level.h"
#include "render/bound_layers.h"
#include "render/choice/camera_time.h"
#include "render/frame_picture.h"
#include "render/many_lights.h"

namespace brisance {

namespace {

// What virtual lights cannot do is said, not left out in silence.
void check_surroundings(const Shot& shot, const Plan& plan) {
    if (shot.scattering.bounces > 1)
        throw Error(ExitCode::Usage,
                    "scattering.bounces: with a scene it may be 0, 1 or \"all\", as virtual lights hold light of all "
                    "orders; other numbers need method path");
    if (shot.virtual_lights.passes > 1 && plan.scattering_method)
        throw Error(ExitCode::Usage,
                    "virtual_lights.passes above 1 need scattering.method=lighting_grid: other methods "
                    "have passes of their own");
    if (shot.virtual_lights.passes > 1 && plan.unified_sampling)
        throw Error(ExitCode::Usage,
                    "virtual_lights.passes above 1 need unified_lights.sampling=none: its tree holds "
                    "the lights of one pass");
}

// What keeps orders of scattering from having layers; empty: nothing does.
std::string why_no_order_layers(const DrawInput& input) {
    if (input.surroundings)
        return "output.layers.bounces with a scene needs method = path; left out";
    if (input.plan.scattering_method)
        return "output.layers.bounces needs scattering.method = lighting_grid; left out";
    if (input.plan.on_rays.contains(Cell::MV) && !input.shot.output.cell_layers)
        return "output.layers.bounces with single lights of the fire needs output.layers.cells; left out";
    return {};
}

void add_layers(Image& image, const DrawInput& input, const ManyLights& lights, FramePicture& picture,
                Progress& progress) {
    if (!input.shot.output.bounce_layers)
        return;
    if (const std::string why = why_no_order_layers(input); !why.empty())
        progress.warning("bounce-layers", why);
    else if (lights.medium().lighting())
        picture.add_order_layers(image);
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

// Looks for the lattice of the light, which takes time, only where the medium's own needs too much.
void check_memory_to_light(const DrawInput& input) {
    const std::optional<std::uint64_t> available = available_memory();
    const auto needed = [&](int level) {
        return bytes_to_light(input.medium, input.plan.directional, input.shot.lighting.memory_limit_bytes, level);
    };
    if (available && needed(0) > *available)
        check_memory(input.medium,
                     needed(lighting_levels(medium_lighting_input(input, input.plan, input.medium)).first.level),
                     available);
}

// The picture of a frame, or of a stretch of its shutter, and the lights that it is made with.
Drawn draw_lit(const DrawInput& given, const LitStretch* stretch, Statistics& statistics, Progress& progress) {
    ManyLights lights(given, statistics, progress);
    std::optional<Camera> timed;
    if (given.time)
        timed.emplace(camera_for_time(given, lights, given.time->left(), statistics, progress), given.medium);
    const DrawInput input{
        given.shot,    given.plan,           given.medium, given.surroundings, timed ? *timed : given.camera,
        given.shutter, given.light_positions};
    progress.stage("camera");
    const Stopwatch watch;
    FramePicture picture(input, lights, stretch, progress);
    const auto place_again = [&](int pass) { lights.place_again(input, pass, statistics, progress); };
    Drawn out{picture.draw(statistics, place_again), std::nullopt, picture.samples_per_pixel(), picture.bound_costs()};
    add_layers(out.image, input, lights, picture, progress);
    statistics.stages.push_back({"camera",
                                 watch.seconds() - picture.seconds_on_estimators(),
                                 lights.medium().field().bytes() + (lights.once() ? lights.once()->field().bytes() : 0),
                                 {{"samples_per_pixel", out.samples_per_pixel}}});
    if (nlohmann::ordered_json errors = picture.errors_of_shared(); !errors.empty())
        statistics.stages.back().detail["errors_of_shared_light"] = std::move(errors);
    if (const double error = picture.error_of_shading(); error > 0.0)
        statistics.stages.back().detail["error_of_shading"] = error;
    if (const PathLengths* const lengths = picture.path_lengths())
        out.light_pictures = picture_lights(input, *lights.virtual_lights(), out.image, *lengths, statistics, progress);
    return out;
}

// Lights anew for each stretch of the shutter. Pictures of virtual lights are those of the middle stretch.
Drawn draw_moving(const DrawInput& input, Statistics& statistics, Progress& progress) {
    const OpenShutter& shutter = *input.shutter;
    const std::size_t lightings = shutter.lighting_count(), each = shutter.moments().size() / lightings;
    MomentMean mean;
    Drawn out;
    for (std::size_t k = 0; k < lightings; ++k) {
        const Instant lit = shutter.lit(k);
        const DrawInput then{input.shot,  input.plan, *lit.medium,          lit.surroundings,
                             *lit.camera, nullptr,    input.light_positions};
        const LitStretch stretch{shutter, lit, k * each, each};
        Drawn drawn = draw_lit(then, &stretch, statistics, progress);
        mean.add(std::move(drawn.image));
        out.samples_per_pixel = drawn.samples_per_pixel;
        out.bound_costs += drawn.bound_costs;
        if (k == lightings / 2)
            out.light_pictures = std::move(drawn.light_pictures);
    }
    out.image = mean.take();
    return out;
}

Drawn draw_one(const DrawInput& input, Statistics& statistics, Progress& progress) {
    return input.shutter ? draw_moving(input, statistics, progress) : draw_lit(input, nullptr, statistics, progress);
}

// Adds a share of another picture with the same layers, and takes as much from this one.
void mix(Image& image, const Image& other, float share) {
    for (Layer& layer : image.layers) {
        const std::vector<float>& pixels = other.layer(layer.name).pixels;
        for (std::size_t i = 0; i < pixels.size(); ++i)
            layer.pixels[i] += share * (pixels[i] - layer.pixels[i]);
    }
}

// Two whole pictures, since MA and MM of one solution are right together and not beside those of the other
// (scattering_choice.h). What both compute alike, with the same random numbers, is as in either.
Drawn draw_mixed(const DrawInput& input, Statistics& statistics, Progress& progress) {
    Shot shot = input.shot;
    if (std::exchange(shot.output.bounce_layers, false))
        progress.warning("bounce-layers", why_no_order_layers(input));
    const auto draw = [&](const Plan& plan, Statistics& costs) {
        const DrawInput part{shot,         plan,          input.medium,         input.surroundings,
                             input.camera, input.shutter, input.light_positions};
        return draw_one(part, costs, progress);
    };
    Drawn out = draw(by_lighting_grid(input.plan), statistics);
    Statistics costs;
    const Drawn other = draw(by_scattering_method(input.plan), costs);
    for (StageCost& stage : costs.stages) {
        stage.name += ", of the picture by " + input.plan.scattering_method->product;
        statistics.stages.push_back(std::move(stage));
    }
    mix(out.image, other.image, input.plan.share_of_method);
    out.samples_per_pixel += other.samples_per_pixel;
    out.bound_costs += other.bound_costs;
    return out;
}

}  // namespace

Drawn draw_by_many_lights(const DrawInput& input, Statistics& statistics, Progress& progress) {
    if (input.surroundings)
        check_surroundings(input.shot, input.plan);
    if (input.plan.single || input.plan.multiple)
        check_memory_to_light(input);
    Drawn out = (input.plan.mixed() ? draw_mixed : draw_one)(input, statistics, progress);
    if (has_bound_layers(input.shot, input.plan))
        finish_bound_layers(out.image, out.bound_costs, statistics);
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
        return shot.scattering.bounces == 0 || shot.scattering.bounces == 1
                   ? "with this scattering.bounces no light goes from surface to surface"
                   : "all surfaces are matt and lie in one plane, so that no light goes from one to another";
    return std::nullopt;
}

}  // namespace brisance
