#include "certificate/certify.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "certificate/estimated_layers.h"
#include "core/parallel.h"

namespace brisance {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Shares of pixels that are drawn evenly, in proportion to each target's radiance, and in proportion to its square.
constexpr double kEvenly = 0.2, kByRadiance = 0.2, kBySquare = 0.6;

// A budget of B = n m samples, m at each of n draws, gives the squared error the variance
//     (m S + 4 C + 2 N / (m - 1)) / B,
// where S is the spread of (I - R)^2 over the draws, C the mean of (I - R)^2 sigma^2, N the mean of sigma^4, and sigma
// the noise of one sample. It is least for m - 1 = sqrt(2 N / S): some ten samples when the picture is off by a third
// of the noise, thousands when it is off by a hundredth. The mean error's variance, (m S' + N') / B, and rare errors
// always need many draws. With m = n / 16 the interval's width stays within 1.3 times the best that was measured, for
// errors from 0.6 to 23 %. Larger budgets buy draws and samples so that the intervals of good and bad pictures shrink
// alike.
std::size_t draws_of(int samples) {
    constexpr double usual = 1 << 19;
    const double share = samples / usual;
    const double draws = 4.0 * std::sqrt(usual) * std::max(std::sqrt(share), std::cbrt(share * share));
    return std::clamp<std::size_t>(std::lround(draws), 2, std::max(2, samples / 2));
}

double sum_of(const dvec3& c) {
    return c.x + c.y + c.z;
}

// The estimates of one draw for one target, summed over channels and weighted by the survey.
struct DrawEstimate {
    double square = 0.0;      // (I - R)^2
    double difference = 0.0;  // I - R
    double energy = 0.0;      // I^2 - R^2
};
using AllEstimates = std::array<DrawEstimate, kMostEstimatedLayers>;

DrawEstimate estimate_of(const dvec3& image, const dvec3& sum, const dvec3& squares, int samples, double weight) {
    const double n = samples;
    const dvec3 mean = sum / n, square = (sum * sum - squares) / (n * (n - 1.0));
    return {weight * sum_of(square), weight * sum_of(mean), weight * sum_of(2.0 * image * mean - square)};
}

class Sampler {
public:
    Sampler(const std::vector<EstimatedLayer>& targets, const MomentTracers& tracers, int seed, int samples)
        : targets_(targets), tracers_(tracers), seed_(seed), samples_(samples) {}

    AllEstimates sample(std::size_t number, const PixelSurvey::Draw& draw) {
        std::array<dvec3, kMostEstimatedLayers> image{}, sum{}, squares{};
        for (std::size_t t = 0; t < targets_.size(); ++t)
            image[t] = targets_[t].pixel(draw.pixel);
        for (int k = 0; k < samples_; ++k) {
            const PathSum path = trace(number, k, draw.pixel);
            for (std::size_t t = 0; t < targets_.size(); ++t) {
                const dvec3 d = image[t] - targets_[t].seen(path);
                sum[t] += d;
                squares[t] += d * d;
            }
        }
        AllEstimates estimates{};
        for (std::size_t t = 0; t < targets_.size(); ++t)
            estimates[t] = estimate_of(image[t], sum[t], squares[t], samples_, draw.weight);
        return estimates;
    }

    std::uint64_t not_finite() const { return not_finite_; }

private:
    PathSum trace(std::size_t number, int k, std::size_t pixel) {
        Rng rng(Stream::Certificate, std::uint64_t(seed_) << 32 | number, std::uint64_t(k) + 1);
        const PathSum path = tracers_.sample(pixel, rng);
        if (!std::isfinite(sum_of(dvec3(std::accumulate(path.begin(), path.end(), Rgb(0.0f)))))) {
            ++not_finite_;
            return {};
        }
        return path;
    }

