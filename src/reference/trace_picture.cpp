#include "reference/trace_picture.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <fstream>
#include <mutex>

#include "camera/pixel_filter.h"
#include "camera_rays/automatic_samples.h"
#include "camera_rays/moment_mean.h"
#include "camera_rays/picture.h"
#include "camera_rays/source_field.h"
#include "core/error.h"
#include "core/input_file.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "film/noise_filter.h"
#include "film/whole_file.h"
#include "reference/develop_film.h"

namespace brisance {

namespace {

constexpr int kRowsAtOnce = 32;    // between two looks at the clock
constexpr int kPixelsAtOnce = 32;  // of a row, to a task

// Point k of a half in the three-dimensional sequence of Roberts (generalised golden ratio), shifted at random.
struct SamplePoint {
    double x, y, first_collision;
};

// Names a pixel's random numbers: a picture has less than 2^32 pixels.
std::uint64_t seeded(int seed, std::size_t pixel) {
    return std::uint64_t(seed) << 32 | pixel;
}

SamplePoint sample_point(int seed, std::size_t pixel, std::uint64_t sample) {
    constexpr double g1 = 0.8191725133961645, g2 = 0.6710436067037893, g3 = 0.5497004779019703;
    Rng shift(Stream::PathRotation, seeded(seed, pixel), sample & 1);
    const double k = static_cast<double>(sample >> 1);
    const auto at = [&](double step) {
        const double v = shift.next_double() + std::fmod(k * step, 1.0);
        return v - std::floor(v);
    };
    const double x = at(g1), y = at(g2);
    return {x, y, at(g3)};
}

Ray ray_at(const Camera& camera, std::size_t pixel, const SamplePoint& point) {
    const CameraSettings& s = camera.settings();
    const std::size_t x = pixel % s.width, y = pixel / s.width;
    const double column = static_cast<double>(x) + 0.5, row = static_cast<double>(y) + 0.5;
    const double size = s.filter_width_pixels;
    return camera.ray(column + (point.x - 0.5) * size, row + (point.y - 0.5) * size);
}

std::vector<Moment> moments_of(const TracedScene& scene) {
    if (scene.moments.empty())
        return {{&scene.medium, scene.surroundings, &scene.camera}};
    return {scene.moments.begin(), scene.moments.end()};
}

class Tracing {
public:
    Tracing(const TracedScene& scene, const Checkpoint& checkpoint, Progress& progress)
        : settings_(scene.tracing),
          checkpoint_(checkpoint),
          progress_(progress),
          tracers_(moments_of(scene), scene.tracing, scene.bounces),
          film_(scene.camera.settings().width, scene.camera.settings().height, scene.output.bounce_layers,
                scene.surroundings) {
        if (!checkpoint.file.empty() && std::filesystem::exists(checkpoint.file))
            resume();
        if (!checkpoint.file.empty())
            remove_leftovers(checkpoint.file);
        before_ = film_.work.seconds;
    }

    void run() {
        while (!enough())
            pass();
        if (film_.work.passes > restored_passes_)
            save();
    }

    const PathFilm& film() const { return film_; }
    std::uint64_t bytes() const { return tracers_.bytes(); }
    bool resumed() const { return restored_passes_ > 0; }

private:
    void resume() {
        constexpr std::uint64_t most = std::uint64_t{1} << 40;
        const std::string trouble = film_.restore(read_input(checkpoint_.file, most), checkpoint_.key);
        if (!trouble.empty())
            throw Error(ExitCode::BadData,
                        checkpoint_.file.string() + ": " + trouble + "; delete it, or name another --checkpoint");
        restored_passes_ = film_.work.passes;
        progress_.notice("going on from " + checkpoint_.file.string() + " after " +
                         std::to_string(2 * film_.work.passes) + " samples per pixel");
    }

    bool enough() {
        const TracingSettings& t = settings_;
        const std::uint64_t samples = 2 * film_.work.passes;
        if (film_.work.rows > 0 || samples == 0)
            return false;
        const double error = t.error > 0.0 ? relative_standard_error(film_) : 0.0;
        return (t.samples > 0 && samples >= std::uint64_t(t.samples)) ||
               (t.seconds > 0.0 && film_.work.seconds >= t.seconds) || (t.error > 0.0 && error <= t.error);
    }

