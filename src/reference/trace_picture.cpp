#include "reference/trace_picture.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <fstream>
#include <limits>
#include <mutex>

#include "camera/pixel_filter.h"
#include "camera_rays/picture.h"
#include "camera_rays/source_field.h"
#include "core/error.h"
#include "core/input_file.h"
#include "core/parallel.h"
#include "core/stopwatch.h"
#include "film/whole_file.h"

namespace brisance {

namespace {

constexpr int kRowsAtOnce = 32;    // between two looks at the clock
constexpr int kPixelsAtOnce = 32;  // of a row, to a task
const std::vector<std::string> kColour = {"R", "G", "B"};

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

class Tracing {
public:
    Tracing(const TracedScene& scene, const Checkpoint& checkpoint, Progress& progress)
        : settings_(scene.tracing),
          camera_(scene.camera),
          checkpoint_(checkpoint),
          progress_(progress),
          tracer_(scene.medium, scene.tracing, scene.bounces, scene.surroundings),
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
    const PathTracer& tracer() const { return tracer_; }
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
        if (film_.add(pixel, half, trace_sample(tracer_, camera_, pixel, sample, statistics)))
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

public:
    static double relative_standard_error(const PathFilm& film);

private:
    const TracingSettings& settings_;
    const Camera& camera_;
    const Checkpoint& checkpoint_;
    Progress& progress_;
    PathTracer tracer_;
    PathFilm film_;
    std::uint64_t restored_passes_ = 0;
    double before_ = 0.0;
    Stopwatch watch_, since_save_;
    std::mutex mutex_;
};

Rgb beauty(const PathFilm& film, std::size_t pixel, int half) {
    dvec3 sum(0.0);
    for (int which = 0; which < film.order_sums(); ++which)
        for (int c = 0; c < 3; ++c)
            sum[c] += film.sum(pixel, half, which, c);
    return Rgb(sum / double(std::max<std::uint64_t>(film.work.passes, 1)));
}

// The root of the summed squares of half the halves' difference, over that of their mean.
double Tracing::relative_standard_error(const PathFilm& film) {
    double noise = 0.0, norm = 0.0;
    for (std::size_t p = 0; p < std::size_t(film.width()) * film.height(); ++p) {
        const dvec3 a(beauty(film, p, 0)), b(beauty(film, p, 1));
        noise += glm::dot(a - b, a - b) / 4.0;
        norm += glm::dot(a + b, a + b) / 4.0;
    }
    return norm > 0.0 ? std::sqrt(noise / norm) : 0.0;
}

// The standard error of the picture's mean luminance over that mean. One pair of halves gives its order of magnitude.
double relative_error_of_mean(const PathFilm& film) {
    double a = 0.0, b = 0.0;
    for (std::size_t p = 0; p < std::size_t(film.width()) * film.height(); ++p) {
        a += luminance(beauty(film, p, 0));
        b += luminance(beauty(film, p, 1));
    }
    return a + b > 0.0 ? std::abs(a - b) / (a + b) : 0.0;
}

// Writes the film's sums into the layers of pictures.
class Developer {
public:
    Developer(const PathFilm& film, const Image& sampled, const CellSet& needed, const OutputSettings& output)
        : film_(film), sampled_(sampled), needed_(needed), output_(output) {}

    // half 0 or 1, or -1 for their mean.
    Image picture(int half) const {
        Image image;
        image.width = film_.width();
        image.height = film_.height();
        Layer& colour = add(image, "", {"R", "G", "B", "A"});
        const Layer& alpha = sampled_.layer("");
        for (std::size_t p = 0; p < pixels(); ++p) {
            const Rgb c = mean(p, half, 0, film_.order_sums());
            float* out = &colour.pixels[4 * p];
            out[0] = c.x, out[1] = c.y, out[2] = c.z, out[3] = alpha.pixels[4 * p + 3];
        }
        if (output_.cell_layers)
            add_cells(image, half);
        add_orders(image, half);
        if (half < 0)
            add_variance(image);
        for (const char* name : {"Z", "albedo"})
            image.layers.push_back(sampled_.layer(name));
        return image;
    }

private:
    std::size_t pixels() const { return std::size_t(film_.width()) * film_.height(); }

    Layer& add(Image& image, const std::string& name, const std::vector<std::string>& channels) const {
        image.layers.push_back({name, channels, true, std::vector<float>(pixels() * channels.size())});
        return image.layers.back();
    }