    const std::vector<EstimatedLayer>& targets_;
    const MomentTracers& tracers_;
    int seed_, samples_;
    std::atomic<std::uint64_t> not_finite_ = 0;
};

// The picture as a population of pixels: the pixels that can be sampled, and how often each should be.
class Population {
public:
    Population(const Image& image, const std::vector<EstimatedLayer>& targets)
        : targets_(targets), width_(image.width), height_(image.height) {
        usable_.resize(std::size_t(width_) * height_, 1.0);
        for (std::size_t p = 0; p < usable_.size(); ++p)
            for (const EstimatedLayer& t : targets)
                if (!std::isfinite(sum_of(t.pixel(p))))
                    usable_[p] = 0.0;
    }

    std::uint64_t not_usable() const { return std::count(usable_.begin(), usable_.end(), 0.0); }

    // Sum over the usable pixels.
    template <class Value>
    double total(const Value& value) const {
        double sum = 0.0;
        for (std::size_t p = 0; p < usable_.size(); ++p)
            if (usable_[p] > 0.0)
                sum += value(p);
        return sum;
    }

    std::vector<double> sizes() const {
        std::vector<double> size(usable_.size(), 0.0);
        add(size, usable_, kEvenly);
        for (const EstimatedLayer& t : targets_) {
            add(size, blurred([&](std::size_t p) { return glm::length(t.pixel(p)); }), kByRadiance / targets_.size());
            add(size, blurred([&](std::size_t p) { return glm::dot(t.pixel(p), t.pixel(p)); }),
                kBySquare / targets_.size());
        }
        return size;
    }

private:
    void add(std::vector<double>& size, const std::vector<double>& part, double share) const {
        const double sum = total([&](std::size_t p) { return part[p]; });
        for (std::size_t p = 0; p < size.size() && sum > 0.0; ++p)
            size[p] += usable_[p] * share * part[p] / sum;
    }

    // Averages over three by three pixels: a dark pixel among bright ones is more likely wrong than a dark region.
    template <class Value>
    std::vector<double> blurred(const Value& value) const {
        std::vector<double> out(usable_.size(), 0.0);
        for (int y = 0; y < height_; ++y)
            for (int x = 0; x < width_; ++x)
                for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_ - 1); ++v)
                    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_ - 1); ++u)
                        if (const std::size_t p = std::size_t(v) * width_ + u; usable_[p] > 0.0)
                            out[std::size_t(y) * width_ + x] += value(p);
        return out;
    }

    const std::vector<EstimatedLayer>& targets_;
    int width_, height_;
    std::vector<double> usable_;  // 1, or 0 where a target is not finite
};

// Of sqrt(s.a / (norm - s.b)).
void estimate_error(CertifiedError& e, const SurveyedSums& s, double norm) {
    const double t = half_width(s.strata), t2 = t * t, below = norm - s.b;
    // Beale's ratio is unbiased to first order. The plain ratio is too large because the truth is noisy.
    e.square = below > 0.0 ? (s.a * below - s.ab) / (below * below + s.bb) : kInfinity;
    e.error = std::sqrt(std::max(0.0, e.square));
    e.error_interval = {0.0, kInfinity};
    e.largest_share = s.largest_share;
    e.degrees_of_freedom = s.degrees_of_freedom;
    if (below > 0.0)
        e.square_deviation = std::sqrt(std::max(0.0, s.aa + e.square * (2.0 * s.ab + e.square * s.bb))) / below;
    // Fieller's interval holds all q for which a - q below is within t standard errors of 0:
    // (a - q below)^2 <= t^2 var(a + q b).
    const double squared = below * below - t2 * s.bb, middle = s.a * below + t2 * s.ab, rest = s.a * s.a - t2 * s.aa;
    const double root = middle * middle - squared * rest;
    if (!(below > 0.0 && squared > 0.0 && root >= 0.0))
        return;
    e.error_interval.low = std::sqrt(std::max(0.0, (middle - std::sqrt(root)) / squared));
    // The bound is never below the error that chance alone would give a perfect picture.
    const double chance = t * std::sqrt(s.aa) / below;
    e.error_interval.high = std::sqrt(std::max((middle + std::sqrt(root)) / squared, chance));
}

