#include "metrics/temporal_spectrum.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"

namespace brisance {

const std::array<const char*, kTemporalBands> kTemporalBandNames = {"still", "low", "mid", "high"};

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kBlock = 256;  // pixels whose powers are summed at once

// Row k holds the k-th basis function of the orthonormal DCT-II.
std::vector<double> cosines(std::size_t frames) {
    std::vector<double> table(frames * frames);
    const auto n = static_cast<double>(frames);
    for (std::size_t k = 0; k < frames; ++k)
        for (std::size_t t = 0; t < frames; ++t)
            table[k * frames + t] = std::sqrt((k == 0 ? 1.0 : 2.0) / n) *
                                    std::cos(kPi * static_cast<double>(k) * (static_cast<double>(t) + 0.5) / n);
    return table;
}

bool finite(const Rgb& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

float product(const Rgb& a, const Rgb& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Powers of one channel of one pixel, added to `power` (both halves' mean) and `cross`.
struct Transform {
    const std::vector<double>& table;
    std::vector<double> power, cross;

    explicit Transform(const std::vector<double>& cosine_table, std::size_t frames)
        : table(cosine_table), power(frames, 0.0), cross(frames, 0.0) {}

    void add(const std::vector<std::vector<float>>& a, const std::vector<std::vector<float>>& b, std::size_t value) {
        const std::size_t frames = a.size();
        for (std::size_t k = 0; k < frames; ++k) {
            double first = 0.0, second = 0.0;
            for (std::size_t t = 0; t < frames; ++t) {
                first += table[k * frames + t] * a[t][value];
                if (!b.empty())
                    second += table[k * frames + t] * b[t][value];
            }
            const double mean = b.empty() ? first : 0.5 * (first + second);
            power[k] += mean * mean;
            cross[k] += first * second;
        }
    }
};

}  // namespace

TemporalBand temporal_band(double cycles_per_frame) {
    if (!(cycles_per_frame > 0.0))
        return TemporalBand::Still;
    if (cycles_per_frame < 1.0 / 8.0)
        return TemporalBand::Low;
    return cycles_per_frame <= 1.0 / 4.0 ? TemporalBand::Mid : TemporalBand::High;
}

std::array<double, kTemporalBands> TemporalSpectrum::bands() const {
    const std::vector<double>& of = noise_free_power.empty() ? power : noise_free_power;
    std::array<double, kTemporalBands> result{};
    for (std::size_t k = 0; k < of.size(); ++k)
        result[static_cast<std::size_t>(temporal_band(cycles_per_frame[k]))] += of[k];
    for (double& band : result)
        band = std::sqrt(std::max(0.0, band));
    return result;
}

void ErrorOverTime::begin(const FrameAndReference& frame) {
    width_ = frame.image.width;
    height_ = frame.image.height;
    halves_ = frame.reference.second.has_value();
    const std::size_t count = frame.image.pixels.size();
    const int step =
        std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count) / double(kSpectrumPixels)))));
    for (int y = step / 2; y < height_; y += step)
        for (int x = step / 2; x < width_; x += step)
            pixels_.push_back(static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                              static_cast<std::size_t>(x));
    usable_.assign(pixels_.size(), true);
}

std::vector<float> ErrorOverTime::errors(const Picture& image, const Picture& reference) {
    std::vector<float> out(3 * pixels_.size());
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        const Rgb error = image.pixels[pixels_[p]] - reference.pixels[pixels_[p]];
        if (!finite(error))
            usable_[p] = false;
        for (int c = 0; c < 3; ++c)
            out[3 * p + static_cast<std::size_t>(c)] = error[c];
    }
    return out;
}

void ErrorOverTime::add(const FrameAndReference& frame) {
    if (frames_ == 0)
        begin(frame);
    const Picture& first = frame.reference.first;
    const Picture& second = frame.reference.second ? *frame.reference.second : first;
    for (const Picture* picture : {&frame.image, &first, &second})
        if (picture->width != width_ || picture->height != height_)
            throw Error(ExitCode::BadData, "pictures of different sizes cannot be compared");
    if (frame.reference.second.has_value() != halves_)
        throw Error(ExitCode::BadData, "the reference of one frame has two halves, that of the other has one picture");
    a_.push_back(errors(frame.image, first));
    if (halves_)
        b_.push_back(errors(frame.image, second));
    std::vector<float> square(pixels_.size()), cross(pixels_.size());
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        const Rgb &a = first.pixels[pixels_[p]], &b = second.pixels[pixels_[p]], mean = 0.5f * (a + b);
        square[p] = product(mean, mean);
        cross[p] = product(a, b);
    }
    square_.push_back(std::move(square));
    cross_.push_back(std::move(cross));
    ++frames_;
}

TemporalSpectrum ErrorOverTime::spectrum() const {
    TemporalSpectrum result;
    const std::vector<double> table = cosines(frames_);
    const std::size_t blocks = (pixels_.size() + kBlock - 1) / kBlock;
    std::vector<Transform> parts(blocks, Transform(table, frames_));
    parallel_blocks(pixels_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            for (std::size_t c = 0; c < 3 && usable_[p]; ++c)
                parts[begin / kBlock].add(a_, b_, 3 * p + c);
    });
    result.power.assign(frames_, 0.0);
    std::vector<double> cross(frames_, 0.0);
    for (const Transform& part : parts)
        for (std::size_t k = 0; k < frames_; ++k) {
            result.power[k] += part.power[k];
            cross[k] += part.cross[k];
        }
    double square = 0.0, reference_cross = 0.0;
    for (std::size_t p = 0; p < pixels_.size(); ++p) {
        result.not_finite += usable_[p] ? 0 : 1;
        for (std::size_t t = 0; t < frames_ && usable_[p]; ++t) {
            square += square_[t][p];
            reference_cross += cross_[t][p];
        }
    }
    result.pixels = pixels_.size();
    for (std::size_t k = 0; k < frames_; ++k) {
        result.cycles_per_frame.push_back(0.5 * static_cast<double>(k) / static_cast<double>(frames_));
        result.power[k] = square > 0.0 ? result.power[k] / square : result.power[k] > 0.0 ? INFINITY : 0.0;
        if (halves_)
            result.noise_free_power.push_back(reference_cross > 0.0 ? cross[k] / reference_cross : 0.0);
    }
    return result;
}

}  // namespace brisance