    Rgb mean(std::size_t pixel, int half, int first, int last) const {
        dvec3 sum(0.0);
        for (int h = 0; h < 2; ++h)
            for (int which = first; which < last && (half < 0 || half == h); ++which)
                for (int c = 0; c < 3; ++c)
                    sum[c] += film_.sum(pixel, h, which, c);
        return Rgb(sum / (double(film_.work.passes) * (half < 0 ? 2.0 : 1.0)));
    }

    void fill(Image& image, const std::string& name, int half, int first, int last) const {
        Layer& layer = add(image, name, kColour);
        for (std::size_t p = 0; p < pixels(); ++p) {
            const Rgb c = mean(p, half, first, last);
            for (int k = 0; k < 3; ++k)
                layer.pixels[3 * p + k] = c[k];
        }
    }

    void add_cells(Image& image, int half) const {
        if (film_.sums() > film_.order_sums()) {
            for (int cell = 0; cell < kCells; ++cell)
                if (needed_[cell])
                    fill(image, kCellNames[cell], half, film_.order_sums() + cell, film_.order_sums() + cell + 1);
            return;
        }
        fill(image, "V", half, 0, 1);
        if (needed_.contains(Cell::MV))
            fill(image, "MV", half, 1, 2);
        if (needed_.contains(Cell::MM))
            fill(image, "MM", half, 2, film_.order_sums());
    }

    void add_orders(Image& image, int half) const {
        const bool once = needed_.contains(Cell::MV) || needed_.contains(Cell::SV) || needed_.contains(Cell::SA) ||
                          needed_.contains(Cell::MA);
        const bool twice = needed_.contains(Cell::MM) || needed_.contains(Cell::SS);
        if (!output_.bounce_layers || !once)
            return;
        fill(image, "bounce1", half, 1, 2);
        for (int order = 2; twice && order < kPathOrders; ++order) {
            const bool last = order + 1 == kPathOrders;
            fill(image, last ? "bounces_beyond" + std::to_string(order - 1) : "bounce" + std::to_string(order), half,
                 order, order + 1);
        }
    }

    void add_variance(Image& image) const {
        Layer& layer = add(image, "variance", kColour);
        constexpr double most = std::numeric_limits<float>::max();  // the square of a light of 1e20 is beyond it
        const double n = 2.0 * film_.work.passes;
        for (std::size_t p = 0; p < pixels(); ++p) {
            const Rgb m = mean(p, -1, 0, film_.order_sums());
            for (int c = 0; c < 3; ++c)
                layer.pixels[3 * p + c] = static_cast<float>(
                    std::clamp((film_.square(p, c) / n - double(m[c]) * m[c]) / std::max(n - 1.0, 1.0), 0.0, most));
        }
    }

    const PathFilm& film_;
    const Image& sampled_;
    const CellSet& needed_;
    const OutputSettings& output_;
};

// Alpha, depth and albedo are not random, so a few of the camera's marches give them.
Image sampled_layers(const Medium& medium, const Surroundings* surroundings, const Camera& camera) {
    constexpr int kEnough = 2;  // rays along a pixel's side
    const SourceField field(medium);
    PictureSettings settings;
    const int requested = camera.settings().samples_per_axis;
    settings.samples_per_axis = requested > 0 ? requested : std::min(automatic_samples(camera, field), kEnough);
    settings.cells = false;
    settings.surroundings = surroundings;
    Progress silent;
    return render_picture(field, camera, settings, silent);
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

TracedPicture trace_picture(const TracedScene& scene, const Checkpoint& checkpoint, Statistics& statistics,
                            Progress& progress) {
    progress.stage("path tracing");
    const Stopwatch setup;
    Tracing tracing(scene, checkpoint, progress);
    statistics.stages.push_back({"tracking field and light trees", setup.seconds(), tracing.tracer().bytes(), {}});
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
          {"relative_standard_error", Tracing::relative_standard_error(film)},
          {"relative_standard_error_of_mean", relative_error_of_mean(film)},
          {"not_finite_paths", film.work.not_finite}}});
    const Stopwatch layers;
    const Image sampled = sampled_layers(scene.medium, scene.surroundings, scene.camera);
    const Developer developer(film, sampled, scene.needed, scene.output);
    TracedPicture out{developer.picture(-1), {developer.picture(0), developer.picture(1)}, 2.0 * film.work.passes};
    statistics.stages.push_back({"alpha, depth and albedo", layers.seconds(), 0, {}});
    return out;
}

}  // namespace brisance