    void pass() {
        const int height = film_.height();
        for (int row = static_cast<int>(film_.work.rows); row < height; row += kRowsAtOnce) {
            trace_rows(row, std::min(row + kRowsAtOnce, height));
            film_.work.rows = std::min(row + kRowsAtOnce, height) % height;
            film_.work.passes += film_.work.rows == 0;
            film_.work.seconds = before_ + watch_.seconds();
            report_progress();
            if (!checkpoint_.file.empty() && since_save_.seconds() >= settings_.checkpoint_seconds)
                save();
        }
    }

    void trace_rows(int begin, int end) {
        const int width = film_.width(), tasks = (width + kPixelsAtOnce - 1) / kPixelsAtOnce;
        parallel_for(std::size_t(end - begin) * tasks, [&](std::size_t task) {
            const int y = begin + static_cast<int>(task / tasks);
            const int first = static_cast<int>(task % tasks) * kPixelsAtOnce;
            PathStatistics statistics;
            for (int x = first; x < std::min(first + kPixelsAtOnce, width); ++x)
                for (int half = 0; half < 2; ++half)
                    trace_pixel(std::size_t(y) * width + x, half, statistics);
            const std::lock_guard lock(mutex_);
            film_.work.paths += statistics.paths;
            film_.work.scatterings += statistics.scatterings;
        });
    }

    void trace_pixel(std::size_t pixel, int half, PathStatistics& statistics) {
        const std::uint64_t sample = 2 * film_.work.passes + half;
        const std::size_t moment = moment_of_sample(settings_.seed, pixel, sample, tracers_);
        if (film_.add(pixel, half,
                      trace_sample(tracers_.tracer(moment), tracers_.camera(moment), pixel, sample, statistics)))
            return;
        const std::lock_guard lock(mutex_);
        PathFilm::Work& w = film_.work;
        if (w.not_finite++ == 0 || sample < w.bad_sample || (sample == w.bad_sample && pixel < w.bad_pixel)) {
            w.bad_pixel = pixel;
            w.bad_sample = sample;
        }
    }

    void report_progress() {
        const TracingSettings& t = settings_;
        const double done = 2.0 * (film_.work.passes + double(film_.work.rows) / film_.height());
        double part = t.samples > 0 ? done / t.samples : 0.0;
        if (t.seconds > 0.0)
            part = std::max(part, film_.work.seconds / t.seconds);
        progress_.fraction(std::min(part, 1.0));
    }

    // A checkpoint that cannot be written only causes a warning, because the previous one is still whole.
    void save() {
        if (checkpoint_.file.empty())
            return;
        try {
            write_whole_file(checkpoint_.file, film_.serialise(checkpoint_.key));
        } catch (const Error& error) {
            progress_.warning("checkpoint", std::string("not kept: ") + error.what());
        }
        since_save_ = Stopwatch();
    }