// The mean of the truth is that of the picture less the difference, and only the difference is random.
void estimate_mean(CertifiedError& e, const SurveyedSums& s, double total) {
    const double width = half_width(s.strata) * std::sqrt(s.aa);
    const auto relative = [total](double difference) {
        return total - difference > 0.0 ? difference / (total - difference) : kInfinity;
    };
    e.mean = relative(s.a);
    e.mean_interval = {relative(s.a - width), relative(s.a + width)};
    if (!(total - s.a + width > 0.0))
        e.mean_interval.low = -kInfinity;
}

CertifiedError certified_error(const Population& population, const EstimatedLayer& target,
                               std::span<const AllEstimates> estimates, std::size_t index) {
    std::vector<double> square, difference, energy;
    for (const AllEstimates& all : estimates) {
        square.push_back(all[index].square);
        difference.push_back(all[index].difference);
        energy.push_back(all[index].energy);
    }
    CertifiedError e;
    e.cell = target.layer->name;
    estimate_error(e, surveyed_sums(square, energy),
                   population.total([&](std::size_t p) { return glm::dot(target.pixel(p), target.pixel(p)); }));
    estimate_mean(e, surveyed_sums(difference, difference),
                  population.total([&](std::size_t p) { return sum_of(target.pixel(p)); }));
    return e;
}

// The result for a target whose truth is black as well, so that no ratio is defined.
CertifiedError error_of_black(const EstimatedLayer& target) {
    CertifiedError e;
    e.cell = target.layer->name;
    return e;
}

void warn(const Certificate& c, Progress& progress) {
    if (c.not_finite_pixels > 0)
        progress.warning("certificate", std::to_string(c.not_finite_pixels) +
                                            " pixels are not finite: the certificate leaves them out");
    if (c.not_finite_samples > 0)
        progress.warning("certificate", std::to_string(c.not_finite_samples) +
                                            " samples of the certificate were not finite and count as 0");
    // Intervals assume a sum over many pixels.
    constexpr double kLargeShare = 0.5;
    if (c.errors.front().largest_share > kLargeShare)
        progress.warning("certificate",
                         "one or two pixels dominate the error: its interval may be too narrow; raise "
                         "certify.samples");
}

}  // namespace

MomentTracers tracers_of(const CertifiedScene& scene) {
    const Moment still{&scene.medium, scene.surroundings, &scene.camera};
    const std::span<const Moment> moments = scene.moments.empty() ? std::span(&still, 1) : scene.moments;
    return {moments, scene.tracing, scene.bounces};
}

Certificate certify(const Image& image, const CertifiedScene& scene, const MomentTracers& tracers,
                    const SurveySize& size, Progress& progress) {
    const std::vector<EstimatedLayer> targets = estimated_layers(image, scene.surroundings);
    const Population population(image, targets);
    const PixelSurvey survey(population.sizes(), image.width, size.draws, size.seed);
    const auto& draws = survey.draws();
    Certificate out;
    out.seed = size.seed;
    out.not_finite_pixels = population.not_usable();
    out.pixels = draws.size();
    out.samples_per_pixel = draws.empty() ? 0 : std::max<std::uint64_t>(2, size.samples / out.pixels);
    out.samples = out.pixels * out.samples_per_pixel;
    Sampler sampler(targets, tracers, size.seed, static_cast<int>(out.samples_per_pixel));
    std::vector<AllEstimates> estimates(draws.size());
    std::atomic<std::size_t> done = 0;
    parallel_for(draws.size(), [&](std::size_t i) {
        estimates[i] = sampler.sample(i, draws[i]);
        progress.fraction(double(++done) / double(draws.size()));
    });
    out.not_finite_samples = sampler.not_finite();
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const bool black = population.total([&](std::size_t p) { return sum_of(targets[t].pixel(p)); }) == 0.0;
        out.errors.push_back(black && !scene.shines ? error_of_black(targets[t])
                                                    : certified_error(population, targets[t], estimates, t));
    }
    return out;
}

Certificate certify(const Image& image, const CertifiedScene& scene, const CertifySettings& settings,
                    Progress& progress) {
    progress.stage("certificate");
    Certificate out =
        certify(image, scene, tracers_of(scene),
                {draws_of(settings.samples), static_cast<std::size_t>(settings.samples), settings.seed}, progress);
    warn(out, progress);
    return out;
}

}  // namespace brisance