    const TracingSettings& settings_;
    const Checkpoint& checkpoint_;
    Progress& progress_;
    MomentTracers tracers_;
    PathFilm film_;
    std::uint64_t restored_passes_ = 0;
    double before_ = 0.0;
    Stopwatch watch_, since_save_;
    std::mutex mutex_;
};

// Alpha, depth and albedo are not random, so a few of the camera's marches give them.
Image sampled_layers(const TracedScene& scene) {
    constexpr int kEnough = 2;  // rays along a pixel's side
    MomentMean mean;
    for (const Moment& moment : moments_of(scene)) {
        const SourceField field(*moment.medium);
        PictureSettings settings;
        const int requested = scene.camera.settings().samples_per_axis;
        settings.samples_per_axis =
            requested > 0 ? requested : std::min(automatic_samples(*moment.camera, *moment.medium).enough, kEnough);
        settings.cells = false;
        settings.surroundings = moment.surroundings;
        Progress silent;
        mean.add(render_picture(field, *moment.camera, settings, silent));
    }
    return mean.take();
}

void weigh(PathSum& sum, PathStatistics& statistics, float weight) {
    for (Rgb& order : sum)
        order *= weight;
    for (Rgb& cell : sum.cells)
        cell *= weight;
    if (!statistics.vertices)
        return;
    for (TracedVertex& vertex : *statistics.vertices)
        for (Rgb* part : {&vertex.throughput, &vertex.along_segment, &vertex.from_fire, &vertex.from_emitters})
            *part *= weight;
}

void report_bad_samples(const PathFilm& film, Progress& progress) {
    const PathFilm::Work& w = film.work;
    if (w.not_finite == 0)
        return;
    progress.warning("not-finite", std::to_string(w.not_finite) +
                                       " paths were not finite and are left out of the "
                                       "picture; see the first: brisance trace-path SHOT " +
                                       std::to_string(w.bad_pixel % film.width()) + " " +
                                       std::to_string(w.bad_pixel / film.width()) + " " + std::to_string(w.bad_sample));
}

}  // namespace

Ray sample_ray(const Camera& camera, int seed, std::size_t pixel, std::uint64_t sample) {
    return ray_at(camera, pixel, sample_point(seed, pixel, sample));
}

PathSum trace_sample(const PathTracer& tracer, const Camera& camera, std::size_t pixel, std::uint64_t sample,
                     PathStatistics& statistics) {
    const int seed = tracer.settings().seed;
    const SamplePoint point = sample_point(seed, pixel, sample);
    Rng rng(Stream::Path, seeded(seed, pixel), sample);
    PathSum sum{};
    tracer.trace(ray_at(camera, pixel, point), point.first_collision, rng, sum, statistics);
    const PixelFilter filter = camera.settings().filter;
    if (filter != PixelFilter::Box)
        weigh(sum, statistics, filter_weight(filter, point.x - 0.5, point.y - 0.5));
    return sum;
}

std::size_t moment_of_sample(int seed, std::size_t pixel, std::uint64_t sample, const MomentTracers& moments) {
    if (moments.count() == 1)
        return 0;
    constexpr double kGolden = 0.6180339887498949;
    Rng shift(Stream::PathMoment, seeded(seed, pixel), sample & 1);
    const double u = shift.next_double() + std::fmod(static_cast<double>(sample >> 1) * kGolden, 1.0);
    return moments.at(u - std::floor(u));
}

TracedPicture trace_picture(const TracedScene& scene, const Checkpoint& checkpoint, Statistics& statistics,
                            Progress& progress) {
    progress.stage("path tracing");
    const Stopwatch setup;
    Tracing tracing(scene, checkpoint, progress);
    statistics.stages.push_back({"tracking field and light trees", setup.seconds(), tracing.bytes(), {}});
    const Stopwatch watch;
    const std::clock_t cpu = std::clock();
    tracing.run();
    const PathFilm& film = tracing.film();
    report_bad_samples(film, progress);
    statistics.stages.push_back(
        {"path tracing",
         watch.seconds(),
         film.bytes(),
         {{"samples_per_pixel", 2 * film.work.passes},
          {"paths", film.work.paths},
          {"scatterings_per_path", double(film.work.scatterings) / double(std::max<std::uint64_t>(film.work.paths, 1))},
          {"cpu_seconds", double(std::clock() - cpu) / CLOCKS_PER_SEC},
          {"seconds_in_all", film.work.seconds},
          {"relative_standard_error", relative_standard_error(film)},
          {"relative_standard_error_of_mean", relative_error_of_mean(film)},
          {"not_finite_paths", film.work.not_finite}}});
    const Stopwatch layers;
    const Image sampled = sampled_layers(scene);
    const auto picture = [&](int half) { return develop(film, half, sampled, scene.needed, scene.output); };
    TracedPicture out{picture(-1), {picture(0), picture(1)}, 2.0 * film.work.passes};
    statistics.stages.push_back({"alpha, depth and albedo", layers.seconds(), 0, {}});
    if (const int radius = scene.tracing.denoising_radius; radius > 0) {
        const Stopwatch filtering;
        const std::array<Image*, 3> pictures = {&out.image, &out.halves[0], &out.halves[1]};
        NoiseFilter(out.image, radius).apply(pictures);
        statistics.stages.push_back({"noise filter", filtering.seconds(), 0, {{"radius", radius}}});
    }
    return out;
}

}  // namespace brisance
